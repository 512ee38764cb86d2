"""How a recording is laid out: axes with labels, lines with names, and the whole summary."""

import math
import re

import numpy as np
import pytest
import scipy.signal
from hypothesis import given
from hypothesis import strategies as st
from rerun.chunk import RrdReader

from buoyancy_mj import RegularWave, Simulation, Water, read_scene
from buoyancy_mj.scenes import catalog
from buoyancy_mj.viz import palette, ticks
from buoyancy_mj.viz.recording import Recording
from buoyancy_mj.viz.spectra import estimate_spectra

BLACK, WHITE = (13, 13, 13), (255, 255, 255)
finite = st.floats(-1e6, 1e6)


def count_labels(low, high, step):
    """Multiples of a step that stand clear of both ends of an axis."""
    edge = 0.02 * (high - low)
    return math.floor((high - edge) / step) - math.ceil((low + edge) / step) + 1


@given(finite, finite, st.floats(70.0, 800.0))
def test_an_axis_has_three_labels_around_its_values(one, other, pixels):
    low, high = min(one, other), max(one, other)
    bottom, top = ticks.choose_range(low, high, pixels)
    assert bottom < low <= high < top
    # the viewer labels the finest power of ten whose labels have room
    step = 10.0 ** math.ceil(math.log10((top - bottom) * ticks.TEXT_HEIGHT / pixels) - 1e-9)
    assert count_labels(bottom, top, step) >= 3


def test_an_axis_is_no_wider_than_it_must_be():
    assert ticks.choose_range(-31.0, 33.0, 200.0) == pytest.approx((-35.4, 37.4), abs=0.2)
    # 1 would be too fine for this height, and so 0, 10 and 20 have to be there
    low, high = ticks.choose_range(1.0, 18.0, 150.0)
    assert -2.5 < low < 0.0
    assert 20.0 < high < 22.5


def test_what_does_not_change_is_a_level_line_and_not_its_rounding():
    low, high = ticks.choose_range(234.4, 234.4 + 1e-12, 200.0)
    assert high - low > 0.2
    assert low < 234.4 < high


@given(st.floats(0.0, 1e4), st.floats(0.0, 1e6), st.sampled_from([350.0, 750.0]))
def test_the_axis_of_time_has_three_labels_and_room_behind_the_run(begin, length, pixels):
    free = 0.17
    end = ticks.choose_end(begin, begin + length, free, pixels)
    assert end >= (begin + length / (1.0 - free)) * (1.0 - 1e-12)
    step = next(one for one in ticks.TIME_STEPS if (end - begin) / one * ticks.TEXT_WIDTH <= pixels)
    assert math.floor(end / step) - math.ceil(begin / step) + 1 >= 3


def test_no_two_meanings_have_one_colour_and_each_is_seen_on_black_and_white():
    colours = [*palette.COLOURS.values(), palette.NEUTRAL]
    assert len(set(colours)) == len(colours)
    for i, colour in enumerate(colours):
        for other in colours[:i]:
            assert np.linalg.norm(np.subtract(colour, other)) > 35.0, (colour, other)
        for behind in (BLACK, WHITE):
            assert contrast(colour, behind) > 1.7, (colour, behind)


def contrast(one, other):
    """The contrast of two colours by WCAG 2.2: (L1 + 0.05) / (L2 + 0.05) of relative luminances."""
    parts = np.array([one, other]) / 255.0
    linear = np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
    light = np.sort(linear @ [0.2126, 0.7152, 0.0722]) + 0.05
    return light[1] / light[0]


def test_the_spectrum_of_a_wave_has_its_variance_at_its_frequency():
    water = Water(waves=RegularWave(amplitude=0.3, frequency=0.5))
    times = np.linspace(0.0, 20.0, 1200, endpoint=False)
    series = np.array([water.elevation(0.0, 0.0, time) for time in times])
    frequencies, densities = estimate_spectra(times, series[:, None])
    assert frequencies[np.argmax(densities)] == pytest.approx(0.5, abs=frequencies[1])
    assert densities.sum() * frequencies[1] == pytest.approx(0.5 * 0.3**2, rel=0.02)


