"""What a notebook shows: tables and charts of values, and of a run."""

import math
import os
import sys
import types
from html.parser import HTMLParser

import mujoco
import numpy as np
import pytest

from buoyancy_mj import (
    CurrentProfile,
    JonswapSea,
    RegularWave,
    SceneError,
    Simulation,
    Water,
    hydrostatics,
    read_scene,
)
from buoyancy_mj.displays.charts import draw_chart
from buoyancy_mj.displays.tables import write_table
from buoyancy_mj.scenes import catalog
from buoyancy_mj.viz import notebook


class Reader(HTMLParser):
    """Reads texts, and refuses elements that are not closed."""

    def __init__(self, page):
        super().__init__()
        self.open, self.texts, self.counts = [], [], {}
        self.feed(page)
        assert self.open == []

    def handle_starttag(self, tag, _):
        self.open.append(tag)
        self.counts[tag] = self.counts.get(tag, 0) + 1

    def handle_startendtag(self, tag, _):
        self.counts[tag] = self.counts.get(tag, 0) + 1

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.texts.append(data)


def simulate(scene, *settings):
    return Simulation(read_scene(catalog.scenes()[scene], settings))


@pytest.fixture
def without_viewer(monkeypatch):
    monkeypatch.setattr(notebook, "_make_viewer", lambda: None)


def test_names_may_hold_anything():
    texts = Reader(write_table("<b>", [("a & b", '"<i>"')], ("", "<"))).texts
    assert texts == ["<b>", "<", "a & b", '"<i>"']


def test_a_chart_has_units_and_at_least_three_ticks_on_each_axis():
    x = np.linspace(0.0, 7.3, 50)
    page = Reader(draw_chart(x, {"one": np.sin(x), "two": np.cos(x)}, "time [s]", "height [m]"))
    assert {"time [s]", "height [m]", "one", "two"} <= set(page.texts)
    numbers = [text for text in page.texts if text.replace(".", "").replace("-", "").isdigit()]
    assert len(numbers) >= 6
    assert page.counts["polyline"] == 2


def test_a_curve_has_gaps_where_it_is_not_known_and_may_be_constant():
    x = np.arange(9.0)
    assert (
        Reader(draw_chart(x, {"": np.where(x == 4.0, math.nan, x)}, "x", "y")).counts["polyline"]
        == 2
    )
    assert Reader(draw_chart(x, {"": np.ones(9)}, "x", "y")).counts["polyline"] == 1
    assert "nan" not in draw_chart(x, {"": np.full(9, math.nan)}, "x", "y")


def test_water_is_shown_with_its_surface_and_a_sea_with_its_spectrum():
    assert "svg" not in Reader(Water()._repr_html_()).counts
    assert Reader(Water(waves=RegularWave(0.3, period=4.0))._repr_html_()).counts["svg"] == 1
    sea = Reader(Water(1025.0, waves=JonswapSea(2.0, 8.0, components=50))._repr_html_())
    assert sea.counts["svg"] == 2
    assert {"1025 kg/m^3", "spectrum [m^2/Hz]", "frequency [Hz]"} <= set(sea.texts)
    profile = Water(current=CurrentProfile([0.0, 5.0], [(1.0, 0.0, 0.0), (0.0, 0.0, 0.0)]))
    assert any("CurrentProfile" in text for text in Reader(profile._repr_html_()).texts)


def test_hydrostatics_and_loads_are_shown_with_units():
    model = mujoco.MjModel.from_xml_path(str(catalog.model_path("catamaran")))
    texts = Reader(hydrostatics(model)._repr_html_()).texts
    assert {"44.2 kg", "rights itself", "floats"} <= set(texts)
    simulation = simulate("auv_waves")
    page = Reader(simulation.frame().loads._repr_html_())
    assert {"buoyancy", "z [N]", "pressure_hull", "under water [l]"} <= set(page.texts)


@pytest.mark.usefixtures("without_viewer")
def test_a_run_is_shown_with_its_summary_and_charts_of_its_motion():
    shown = simulate("auv_waves", "duration=0.5").show()
    page = Reader(shown._repr_html_())
    assert page.counts["svg"] >= 2
    assert {"roll", "pitch", "surface", "peak draft, whole run", notebook.HINT} <= set(page.texts)
    assert "peak draft, whole run: " in repr(shown)
    assert set(Reader(shown.summary._repr_html_()).texts) <= set(page.texts)


@pytest.mark.usefixtures("without_viewer")
def test_each_of_several_vehicles_has_its_curves(tmp_path):
    path = tmp_path / "two.toml"
    vehicles = "".join(
        f'[[vehicles]]\nmodel = "hourglass"\nname = "{name}"\nstart.position = [{x}, 0, 0]\n'
        for name, x in (("one", 0), ("other", 2))
    )
    path.write_text(f'title = "two"\nduration = 0.1\ntimestep = 0.01\n{vehicles}')
    page = Reader(Simulation(read_scene(path)).show()._repr_html_())
    assert {"one", "other", "roll one", "pitch other"} <= set(page.texts)


@pytest.mark.usefixtures("without_viewer")
def test_a_run_is_shown_once():
    simulation = simulate("auv_waves", "duration=0.1")
    simulation.show()
    with pytest.raises(SceneError, match=r"the scene has run to 0.1 s; to show it, make another"):
        simulation.show()


def test_the_viewer_gets_the_whole_recording_where_it_is_installed(monkeypatch):
    class Viewer:
        def __init__(self, **size):
            self.size = size

        def send_rrd(self, data):
            self.data = data

    monkeypatch.setitem(sys.modules, "rerun_notebook", types.SimpleNamespace(Viewer=Viewer))
    shown = simulate("auv_waves", "duration=0.1").show()
    assert shown.size == {"width": notebook.WIDTH, "height": notebook.HEIGHT}
    assert shown.data.startswith(b"RRF")
    assert b"/summary" in shown.data
    # its own viewer, and none from a server
    assert os.environ["RERUN_NOTEBOOK_ASSET"] == "inline"
