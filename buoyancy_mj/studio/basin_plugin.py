"""`BasinPlugin`: Studio's side of the simulation, which steps a scene and shows its dry twin."""

import time
from collections.abc import Callable
from pathlib import Path

from mujoco.studio import messages, plugin, sim, step_control

from buoyancy_mj.drawing.looks import DAYLIGHT
from buoyancy_mj.errors import BuoyancyError
from buoyancy_mj.studio import deeds
from buoyancy_mj.studio.basin import Basin
from buoyancy_mj.studio.letters import (
    AfloatEvent,
    DropEvent,
    LaunchEvent,
    LeanEvent,
    ReadoutSnapshot,
    RefusalEvent,
    RestEvent,
    SeaSnapshot,
    VerdictEvent,
    WaterEvent,
)
from buoyancy_mj.studio.model_files import (
    inspect_file,
    keep_own_water,
    scene_of_file,
    write_verdict,
)
from buoyancy_mj.studio.readouts import Reader
from buoyancy_mj.studio.sea_state import describe_water
from buoyancy_mj.studio.twin import Twin, make_dry_model

READOUT_TIME = 0.05
"""Wall time between two readouts [s]."""


class BasinPlugin(plugin.SimPlugin):
    """Steps a scene in its water, and gives the window its dry twin; or shows a dry model.

    Args:
        basin: the scene; None for none yet.
        path: the file of the model, where that is all there is.
        control: Studio's own pace: pauses, speed, noise.
        skin: whether the sea is a part of the twin, as browsers need it.
    """

    def __init__(
        self,
        basin: Basin | None,
        path: Path | None,
        control: step_control.StepControl,
        *,
        skin: bool,
    ) -> None:
        self._basin: Basin | None = None
        self._path, self._control, self._skin = path, control, skin
        self._read_at = -1.0
        if basin is not None:
            self._take(basin)

    @property
    def title(self) -> str:
        """What is shown."""
        if self._basin is not None:
            return self._basin.scene.title
        return self._path.stem if self._path is not None else ""

    @messages.handler
    def on_load_model(self, event: messages.LoadModelEvent) -> bool:
        """Publish what there is, at the start and when somebody asks to reload; or a new file."""
        if event.path:
            self._try(lambda: self._open(Path(event.path)))
        elif self._basin is not None:
            self._publish()
        elif self._path is not None:
            path = self._path
            self._try(lambda: self._dock(path))
        return True

    @messages.handler
    def on_launch(self, _: LaunchEvent) -> None:
        """Put the dry model into water."""
        if self._path is not None:
            path = self._path
            self._try(lambda: self._float(Basin(scene_of_file(path)[0])))

    @messages.handler(priority=messages.Priority.INTERNAL - 1)
    def on_reset(self, event: messages.ResetEvent) -> None:
        """Go back to the start of the scene, or to a keyframe; Studio did so with the twin."""
        self._act(lambda basin: basin.reset(event.key))

    @messages.handler
    def on_sea(self, snapshot: SeaSnapshot) -> None:
        """Let another water act; where it cannot be, the window is told that alone."""

        def change(basin: Basin) -> None:
            basin.put_into(snapshot.sea.make_water(basin.scene.water))
            self._tell_water()

        self._act(change)

    @messages.handler
    def on_drop(self, event: DropEvent) -> None:
        """Drop a vehicle."""
        self._act(lambda basin: deeds.drop(basin, event.vehicle, event.height))

    @messages.handler
    def on_rest(self, event: RestEvent) -> None:
        """Let a vehicle rest."""
        self._act(lambda basin: deeds.rest(basin, event.vehicle))

    @messages.handler
    def on_lean(self, event: LeanEvent) -> None:
        """Lean a vehicle."""
        self._act(lambda basin: deeds.lean(basin, event.vehicle, event.heel, event.trim))

    @messages.handler(priority=messages.Priority.USER)
    def on_step(self, _: messages.StepEvent) -> bool:
        """Take the steps that are due in the scene's own model; a dry model stands still.

        A run that diverges, or whose controller fails, stops at the start of the scene.
        """
        basin = self._basin
        if basin is not None:
            pace = self._control.step_control
            with self.handle.send_if_changes(
                lambda: messages.StepControlSnapshot.from_step_control(pace)
            ):
                self._twin.give(basin)
                try:
                    basin.advance(pace.advance)
                except BuoyancyError as error:
                    self._refuse(error)
                    basin.reset()
                    pace.set_pause_state(sim.PauseState.NORMAL_PAUSED)
            self._twin.take(basin)
            self._tell_readout()
        # as Studio's own stepping does, so that the window has its turn
        time.sleep(0.001)
        return True

    def _open(self, path: Path) -> None:
        """Show another model: afloat if it brings its water, dry otherwise."""
        scene, is_wet = scene_of_file(path)
        if is_wet:
            with keep_own_water():
                self._float(Basin(scene))
        else:
            self._dock(path)
        self._path = path

    def _dock(self, path: Path) -> None:
        """Show a model dry, with what the inspection says."""
        inspection = inspect_file(path)
        dry = make_dry_model(scene_of_file(path)[0], DAYLIGHT, skin=self._skin)
        self._basin = None
        self.handle.set_model(dry)
        lines = tuple(write_verdict(inspection))
        can_float = bool(inspection.vessels)
        self.handle.send_to_viewer(VerdictEvent(path.stem, lines, can_float))

    def _float(self, basin: Basin) -> None:
        """Show a scene that is new."""
        self._take(basin)
        self._publish()

    def _take(self, basin: Basin) -> None:
        """Take a scene."""
        self._basin = basin
        self._twin = Twin(basin, DAYLIGHT, skin=self._skin)
        self._reader = Reader(basin)

    def _publish(self) -> None:
        """Show the twin, and tell what acts."""
        assert self._basin is not None
        twin = self._twin
        self.handle.set_model(twin.model, data=twin.data)
        sea = describe_water(self._basin.water)
        self.handle.send_to_viewer(AfloatEvent(self._basin.scene.title, sea, twin.radius, twin.sea))
        self._tell_water()

    def _act(self, deed: Callable[[Basin], object]) -> None:
        """Do something to the scene, if there is one."""
        basin = self._basin
        if basin is not None:
            self._try(lambda: deed(basin))
            self._twin.take(basin)

    def _try(self, deed: Callable[[], object]) -> None:
        """Do something; where it cannot be, say why and leave all as it was."""
        try:
            deed()
        except BuoyancyError as error:
            self._refuse(error)

    def _refuse(self, error: BuoyancyError) -> None:
        """Say why something cannot be."""
        self.handle.send_to_viewer(RefusalEvent(str(error)))

    def _tell_water(self) -> None:
        """Tell the window what water acts."""
        if self._basin is not None:
            self.handle.send_to_viewer(WaterEvent(self._basin.water, self._basin.doubts))

    def _tell_readout(self) -> None:
        """Tell the window what there is to see, some twenty times a second."""
        now = time.monotonic()
        if now - self._read_at >= READOUT_TIME:
            self._read_at = now
            self.handle.send_to_viewer(ReadoutSnapshot(self._reader.read()))
