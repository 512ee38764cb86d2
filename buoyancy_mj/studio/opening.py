"""Open Studio: as a window, or as a page for browsers."""

import contextlib
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

from mujoco.studio import app as studio_app
from mujoco.studio import (
    launch_thread,
    messages,
    sim_history,
    step_control,
    viewer_handle,
    viewer_protocol,
    web_viewer,
)

from buoyancy_mj.errors import BuoyancyWarning
from buoyancy_mj.scenes.scene import Scene
from buoyancy_mj.studio.basin import Basin
from buoyancy_mj.studio.basin_plugin import BasinPlugin
from buoyancy_mj.studio.model_files import inspect_file, keep_own_water, scene_of_file
from buoyancy_mj.studio.sea_panel import SeaPanel
from buoyancy_mj.studio.sea_plugins import BrowserSea, WindowSea
from buoyancy_mj.studio.sea_state import JONSWAP, REGULAR, SeaState
from buoyancy_mj.studio.sea_window import SeaWindow
from buoyancy_mj.studio.vehicle_panel import VehiclePanel

WIDTH, HEIGHT = 1280, 800
"""Size of a new window [pixels]."""
WINDOW = "opengl_headless"
"""Studio's way to draw into pixels, which it shows in a window. Its ways to draw into a window, in
4.0.0, name a target that they do not have."""


def open_window(shown: Scene | Path, *, trust: bool = False) -> None:
    """Show a scene or a model in a window until it is closed, see `view_in_studio`."""
    control = step_control.StepControl()
    simulating = _simulate(shown, control, trust=trust, skin=False)
    drawing = [studio_app.App(), WindowSea(), SeaPanel(), VehiclePanel()]
    config = viewer_protocol.ViewerConfig(
        title=simulating.title, width=WIDTH, height=HEIGHT, gfx=WINDOW
    )
    _run(
        lambda endpoint: SeaWindow(config, endpoint, plugins=drawing),
        [control, sim_history.SimHistory(), simulating],
    )


def serve_page(shown: Scene | Path, host: str, port: int, *, trust: bool = False) -> None:
    """Serve a scene or a model to browsers until Ctrl-C, see `view_in_studio`."""
    control = step_control.StepControl()
    simulating = _simulate(shown, control, trust=trust, skin=True)
    drawing = [studio_app.App(), BrowserSea(), SeaPanel(), VehiclePanel()]
    config = viewer_protocol.ViewerConfig(title=simulating.title, http_port=port)
    _run(
        lambda endpoint: _Page(config, endpoint, drawing, host),
        [control, sim_history.SimHistory(), simulating],
    )


class _Page(web_viewer.WebViewer):
    """Studio's page, on one interface instead of all."""

    def __init__(self, config: Any, endpoint: Any, plugins: list[Any], host: str) -> None:
        self._chosen_host = host
        super().__init__(config, endpoint, plugins=plugins)
        print(f"open http://{host}:{self._http_port}/ in a browser", flush=True)  # noqa: T201

    @property
    def _host(self) -> str:
        """The address to listen on, which Studio asks for."""
        return self._chosen_host

    @_host.setter
    def _host(self, _: str) -> None:
        """Studio would listen on all of them."""


def _simulate(
    shown: Scene | Path, control: step_control.StepControl, *, trust: bool, skin: bool
) -> BasinPlugin:
    """The simulation of a scene or of a model, with all its water made before a window opens."""
    if isinstance(shown, Scene):
        basin = Basin(shown, trust=trust)
        _compile_all(basin)
        return BasinPlugin(basin, None, control, skin=skin)
    scene, is_wet = scene_of_file(shown)
    if not is_wet:
        # what can never float is refused before a window opens
        inspect_file(shown)
        return BasinPlugin(None, shown, control, skin=skin)
    with keep_own_water():
        basin = Basin(scene)
        _compile_all(basin)
        return BasinPlugin(basin, shown, control, skin=skin)


def _compile_all(basin: Basin) -> None:
    """Let every kind of water act once, so that nothing is compiled while a window is drawn."""
    own = basin.scene.water
    for spectrum in (REGULAR, JONSWAP):
        sea = SeaState(spectrum=spectrum, height=0.1, current=0.1)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", BuoyancyWarning)
            basin.put_into(sea.make_water(own))
            basin.frame()
    basin.put_into(own)
    basin.frame()


def _run(make_viewer: Callable[[Any], Any], sim_plugins: list[Any]) -> None:
    """Run a viewer in a thread of its own, and the simulation in this one, until either ends."""

    def view(endpoint: Any) -> None:
        viewer_protocol.run_viewer_loop(make_viewer(endpoint))

    with launch_thread.launch_thread(view, sim_plugins=sim_plugins) as handle:
        handle.dispatch(messages.LoadModelEvent())
        with contextlib.suppress(KeyboardInterrupt):
            viewer_handle.run_sim_loop(handle)
