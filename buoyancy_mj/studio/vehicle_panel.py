"""`VehiclePanel`: the tab that shows what the vehicles do, beside Studio's inspector."""

import math

import mujoco
from mujoco.studio import messages, plugin
from mujoco.studio.dear_imgui import dear_imgui as imgui

from buoyancy_mj.studio.letters import (
    AfloatEvent,
    DropEvent,
    LeanEvent,
    ReadoutSnapshot,
    RestEvent,
    VerdictEvent,
)
from buoyancy_mj.studio.readings import (
    PLOTS,
    UNITS,
    Traces,
    list_channels,
    list_forces,
    list_rows,
)
from buoyancy_mj.studio.readouts import Readout, VehicleReadout
from buoyancy_mj.studio.sea_state import Range
from buoyancy_mj.studio.widgets import Tab, open_section, plot_lines, slide, write_table

HEIGHT = Range("drop from", "m", 0.0, 5.0)
LEAN = Range("lean by", "deg", 0.0, 90.0)
_CAMERAS = mujoco.mjtCamera.mjCAMERA_FREE, mujoco.mjtCamera.mjCAMERA_TRACKING


class VehiclePanel(plugin.ViewerPlugin):
    """Draft, forces and energy of one vehicle at a time, and what can be done to it."""

    def __init__(self) -> None:
        self._tab = Tab("Vehicle", beside="Inspector", frames=20)
        self._readout: Readout | None = None
        self._traces = Traces()
        self._chosen = ""
        self._height, self._lean = 0.5, 20.0
        self._follows = True

    @messages.handler
    def on_afloat(self, _: AfloatEvent) -> None:
        """Begin with another scene."""
        self._readout, self._traces = None, Traces()

    @messages.handler
    def on_verdict(self, _: VerdictEvent) -> None:
        """There is nothing to read of a dry model."""
        self._readout = None

    @messages.handler
    def on_readout(self, snapshot: ReadoutSnapshot) -> None:
        """Keep what there is to see."""
        self._readout = snapshot.readout
        self._traces.add(snapshot.readout)
        if self._chosen not in snapshot.readout.vehicles:
            self._chosen = next(iter(snapshot.readout.vehicles))

    @messages.handler
    def on_update(self, _: messages.UpdateEvent) -> None:
        """Let the camera follow the vehicle, or stay where it is."""
        if self._readout is None:
            return
        camera, root = self.viewer.camera, self._readout.vehicles[self._chosen].root
        free, tracking = (int(kind) for kind in _CAMERAS)
        if self._follows and camera.type in (free, tracking):
            camera.type, camera.trackbodyid = tracking, root
        elif camera.type == tracking:
            camera.type, camera.lookat[:] = free, self.viewer.data.subtree_com[root]

    @messages.handler
    def on_build_gui(self, _: messages.BuildGuiEvent) -> None:
        """Build the tab."""
        self._tab.begin()
        if self._readout is None:
            imgui.TextUnformatted("Nothing is afloat.")
        else:
            self._build_choice(self._readout)
            one = self._readout.vehicles[self._chosen]
            self._build_deeds()
            self._build_numbers(one)
            self._build_plots()
            if self._readout.channels and open_section("Sensors and thrusters", is_open=False):
                write_table("channels", list_channels(self._readout))
        imgui.End()

    def _build_choice(self, readout: Readout) -> None:
        """Which vehicle it is, and whether the camera follows it."""
        names = list(readout.vehicles)
        imgui.SetNextItemWidth(-1.0)
        moved, index = imgui.Combo("##vehicle", names.index(self._chosen), names)
        if moved:
            self._chosen = names[index]
        _, self._follows = imgui.Checkbox("camera follows", self._follows)

    def _build_deeds(self) -> None:
        """The buttons."""
        height = slide("height", HEIGHT, self._height)
        self._height = self._height if height is None else height
        lean = slide("lean", LEAN, self._lean)
        self._lean = self._lean if lean is None else lean
        third = imgui.Vec2(imgui.GetContentRegionAvail().x / 3.0 - 6.0, 0.0)
        send = self.viewer.send_to_sim
        if imgui.Button("Drop", third):
            send(DropEvent(self._chosen, self._height))
        imgui.SameLine()
        if imgui.Button("Rest", third):
            send(RestEvent(self._chosen))
        imgui.SameLine()
        if imgui.Button("Lean", third):
            send(LeanEvent(self._chosen, math.radians(self._lean), 0.0))

    def _build_numbers(self, one: VehicleReadout) -> None:
        """Draft and all that, and forces by cause."""
        if open_section("Afloat"):
            write_table("rows", list_rows(one))
        if open_section("Forces of the water [N]"):
            write_table("forces", list_forces(one), ("", "x", "y", "z"))

    def _build_plots(self) -> None:
        """The course of the last half minute."""
        for plot in PLOTS:
            if open_section(plot.capitalize(), is_open=plot != "energy"):
                lines = self._traces.lines(plot, self._chosen)
                plot_lines(plot, UNITS[plot], self._traces.times(), lines)
