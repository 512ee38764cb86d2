"""`SeaPanel`: the tab in which the water is set, beside Studio's options."""

from mujoco.studio import messages, plugin
from mujoco.studio.dear_imgui import dear_imgui as imgui

from buoyancy_mj.studio.letters import (
    AfloatEvent,
    LaunchEvent,
    RefusalEvent,
    SeaSnapshot,
    VerdictEvent,
    WaterEvent,
)
from buoyancy_mj.studio.sea_state import RANGES, SCENE, SPECTRA, STILL, SeaState
from buoyancy_mj.studio.widgets import Tab, open_section, slide, warn

MOST_SEED = 9999
"""Greatest seed that the panel gives."""


class SeaPanel(plugin.ViewerPlugin):
    """Sends each change of the water at once."""

    def __init__(self) -> None:
        self._tab = Tab("Sea", beside="Options", frames=40)
        self._sea: SeaState | None = None
        self._doubts: tuple[str, ...] = ()
        self._refusal = ""
        self._verdict: VerdictEvent | None = None

    @messages.handler
    def on_afloat(self, event: AfloatEvent) -> None:
        """Show the water of a scene."""
        self._sea, self._refusal, self._verdict = event.sea, "", None

    @messages.handler
    def on_water(self, event: WaterEvent) -> None:
        """Show what is to be known of the water that acts."""
        self._doubts, self._refusal = event.doubts, ""

    @messages.handler
    def on_refusal(self, event: RefusalEvent) -> None:
        """Show why something cannot be."""
        self._refusal = event.sentence

    @messages.handler
    def on_verdict(self, event: VerdictEvent) -> None:
        """Show what the inspection of a dry model says."""
        self._sea, self._doubts, self._refusal, self._verdict = None, (), "", event

    @messages.handler
    def on_build_gui(self, _: messages.BuildGuiEvent) -> None:
        """Build the tab."""
        self._tab.begin()
        if self._sea is not None:
            self._build_sea(self._sea)
        if self._verdict is not None:
            self._build_verdict(self._verdict)
        if self._refusal:
            warn([self._refusal])
        warn(self._doubts)
        imgui.End()

    def _build_sea(self, sea: SeaState) -> None:
        """All that says what water there is."""
        changes: dict[str, object] = {}
        if open_section("Waves"):
            imgui.SetNextItemWidth(-1.0)
            index = SPECTRA.index(sea.spectrum)
            moved, chosen = imgui.Combo("##spectrum", index, list(SPECTRA))
            if moved:
                changes["spectrum"] = SPECTRA[chosen]
            self._build_sliders(sea, ("height", "period", "heading"), changes)
            imgui.SetNextItemWidth(0.62 * imgui.GetContentRegionAvail().x)
            moved, seed = imgui.InputInt("seed", sea.seed)
            if moved:
                changes["seed"] = min(max(int(seed), 0), MOST_SEED)
        if open_section("Current"):
            if sea.current is None:
                imgui.TextWrapped("by depth or time, as in the scene")
            self._build_sliders(sea, ("current", "current_heading"), changes)
        if open_section("Water"):
            self._build_sliders(sea, ("density", "level"), changes)
        if imgui.Button("Calm", imgui.Vec2(-1.0, 0.0)):
            changes = {"spectrum": STILL, "current": 0.0}
        if imgui.Button("As in the scene", imgui.Vec2(-1.0, 0.0)):
            changes = {"spectrum": SCENE}
        if changes:
            self._sea = sea.change(**changes)
            self.viewer.send_to_sim(SeaSnapshot(self._sea))

    def _build_sliders(
        self, sea: SeaState, fields: tuple[str, ...], changes: dict[str, object]
    ) -> None:
        """A slider for each of some fields, which notes where it was moved to."""
        for field in fields:
            value = getattr(sea, field)
            new = slide(field, RANGES[field], 0.0 if value is None else float(value))
            if new is not None:
                changes[field] = new

    def _build_verdict(self, verdict: VerdictEvent) -> None:
        """What is known of a dry model, and the button that puts it into water."""
        if verdict.can_float and imgui.Button("Put this into water", imgui.Vec2(-1.0, 0.0)):
            self.viewer.send_to_sim(LaunchEvent())
        for line in verdict.lines:
            imgui.TextWrapped(line)