@pytest.mark.parametrize("length", [100, 101, 3001, 3002])
def test_spectra_are_those_of_scipy(length):
    times = np.arange(length) / 60.0
    random = np.random.default_rng(length)
    series = np.sin(9.0 * times)[:, None] + random.normal(size=(length, 2)) + 0.1 * times[:, None]
    window = length if times[-1] * 9.0 / (2.0 * np.pi) < 64.0 else 2 * length // 5
    expected = scipy.signal.welch(series, 60.0, nperseg=window, detrend="linear", axis=0)
    frequencies, densities = estimate_spectra(times, series)
    assert frequencies == pytest.approx(expected[0])
    assert densities == pytest.approx(expected[1], rel=1e-9, abs=1e-12)


# what is in the file


def read_blueprints(path):
    """The values of each component of each layout in a file."""
    reader = RrdReader(str(path))
    layouts = []
    for store in reader.blueprints():
        parts = {}
        for chunk in reader.stream(store=store).to_chunks():
            for column, values in chunk.to_record_batch().to_pydict().items():
                parts.setdefault(chunk.entity_path, {})[column] = values
        layouts.append(parts)
    return layouts


def read_static(path):
    """The components that stay the same, of each entity."""
    entities = {}
    for chunk in RrdReader(str(path)).stream().to_chunks():
        if chunk.is_static:
            entities.setdefault(chunk.entity_path, {}).update(chunk.to_record_batch().to_pydict())
    return entities


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A short run in waves: its summary, the layout in its file, and what stays the same in it."""
    path = tmp_path_factory.mktemp("layout") / "run.rrd"
    scene = read_scene(catalog.scenes()["auv_waves"], ["duration=3", "added_mass=estimate"])
    simulation = Simulation(scene)
    recording = Recording(simulation, path)
    for frame in simulation.frames():
        recording.add(frame)
    recording.close(simulation.summary())
    return simulation.summary(), read_blueprints(path), read_static(path)


def list_views(layout, kind):
    """Name, queried entities and value range of each view of a kind."""
    for entity, parts in layout.items():
        if parts.get("ViewBlueprint:class_identifier") == [[kind]]:
            axis = layout.get(f"{entity}/ScalarAxis", {}).get("ScalarAxis:range", [None])
            query = layout[f"{entity}/ViewContents"]["ViewContents:query"][0]
            yield parts["ViewBlueprint:display_name"][0][0], query, axis


def test_a_file_has_the_layout_of_its_end_alone(run):
    assert len(run[1]) == 1


def test_every_axis_has_a_unit_and_a_range_with_three_labels(run):
    views = list(list_views(run[1][0], "TimeSeries"))
    assert len(views) > 10
    for name, _, axis in views:
        assert re.search(r"\[.+\]", name), name
        # the DVL and the hydrophone have never measured
        if name in ("sensors [m/s]", "sensors [rad]"):
            assert axis == [None]
        else:
            low, high = axis[0][0]
            assert high > low, name
    bars = [name for name, _, _ in list_views(run[1][0], "BarChart")]
    assert bars == [
        "surface [m^2/Hz] over frequency [Hz]",
        "heave [m^2/Hz] over frequency [Hz]",
        "roll [degrees^2/Hz] over frequency [Hz]",
        "pitch [degrees^2/Hz] over frequency [Hz]",
    ]


def test_every_line_that_is_plotted_has_a_name_and_a_legend_holds_them_all(run):
    plotted = [query for _, query, _ in list_views(run[1][0], "TimeSeries")]
    for lines in plotted:
        assert 1 <= len(lines) <= 8
        for line in lines:
            style = run[2][line.removeprefix("+ ")]
            (name,) = style["SeriesLines:names"][0]
            assert name
    # each in one plot
    lines = [line for lines in plotted for line in lines]
    assert len(set(lines)) == len(lines)


def test_small_forces_are_plotted_apart_from_large_ones(run):
    groups = {name: query for name, query, _ in list_views(run[1][0], "TimeSeries")}
    large = {line.rpartition("/")[2] for line in groups["forces [N]"]}
    assert {"weight", "buoyancy"} <= large
    assert "smaller forces [N]" in groups or {"drag", "added_mass"} <= large


def test_spectra_are_in_the_file(run):
    for kind in ("surface", "heave", "roll", "pitch"):
        assert run[2][f"/spectra/{kind}"]["BarChart:values"], kind


def test_the_text_of_the_summary_has_each_of_its_rows(run):
    summary = run[0]
    ((whole,),) = run[2]["/summary"]["TextDocument:text"]
    for row in summary.rows():
        assert " | ".join(row) in whole, row
    ((short,),) = run[2]["/numbers"]["TextDocument:text"]
    for row in summary.numbers():
        assert " | ".join(row) in short, row
