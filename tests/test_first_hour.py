"""The first hour: what the page says of its vehicle is true; test_docs runs its commands."""

import re
from pathlib import Path

import mujoco
import numpy as np
import pytest

from buoyancy_mj import Buoyancy, Simulation, Water, equilibrium, read_scene
from buoyancy_mj.inspection.inspection import inspect_model
from buoyancy_mj.scenes import catalog
from tests.scripts import ROOT, script

PAGE = ROOT / "docs" / "first_hour.md"
TEXT = PAGE.read_text()
FILES = script("page_files").page_files(PAGE)
HULL, UPRIGHT, WHOLE = (text for name, text in FILES if name == "minnow.xml")
SEA = Water(density=1025.0)


def largest_roll(folder: Path, vehicle: str) -> float:
    """The largest roll on the waves of the page [deg]."""
    (folder / "minnow.xml").write_text(vehicle)
    settings = [f"vehicle={folder / 'minnow.xml'}", "water.waves.0.amplitude=0.1", "duration=20"]
    scene = read_scene(catalog.scenes()["auv_waves"], settings)
    frames = Simulation(scene).frames()
    return max(abs(np.degrees(frame.vehicles["minnow"].attitude[0])) for frame in frames)


def test_inspect_says_of_the_hull_without_and_with_lead_what_the_page_says():
    said = re.findall(r"^```text\n(floats.*)\n```", TEXT, re.MULTILINE)
    for vehicle, sentence in zip((HULL, UPRIGHT), said, strict=True):
        found = inspect_model(mujoco.MjModel.from_xml_string(vehicle), SEA)
        assert found.vessels[0].sentence == sentence


def test_waves_roll_the_hull_over_and_lead_keeps_it_within_ten_degrees(tmp_path):
    assert largest_roll(tmp_path, HULL) > 150.0
    assert largest_roll(tmp_path, UPRIGHT) < 10.0


def test_without_added_mass_it_bobs_too_fast_by_as_much_as_the_page_says():
    model = mujoco.MjModel.from_xml_string(UPRIGHT)
    rest = equilibrium(model, SEA).hydrostatics
    matrices = Buoyancy(model, SEA, added_mass="estimate").added_mass.matrices.reshape(-1, 6, 6)
    wet = rest.displacement / (rest.displacement + rest.reserve)
    alone, carried = rest.natural_periods()[0], rest.natural_periods(wet * matrices[0])[0]
    said = re.search(r"(\d\.\d\d) s in the place of (\d\.\d\d) s", TEXT)
    assert (alone, carried) == pytest.approx((float(said[1]), float(said[2])), abs=0.01)


def test_it_dives_within_three_seconds_and_keeps_its_depth(tmp_path):
    for name, text in FILES:
        (tmp_path / name).write_text(text)
    drafts = {}
    for height in (0.1, 0.5):
        settings = [f"water.waves.0.significant_height={height}"]
        simulation = Simulation(read_scene(tmp_path / "minnow.toml", settings))
        drafts[height] = simulation.run().peak_draft
    said = re.search(r"keel comes (\d\.\d\d) m under .* it is (\d\.\d\d) m, under a crest", TEXT)
    assert [*drafts.values()] == pytest.approx([float(said[1]), float(said[2])], abs=0.02)
    frames = Simulation(read_scene(tmp_path / "minnow.toml")).frames()
    heights = {frame.time: frame.vehicles["minnow"].centre_of_mass[2] for frame in frames}
    assert all(abs(z + 1.0) < 0.09 for time, z in heights.items() if time > 3.0)
