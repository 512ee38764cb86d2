"""What a recording of an inspection shows beside the vessel."""

import math

import numpy as np
import pytest

from buoyancy_mj import righting_arm
from buoyancy_mj.viz.centre_labels import APART, NAMES, draw_centres, spread_heights
from buoyancy_mj.viz.righting_chart import HEIGHT, WIDTH, RightingChart

from . import vessels


class Stream:
    """A stream that keeps what is logged."""

    def __init__(self):
        self.logged = {}

    def log(self, entity, data, *, static):
        assert static
        self.logged[entity] = data


def test_names_that_are_far_enough_from_each_other_stay_at_their_heights():
    assert spread_heights(np.array([0.0, 1.0, 3.0]), 0.5) == pytest.approx([0.0, 1.0, 3.0])


def test_names_at_one_height_stand_over_each_other_about_it():
    heights = spread_heights(np.array([0.0, 0.0, 0.0, 2.0]), 0.1)
    assert heights == pytest.approx([-0.1, 0.0, 0.1, 2.0])


def test_no_two_letters_are_on_top_of_each_other():
    points = {letter: np.array([0.0, 0.0, 0.001 * i]) for i, letter in enumerate(NAMES)}
    stream = Stream()
    draw_centres(stream, "boat", points, 2.0, np.array([1.0, 0.0, 0.0]), 0.0)
    names = stream.logged["boat/centres/names"]
    ends = np.array(names.positions.as_arrow_array().to_pylist())
    assert (np.diff(ends[:, 2]) >= APART * 2.0 - 1e-6).all()
    labels = names.labels.as_arrow_array().to_pylist()
    assert labels[0] == "G  centre of gravity"
    assert [label.split()[0] for label in labels] == list(NAMES)


def test_the_chart_has_round_ticks_in_degrees_and_marks_where_stability_vanishes():
    arm = righting_arm(vessels.box())
    stream = Stream()
    RightingChart({"boat": arm}).draw(stream)
    numbers = stream.logged["righting/axes/numbers"].labels.as_arrow_array().to_pylist()
    degrees = [number for number in numbers if number.endswith("\u00b0")]
    assert degrees == [f"{angle}\u00b0" for angle in range(0, 181, 30)]
    assert 3 <= len(numbers) - len(degrees) <= 10
    labels = stream.logged["righting/boat/marks/names"].labels.as_arrow_array().to_pylist()
    heel, most = arm.maximum
    assert labels == [
        f"largest, {most:.3g} m at {math.degrees(heel):.0f} degrees",
        f"stability vanishes at {math.degrees(arm.vanishing):.0f} degrees",
    ]
    curve = np.array(stream.logged["righting/boat"].strips.as_arrow_array().to_pylist()[0])
    assert curve.min() >= -1e-9
    assert (curve.max(axis=0) <= [WIDTH + 1e-6, HEIGHT + 1e-6]).all()
