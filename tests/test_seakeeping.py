"""Measures of a run: over which window they are taken, and that they are what they say."""

import dataclasses
import math

import numpy as np
import pytest
from typer.testing import CliRunner

from buoyancy_mj import (
    JonswapSea,
    LevelOscillation,
    RegularWave,
    SceneError,
    Simulation,
    Sweep,
    Water,
    read_scene,
)
from buoyancy_mj.cli import app
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.sea_state import find_sea_state
from buoyancy_mj.scenes.tally import Tally
from buoyancy_mj.scenes.windows import find_beat


def simulate(scene, *settings, **options):
    return Simulation(read_scene(catalog.scenes()[scene], settings), **options)


def catamaran(tmp_path, *settings, period=6.0, duration=20.0):
    path = tmp_path / "catamaran.toml"
    path.write_text(
        f'title = "in a wave"\nvehicle = "catamaran"\nduration = {duration}\ntimestep = 0.01\n'
        f'[[water.waves]]\nkind = "regular"\namplitude = 0.05\nperiod = {period}\n'
    )
    return read_scene(path, settings)


# windows ------------------------------------------------------------------------------------------


def test_a_regular_wave_is_as_high_as_from_crest_to_trough():
    sea = find_sea_state(Water(waves=RegularWave(0.3, period=4.0)))
    assert (sea.height, sea.period) == (pytest.approx(0.6), pytest.approx(4.0))
    assert find_sea_state(Water()).is_still
    assert find_sea_state(Water(waves=LevelOscillation(0.3, 0.5))).period == pytest.approx(2.0)


def test_the_longest_period_of_a_sea_leaves_out_what_has_no_energy():
    sea = find_sea_state(Water(waves=JonswapSea(2.0, 8.0, components=200)))
    assert sea.height == pytest.approx(2.0, rel=0.02)
    assert 8.0 < sea.period < 14.0


@pytest.mark.parametrize(
    ("period", "duration", "start", "periods"),
    [
        (2.0, 10.0, 6.0, 2),
        (6.0, 10.0, 4.0, 1),
        (8.0, 10.0, 2.0, 1),
        (3.0, 20.0, 11.0, 3),
        (5.0, 20.0, 10.0, 2),
    ],
)
def test_a_window_is_the_whole_periods_of_the_second_half_or_the_last_one(
    period, duration, start, periods, tmp_path
):
    simulation = Simulation(catamaran(tmp_path, period=period, duration=duration))
    window = simulation.run().seakeeping.window
    assert window.start == pytest.approx(start)
    assert window.end == pytest.approx(duration)
    assert window.periods == periods


def test_in_still_water_the_window_is_the_last_two_seconds():
    window = simulate("hourglass_drop_still", "duration=3.3").run().seakeeping.window
    assert (window.start, window.end) == (pytest.approx(1.3), pytest.approx(3.3))
    assert window.name == "last 2 s"


def test_a_run_that_is_shorter_than_a_wave_is_measured_as_a_whole(tmp_path):
    summary = Simulation(catamaran(tmp_path, period=6.0, duration=2.0)).run()
    window = summary.seakeeping.window
    assert (window.start, window.end, window.periods) == (0.0, pytest.approx(2.0), 0)
    assert "heave, whole run" in dict(summary.rows())


def test_a_run_that_stops_early_is_measured_over_the_last_whole_period(tmp_path):
    simulation = Simulation(catamaran(tmp_path, period=3.0, duration=20.0))
    simulation.advance(700)
    window = simulation.summary().seakeeping.window
    # parts begin at 2, 5, 8 s ...: they end where the run was to end
    assert (window.start, window.end) == (pytest.approx(2.0), pytest.approx(5.0))


# what is measured ---------------------------------------------------------------------------------


@pytest.mark.parametrize("period", [6.0, 8.0])
def test_a_catamaran_heaves_by_the_height_of_long_waves(period, tmp_path):
    summary = Simulation(catamaran(tmp_path, period=period)).run()
    heave = summary.seakeeping.heave
    assert heave.range == pytest.approx(0.1, rel=0.06)
    # its last two seconds alone show less
    simulation = Simulation(catamaran(tmp_path, period=period))
    late = [frame.centre_of_mass[2] for frame in simulation.frames() if frame.time >= 18.0]
    assert np.ptp(late) < 0.8 * heave.range
    # a harmonic motion
    assert heave.rms == pytest.approx(0.5 * heave.range / math.sqrt(2.0), rel=0.03)
    assert heave.significant == pytest.approx(4.0 * heave.rms)


def test_ranges_and_means_are_those_of_all_samples_of_the_window():
    beat = find_beat(find_sea_state(Water(waves=RegularWave(0.1, period=3.0))), 20.0)
    tally = Tally(beat, 2, [1])
    times = 0.01 * np.arange(2000)
    random = np.random.default_rng(1)
    values = np.column_stack([5.0 + random.normal(size=2000), np.sin(2.0 * math.pi * times / 3.0)])
    values[:, 1] += 7.0 * times
    for some in np.array_split(np.arange(2000), [3, 700, 701, 1500]):
        tally.add(times[some], values[some].T)
    told = tally.measure(20.0, np.array([5.0, math.sin(2.0 * math.pi * 20.0 / 3.0) + 140.0]))
    late = values[times >= 11.0 - 1e-9]
    assert told.window.start == pytest.approx(11.0)
    assert told.mean[0] == pytest.approx(late[:, 0].mean())
    assert told.rms[0] == pytest.approx(late[:, 0].std())
    assert (told.least[0], told.most[0]) == (late[:, 0].min(), late[:, 0].max())
    # less the drift, which is told besides
    assert told.most[1] - told.least[1] == pytest.approx(2.0, rel=1e-3)
    assert told.rms[1] == pytest.approx(math.sqrt(0.5), rel=1e-3)
    assert told.rate[1] == pytest.approx(7.0)


def test_measures_are_those_of_the_frames_of_a_run(tmp_path):
    simulation = Simulation(catamaran(tmp_path, "record_rate=100", period=2.0, duration=8.0))
    frames = [(frame.time, *frame.centre_of_mass, *frame.attitude) for frame in simulation.frames()]
    told = simulation.summary().seakeeping
    times, *motion = np.array(frames).T
    late = (times >= told.window.start - 1e-9) & (times < told.window.end - 1e-9)
    x, _, z, roll, pitch, _ = (values[late] for values in motion)
    assert told.heave.range == pytest.approx(np.ptp(z), rel=1e-9)
    assert told.heave.rms == pytest.approx(z.std(), rel=1e-6)
    assert told.pitch.range == pytest.approx(np.ptp(pitch), rel=1e-9)
    assert told.roll.range == pytest.approx(np.ptp(roll), abs=1e-9)
    assert told.drift[0] == pytest.approx((motion[0][-1] - x[0]) / 4.0, rel=1e-6)
    upward = np.diff(motion[2], 2) / 0.01**2
    assert told.vertical_acceleration.rms == pytest.approx(upward[late[2:]].std(), rel=0.01)


def test_what_floats_at_rest_carries_its_weight_and_no_more():
    summary = simulate("sphere_decay", "start.position=[0, 0, 0]", "duration=4").run()
    told = summary.seakeeping
    assert told.load_factor == pytest.approx(1.0, abs=0.02)
    assert told.peak_load == pytest.approx(summary.mass * 9.81, rel=0.02)
    assert told.slams == 0


def test_what_falls_into_the_water_slams_once():
    told = simulate("hourglass_drop_still", "start.position.2=1.5", "duration=1.2").run()
    assert told.seakeeping.slams == 1
    assert told.seakeeping.peak_acceleration >= 9.8


def test_the_deck_of_what_lies_under_water_is_always_wet():
    for depth, wet in ((-3.0, 1.0), (3.0, 0.0)):
        summary = simulate("auv_waves", f"start.position.2={depth}", "duration=0.3").run()
        assert summary.seakeeping.deck_wetness == wet


def test_roll_goes_on_beyond_a_turn():
    simulation = simulate("auv_waves", "start.position.2=50", "duration=0.9")
    simulation.data.qvel[3] = 10.0
    assert simulation.run().seakeeping.roll.range == pytest.approx(9.0, rel=0.05)


def test_a_summary_asked_for_under_way_does_not_change_the_next(tmp_path):
    one, two = (Simulation(catamaran(tmp_path, period=2.0, duration=5.0)) for _ in range(2))
    for _ in range(5):
        one.advance(100)
        one.frame()
        one.summary()
    two.advance(500)
    two.frame()
    for name in ("heave_rms", "surge_range", "pitch_range", "drift_x", "peak_load", "slams"):
        wanted = pytest.approx(two.summary().values()[name], rel=1e-9)
        assert one.summary().values()[name] == wanted, name


def test_natural_periods_have_the_added_mass_that_acts():
    # A and m of models/oes_sphere: 4.377 s with added mass, 3.662 s without
    for source, heave, carries in (("model", 4.377, True), ("none", 3.662, False)):
        scene = read_scene(catalog.scenes()["sphere_decay"], [f"added_mass={source}"])
        (periods,) = Simulation(scene).summary(with_periods=True).natural_periods.values()
        assert periods.heave == pytest.approx(heave, abs=2e-3)
        assert periods.with_added_mass == carries


def test_nothing_is_known_before_the_first_step():
    summary = simulate("auv_waves").summary()
    assert math.isnan(summary.seakeeping.heave.range)
    assert not any(name.startswith("heave") for name, _ in summary.rows())


# sensors ------------------------------------------------------------------------------------------


def test_a_sensor_is_measured_over_the_window(tmp_path):
    scene = catamaran(tmp_path, "record_rate=100", period=2.0, duration=5.0)
    simulation = Simulation(scene, measure=["gyro"])
    rates = [(frame.time, frame.data.sensor("gyro").data[1]) for frame in simulation.frames()]
    told = simulation.summary()
    assert set(told.sensors) == {"gyro.x", "gyro.y", "gyro.z"}
    late = np.array([rate for time, rate in rates if 3.0 - 1e-9 <= time < 5.0 - 1e-9])
    measure = told.sensors["gyro.y"]
    assert measure.mean == pytest.approx(late.mean(), rel=1e-6)
    assert (measure.least, measure.greatest) == pytest.approx((late.min(), late.max()), rel=1e-6)
    assert measure.range == pytest.approx(np.ptp(late), rel=1e-6)
    assert measure.rms == told.values()["gyro.y.rms"] == pytest.approx(late.std(), rel=1e-6)


def test_a_sensor_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(SceneError, match="there is no sensor 'gyros' to measure; did you mean"):
        Simulation(catamaran(tmp_path), measure=["gyros"])


def test_a_sweep_measures_sensors_as_a_run_of_its_own_does(tmp_path):
    scene = catamaran(tmp_path, duration=1.0)
    plan = Sweep.over(
        tmp_path / "catamaran.toml",
        ["water.waves.0.period=1.5,3"],
        tmp_path / "rows.csv",
        settings=["duration=1"],
        measure=["gyro.y", "attitude"],
    )
    for row in plan.run():
        waves = [RegularWave(0.05, period=float(row["water.waves.0.period"]))]
        water = dataclasses.replace(scene.water, waves=waves)
        alone = Simulation(dataclasses.replace(scene, water=water), measure=["gyro.y", "attitude"])
        values = alone.run().values()
        for name in ("gyro.y.rms", "gyro.y.mean", "heave_rms", "surge_range", "peak_load"):
            assert float(row[name]) == pytest.approx(values[name], rel=1e-9, abs=1e-15), name


def test_a_field_may_be_given_a_list_of_words(tmp_path):
    out = tmp_path / "rows.parquet"
    words = ["sweep", "auv_waves", "--over", "vehicle=sauvc_auv,hourglass", "--out", str(out)]
    for _ in range(2):
        told = CliRunner().invoke(app, [*words, "--set", "duration=0.1"])
        assert told.exit_code == 0, told.output
    plan = Sweep.over("auv_waves", ["mass=3,20.5"], tmp_path / "two.csv", settings=["duration=0.1"])
    assert [row["mass"] for row in plan.run()] == ["3.0", "20.5"]
