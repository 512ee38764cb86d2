"""The referee of the Singapore AUV Challenge: what it sees, and what that is worth."""

import math

import mujoco
import numpy as np
import pytest

from buoyancy_mj import ModelError, RegularWave, SceneError, Water, add_water, mission, sauvc_arena
from buoyancy_mj.environments.sauvc.rules import Deeds, may_take_part, score, score_build

HALF = np.array([0.3, 0.2, 0.15])
"""Half length, width and height of the box that is moved through the arena [m]."""
GATE = np.array([3.5, -0.4, -1.488 + 0.5])
"""Middle of the final's gate, in the layout of the figure [m]."""
LANE = 4.0
"""Middle of the lane to port [m]."""


class Puppet:
    """A box in an arena that a test moves by hand, and the referee that watches it."""

    def __init__(self, task="course", arena=None, prefix="my/", mass=40.0, beam=0.0, **options):
        spec = arena or sauvc_arena(task)
        vehicle = mujoco.MjSpec()
        body = vehicle.worldbody.add_body(name="box")
        body.add_freejoint(name="box")
        body.add_geom(name="hull", type=mujoco.mjtGeom.mjGEOM_BOX, size=HALF, mass=mass)
        if beam:
            # what a sonar sees is drawn, and cannot be touched
            drawn = {"contype": 0, "conaffinity": 0, "mass": 0.0}
            body.add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[beam, 0.0, 0.0], **drawn)
        spec.attach(vehicle, prefix=prefix, frame=spec.worldbody.add_frame())
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        self.place = np.array([-11.6, LANE if task == "qualification" else 1.2, -0.5])
        self.yaw = 0.0
        self._put(f"{prefix}box", self.place)
        self.name = f"{prefix}box"
        self.referee = mission(self.model, self.data, **options)
        self.look()

    def _put(self, joint, place, quat=(1.0, 0.0, 0.0, 0.0)):
        start = self.model.joint(joint).qposadr[0]
        self.data.qpos[start : start + 7] = [*place, *quat]

    def look(self, seconds=0.0):
        """Let time pass, and let the referee look."""
        self.data.time += seconds
        half = 0.5 * self.yaw
        self._put(self.name, self.place, (math.cos(half), 0.0, 0.0, math.sin(half)))
        mujoco.mj_forward(self.model, self.data)
        self.referee.update()

    def go(self, *places, yaw=None, step=0.25, speed=1.0):
        """Move in straight lines to each of some places, and look at every `step` metres."""
        self.yaw = self.yaw if yaw is None else yaw
        for place in places:
            start, end = self.place, np.array(place, float)
            length = float(np.linalg.norm(end - start))
            count = max(1, round(length / step))
            for share in np.arange(1, count + 1) / count:
                self.place = start + share * (end - start)
                self.look(length / count / speed)

    def drop(self, ball, place):
        """Put a ball somewhere."""
        self._put(ball, place)
        self.look(0.1)

    def kinds(self):
        return [event.kind for event in self.referee.events]

    def passed(self):
        return [event for event in self.referee.events if event.kind == "gate passed"]

    @property
    def points(self):
        return self.referee.report.points


def through_gate(**options):
    """A box that has passed the gate of the final."""
    puppet = Puppet(**options)
    puppet.go((1.0, GATE[1], GATE[2]), (6.0, GATE[1], GATE[2]))
    assert puppet.points == 15
    return puppet


# the gate ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("step", [0.01, 0.13, 0.5, 4.0])
def test_the_gate_is_passed_when_the_last_of_the_vehicle_is_through(step):
    puppet = Puppet()
    puppet.go(GATE - [1.0, 0.0, 0.0])
    start = puppet.data.time
    puppet.go(GATE + [2.0, 0.0, 0.0], step=step, speed=0.7)
    (event,) = puppet.passed()
    # its stern is 30 cm behind its middle
    assert event.time == pytest.approx(start + (1.0 + HALF[0]) / 0.7, abs=1e-9)
    assert event.detail == "gate, away from the start, bow first"
    assert puppet.points == 15


@pytest.mark.parametrize(
    "shift",
    [(0.0, 1.5, 0.0), (0.0, -2.0, 0.0), (0.0, 0.0, 0.68), (0.0, 0.6, 0.0), (0.0, 0.0, 0.36)],
    ids=["to port", "to starboard", "over the bar", "half past a post", "half over the bar"],
)
def test_who_goes_past_a_post_or_over_the_bar_has_not_passed(shift):
    puppet = Puppet()
    puppet.go(GATE - [1.5, 0.0, 0.0] + shift, GATE + [1.5, 0.0, 0.0] + shift)
    assert not puppet.passed()
    assert puppet.points <= 0


def test_half_a_passage_does_not_count_and_a_whole_one_after_it_does():
    puppet = Puppet()
    puppet.go(GATE - [1.0, 0.0, 0.0], GATE, GATE - [1.0, 0.0, 0.0], GATE, step=0.07)
    assert not puppet.passed()
    puppet.go(GATE + [1.0, 0.0, 0.0])
    assert len(puppet.passed()) == 1


def test_two_halves_by_different_ways_are_no_passage():
    # the bow through the opening and back, then the whole vehicle round the gate
    puppet = Puppet()
    puppet.go(GATE - [1.0, 0.0, 0.0], GATE, GATE - [1.0, 0.0, 0.0])
    puppet.go(GATE + [-1.0, 2.0, 0.0], GATE + [1.0, 2.0, 0.0], GATE + [1.0, 0.0, 0.0])
    assert not puppet.passed()
    puppet.go(GATE - [1.0, 0.0, 0.0])
    assert [event.detail for event in puppet.passed()] == ["gate, back to the start, stern first"]


def test_a_passage_from_behind_is_told_and_gives_no_points():
    puppet = Puppet()
    puppet.go((-3.0, 5.0, -0.6), GATE + [2.0, 5.0, 0.3], GATE + [2.0, 0.0, 0.0], yaw=math.pi)
    puppet.go(GATE - [2.0, 0.0, 0.0])
    assert [event.detail for event in puppet.passed()] == ["gate, back to the start, bow first"]
    assert puppet.points == 0


def test_a_vehicle_may_pass_stern_first_or_turned():
    for yaw, words in ((math.pi, "stern"), (0.7, "bow")):
        puppet = Puppet()
        puppet.go(GATE - [1.0, 0.0, 0.0], GATE + [1.0, 0.0, 0.0], yaw=yaw)
        assert puppet.passed()[0].detail == f"gate, away from the start, {words} first"


def test_a_vehicle_that_is_too_wide_as_it_is_turned_has_not_passed():
    # 0.6 m by 0.4 m reaches 0.36 m to each side at 0.98 rad, and the opening is 0.71 m to a side
    for aside, count in ((0.34, 1), (0.36, 0)):
        puppet = Puppet()
        shift = np.array([0.0, aside, 0.0])
        puppet.go(GATE - [1.0, 0.0, 0.0] + shift, GATE + [1.0, 0.0, 0.0] + shift, yaw=0.98)
        assert len(puppet.passed()) == count


def test_what_is_only_drawn_is_no_part_of_the_vehicle():
    puppet = Puppet(beam=1.0)
    puppet.go(GATE - [2.0, 0.0, 0.0], GATE + [2.0, 0.0, 0.0])
    assert len(puppet.passed()) == 1


def count_by_hand(start, end, yaw):
    """Passages of the box on a straight line: every corner, a thousand places of it."""
    signs = np.array(np.meshgrid(*[[-1.0, 1.0]] * 3)).reshape(3, -1).T
    turn = np.array([[math.cos(yaw), -math.sin(yaw)], [math.sin(yaw), math.cos(yaw)]])
    corners = signs * HALF
    corners[:, :2] = corners[:, :2] @ turn.T
    for corner in corners:
        line = start + np.linspace(0.0, 1.0, 1001)[:, None] * (end - start) + corner - GATE
        beyond = np.flatnonzero(line[:, 0] >= 0.0)
        if not len(beyond) or beyond[0] == 0:
            return 0
        _, y, z = line[beyond[0]]
        if abs(y) > 0.71 or abs(z) > 0.5:
            return 0
    return 1


def test_the_referee_counts_as_one_does_by_hand():
    puppet = Puppet()
    draw = np.random.default_rng(5)
    counts = {0: 0, 1: 0}
    for _ in range(60):
        # a new attempt on a line of its own, seen a few times
        start = GATE + [-1.2, *draw.uniform(-0.6, 0.6, 2)]
        end = GATE + [draw.uniform(-0.5, 2.0), *draw.uniform(-0.6, 0.6, 2)]
        yaw = draw.uniform(-math.pi, math.pi)
        puppet.data.time = 0.0
        puppet.place, puppet.yaw = start, yaw
        puppet.look()
        puppet.go(end, step=draw.uniform(0.1, 1.5))
        number = count_by_hand(start, end, yaw)
        counts[number] += 1
        assert len(puppet.passed()) == number, (start, end, yaw)
    assert min(counts.values()) > 10


def test_a_gate_that_swings_is_passed_in_its_own_frame():
    puppet = Puppet("qualification")
    adr = puppet.model.joint("gate_port").qposadr[0]
    puppet.go((-4.0, LANE, -0.7))
    start = puppet.data.time
    # it swings away from the vehicle by as much as the vehicle moves
    for angle in np.linspace(0.0, -0.4, 9):
        puppet.data.qpos[adr] = angle
        puppet.place = np.array([-4.0 + 0.72 * math.tan(-angle), LANE, -0.7])
        puppet.look(0.1)
    assert not puppet.passed()
    puppet.data.qpos[adr] = 0.0
    puppet.go((-1.5, LANE, -0.7))
    assert [event.time > start for event in puppet.passed()] == [True]


# the qualification ------------------------------------------------------------------------------


def out(puppet):
    puppet.go((-4.0, LANE, -0.6), (-1.0, LANE, -0.6))


def test_through_the_gate_round_and_back_is_qualified():
    puppet = Puppet("qualification")
    out(puppet)
    assert puppet.points == 1
    puppet.go((0.0, LANE, -0.6), (-6.0, LANE, -0.6), yaw=math.pi)
    report = puppet.referee.report
    assert (report.points, report.ended, report.task) == (2, "qualified", "qualification")
    assert report.run_time == pytest.approx(puppet.passed()[1].time)


def test_the_way_back_needs_a_u_turn():
    puppet = Puppet("qualification")
    out(puppet)
    puppet.go((-6.0, LANE, -0.6))
    assert (puppet.points, puppet.referee.ended) == (1, "")
    assert "no U-turn" in puppet.kinds()


def test_the_way_back_through_the_other_gate_does_not_count():
    puppet = Puppet("qualification")
    out(puppet)
    puppet.go((-1.0, -LANE, -0.6), (-6.0, -LANE, -0.6), yaw=math.pi)
    assert (len(puppet.passed()), puppet.points) == (2, 1)


def test_who_touches_the_gate_of_the_qualification_has_failed():
    puppet = Puppet("qualification")
    out(puppet)
    puppet.go((-2.5, LANE + 0.6, -0.6), yaw=math.pi)
    assert (puppet.points, puppet.referee.ended) == (0, "the gate was touched")


@pytest.mark.parametrize(
    ("place", "what"),
    [((-1.0, LANE, -1.45), "bottom"), ((-1.0, 7.9, -0.6), "wall"), ((-1.0, LANE, -0.1), None)],
)
def test_bottom_wall_and_surface_end_the_run_and_leave_the_first_point(place, what):
    puppet = Puppet("qualification")
    out(puppet)
    puppet.go(place)
    ended = f"the {what} was touched" if what else "surfaced"
    assert (puppet.points, puppet.referee.ended) == (1, ended)


def test_a_vehicle_may_start_at_the_wall():
    puppet = Puppet("qualification")
    puppet.go((-12.25, LANE, -0.6))
    assert puppet.data.ncon > 0
    out(puppet)
    assert "wall touched" not in puppet.kinds()
    assert puppet.points == 1


# start, surface, bounds and time ----------------------------------------------------------------


def test_a_vehicle_may_be_at_the_surface_in_the_start_zone_alone():
    puppet = Puppet()
    puppet.go((-11.6, 1.2, 0.0), (-11.6, 1.2, -0.4))
    assert not puppet.referee.ended
    puppet.go((-8.0, 1.2, -0.4))
    assert puppet.kinds() == ["submerged", "left start"]
    puppet.go((-7.0, 1.2, -0.1))
    assert puppet.referee.ended == "surfaced"
    assert puppet.points == 5


def test_who_leaves_the_start_zone_without_going_under_has_ended():
    puppet = Puppet()
    puppet.place = np.array([-11.6, 1.2, 0.0])
    puppet.data.time = -1.0
    puppet.look()
    puppet.go((-8.0, 1.2, 0.0))
    assert puppet.referee.ended == "left the start zone at the surface"
    assert puppet.points == 0


def test_the_surface_is_that_of_the_waves():
    # 15 cm of water over its deck, and a trough of 20 cm
    water = Water(waves=RegularWave(amplitude=0.2, period=4.0))
    ended = []
    for sea in (Water(), water):
        puppet = Puppet(water=sea)
        puppet.go((-6.0, -4.0, -0.3))
        for _ in range(20):
            puppet.look(0.2)
        ended.append(puppet.referee.ended)
    assert ended == ["", "surfaced"]


def test_the_referee_takes_the_water_of_the_model():
    arena = sauvc_arena("course")
    add_water(arena, Water(level=-0.2), added_mass="none")
    puppet = Puppet(arena=arena)
    puppet.go((-8.0, 1.2, -0.3))
    assert puppet.referee.ended == "left the start zone at the surface" or (
        puppet.referee.ended == "surfaced"
    )


def test_who_leaves_the_pool_has_ended():
    puppet = Puppet()
    puppet.go((-6.0, -4.0, -0.5), (-6.0, -9.0, -0.5))
    assert puppet.referee.ended == "out of the pool"


def test_the_time_is_up_after_15_minutes():
    puppet = through_gate()
    puppet.look(880.0)
    assert not puppet.referee.ended
    puppet.look(20.0)
    assert (puppet.referee.ended, puppet.points) == ("the time was up", 15)


def test_nothing_counts_after_the_end():
    puppet = through_gate()
    puppet.go((6.0, GATE[1], -0.1))
    points = puppet.points
    puppet.drop("red_flare_ball", (0.0, 0.0, -1.5))
    assert puppet.points == points == 15 + 5


def test_a_new_attempt_begins_where_time_falls_back():
    puppet = through_gate()
    mujoco.mj_resetData(puppet.model, puppet.data)
    puppet.place = np.array([-11.6, 1.2, -0.5])
    puppet.look()
    assert (puppet.points, puppet.kinds()) == (0, ["submerged"])


# flares -----------------------------------------------------------------------------------------


def test_flares_count_when_their_balls_fall_and_more_in_their_order():
    for order, extra in (("R-Y-B", 60), ("B-Y-R", 0)):
        puppet = through_gate(order=order)
        for number, colour in enumerate(("red", "yellow", "blue"), 1):
            puppet.drop(f"{colour}_flare_ball", (0.0, number - 2.0, -1.5))
            assert puppet.points == 15 + 20 * number + (extra if number == 3 else 0)
        fell = [event.detail for event in puppet.referee.events if event.kind == "ball fell"]
        assert fell == ["red", "yellow", "blue"]


def test_a_flare_before_the_gate_gives_no_points():
    puppet = Puppet()
    puppet.drop("red_flare_ball", (0.0, 0.0, -1.5))
    puppet.go((1.0, GATE[1], GATE[2]), (6.0, GATE[1], GATE[2]))
    assert puppet.points == 15
    assert [event.detail for event in puppet.referee.events if event.kind == "ball fell"] == [
        "red, before the gate"
    ]


def test_the_arena_says_in_which_order_flares_are_to_be_bumped():
    puppet = through_gate(arena=sauvc_arena("course"))
    for colour in ("red", "yellow", "blue"):
        puppet.drop(f"{colour}_flare_ball", (0.0, 0.0, -1.5))
    assert puppet.points == 15 + 60 + 60


def test_a_touch_of_a_flare_is_told_and_costs_nothing():
    puppet = through_gate()
    x, y, _ = puppet.data.body("yellow_flare").xpos
    puppet.go((x + 1.0, y, -1.1), (x + 0.3, y, -1.1), (x + 1.0, y, -1.1))
    assert ("flare touched", "yellow") in [(e.kind, e.detail) for e in puppet.referee.events]
    assert puppet.points == 15


def test_the_orange_flare_ends_the_attempt():
    puppet = through_gate()
    x, y, _ = puppet.data.body("orange_flare").xpos
    puppet.go((1.0, GATE[1], GATE[2]), (x + 1.0, y, -0.6), (x + 0.35, y, -0.6))
    assert puppet.referee.ended == "aborted: the orange flare was touched"
    assert puppet.points == 15


# drums ------------------------------------------------------------------------------------------


def in_drum(puppet, name, shift=(0.0, 0.0, 0.0)):
    return puppet.data.site(name).xpos + shift


@pytest.mark.parametrize(
    ("drum", "points"),
    [("blue_drum", 30), ("red_drum_1", 50), ("red_drum_2", 10), ("red_drum_3", 10)],
)
def test_the_drum_of_the_ball_gives_its_points(drum, points):
    puppet = through_gate()
    puppet.drop("ball", in_drum(puppet, drum, (0.1, 0.1, -0.1)))
    assert puppet.points == 15 + points


@pytest.mark.parametrize("shift", [(0.3, 0.0, 0.0), (0.0, 0.0, 0.17), (0.22, 0.22, 0.0)])
def test_a_ball_beside_or_over_a_drum_is_in_none(shift):
    puppet = through_gate()
    puppet.drop("ball", in_drum(puppet, "blue_drum", shift))
    assert puppet.points == 15


def test_only_the_first_drum_counts_and_a_ball_that_is_held_is_in_none():
    puppet = through_gate()
    puppet.go((10.0, 2.4, -0.5), in_drum(puppet, "red_drum_1", (0.0, 0.0, 0.35)))
    # it hangs deep in the drum from the vehicle, which touches it
    held = puppet.place - [0.0, 0.0, HALF[2] + 0.021]
    puppet.drop("ball", held)
    assert puppet.points == 15
    puppet.drop("ball", in_drum(puppet, "red_drum_2"))
    puppet.drop("ball", in_drum(puppet, "red_drum_1", (0.1, 0.0, 0.0)))
    assert puppet.points == 15 + 10


def test_the_ball_counts_again_when_it_is_held_at_the_end_after_the_gate():
    totals = []
    for is_through_again in (False, True):
        puppet = through_gate()
        puppet.drop("ball", in_drum(puppet, "blue_drum"))
        if is_through_again:
            puppet.go((6.0, GATE[1], GATE[2]), (1.0, GATE[1], GATE[2]), (6.0, GATE[1], GATE[2]))
        puppet.place = np.array([9.0, 4.8, -0.5])
        puppet.drop("ball", puppet.place - [0.0, 0.0, HALF[2] + 0.021])
        puppet.place = np.array([9.0, 4.8, -0.1])
        puppet.drop("ball", puppet.place - [0.0, 0.0, HALF[2] + 0.021])
        assert puppet.referee.ended == "surfaced"
        totals.append(puppet.points)
        left = 0.03 * (900.0 - puppet.referee.report.run_time)
        assert totals[-1] == pytest.approx(15 + 30 + 5 + left + 60 * is_through_again)
    assert totals[1] > totals[0] + 59


# touches ----------------------------------------------------------------------------------------


def test_each_touch_of_the_bottom_costs_and_the_fifth_ends_the_attempt():
    puppet = through_gate()
    for number in range(1, 6):
        puppet.go((6.0, -5.0, -1.3), (6.0, -5.0, -0.8), speed=0.5)
        assert puppet.points == 15 - 5 * min(number, 4)
    assert puppet.referee.ended == "aborted: bottom or walls touched 5 times"


def test_ten_seconds_at_the_bottom_end_the_attempt_and_that_touch_costs_nothing():
    puppet = through_gate()
    puppet.go((6.0, -5.0, -1.3))
    for _ in range(120):
        puppet.look(0.1)
    assert puppet.referee.ended.startswith("aborted: bottom or walls touched for 10.")
    assert puppet.points == 15


def test_a_touch_of_the_gate_costs_two_points():
    puppet = through_gate()
    puppet.go(GATE + [0.3, 0.7, 0.0], GATE + [1.0, 0.7, 0.0])
    assert puppet.points == 15 - 2


# points -----------------------------------------------------------------------------------------

RBY = ("red", "blue", "yellow")
EXAMPLES = [
    ({"gate_touches": 1, "has_surfaced": True}, 18),
    ({}, 15),
    ({"drum": "blue", "bottom_touches": 1}, 40),
    ({"drum": "blue", "flares": ("red",), "has_surfaced": True, "run_time": 400.0}, 85),
    ({"drum": "blue", "flares": ("red", "yellow"), "order": RBY}, 85),
    ({"drum": "blue", "flares": ("red", "yellow", "blue"), "order": RBY}, 105),
    ({"drum": "blue", "flares": RBY, "order": RBY, "has_surfaced": True, "run_time": 400.0}, 185),
]
"""The examples of the rulebook, 1 to 7. It adds up the fourth, 15 + 30 + 20 + 5 + 15, to 105; its
lines make 85."""


@pytest.mark.parametrize(("deeds", "total"), EXAMPLES)
def test_the_examples_of_the_rulebook_have_their_points(deeds, total):
    rows = score(Deeds(is_through_gate=True, **deeds))
    assert sum(points for _, points in rows) == pytest.approx(total)


def test_nothing_counts_without_the_gate():
    assert score(Deeds(drum="pinger", flares=RBY, order=RBY)) == ()


def test_the_example_of_the_time_bonus():
    rows = dict(score(Deeds(is_through_gate=True, drum="red", has_surfaced=True, run_time=420.0)))
    assert rows["time left"] == pytest.approx(14.4)


@pytest.mark.parametrize(
    ("size", "mass", "points", "may"),
    [
        ((0.6, 0.48, 0.39), 23.9, 20, True),
        ((0.6, 0.6, 0.39), 23.9, 10, True),
        ((0.39, 0.6, 0.48), 50.0, 10, True),
        ((1.4, 1.0, 1.0), 52.0, 0, True),
        ((1.5, 1.0, 1.0), 40.0, 10, False),
        ((1.4, 1.0, 1.0), 53.0, 0, False),
    ],
)
def test_the_build_of_a_vehicle_has_its_points(size, mass, points, may):
    assert score_build(size, mass) == points
    assert may_take_part(size, mass) is may


def test_the_report_is_a_table_and_plain_values():
    puppet = through_gate(mass=60.0)
    report = puppet.referee.report
    # small, but not light
    assert report.build_points == 10
    rows = report.rows()
    assert ("navigation: gate passed", "+15") in rows
    assert ("points", "15") in rows
    assert ("ended", "not yet") in rows
    values = report.values()
    assert values["score"] == [{"for": "navigation: gate passed", "points": 15}]
    assert values["events"][-1]["kind"] == "gate passed"
    first = report.events[0]
    assert first == (0.0, "too large", "0.60 x 0.40 x 0.30 m, 60.0 kg")


# finding the arena ------------------------------------------------------------------------------


def vehicle_with_arena(prefix):
    """Two vehicles: in the spec of the arena, or with the arena attached under a prefix."""
    spec = mujoco.MjSpec() if prefix else sauvc_arena("course")
    for name in ("ballast", "other"):
        body = spec.worldbody.add_body(name=name, pos=[-11.6, 1.2, -0.5])
        body.add_freejoint()
        body.add_geom(size=[0.1, 0.0, 0.0])
    if prefix:
        spec.attach(sauvc_arena("course"), prefix=prefix, frame=spec.worldbody.add_frame())
    return spec.compile()


@pytest.mark.parametrize("prefix", ["", "environment/", "pool"])
def test_the_referee_finds_the_arena_under_any_prefix(prefix):
    model = vehicle_with_arena(prefix)
    referee = mission(model, mujoco.MjData(model), vehicle="ballast")
    assert referee.report.task == "course"


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        (
            {},
            ModelError,
            r"^the model has 2 vehicles beside the arena; name the root body of one \(vehicle=\); "
            r"possible: ballast, other$",
        ),
        ({"vehicle": "balast"}, ModelError, "no vehicle 'balast' .* did you mean 'ballast'"),
        ({"task": "final"}, SceneError, "^there is no task 'final'; possible: course, qual"),
        (
            {"task": "qualification", "vehicle": "other"},
            ModelError,
            "^the task 'qualification' needs the sites 'gate_port', 'gate_starboard', which the "
            "model does not have; put sauvc_arena.'qualification'. into it",
        ),
        (
            {"order": "R-B", "vehicle": "other"},
            SceneError,
            "^order is 'R-B'; it must name each of red, yellow, blue once, as 'R-B-Y'$",
        ),
    ],
)
def test_what_cannot_be_watched_is_refused(options, error, message):
    model = vehicle_with_arena("")
    with pytest.raises(error, match=message):
        mission(model, mujoco.MjData(model), **options)


def test_a_model_without_an_arena_is_refused():
    model = mujoco.MjModel.from_xml_string("<mujoco/>")
    with pytest.raises(
        ModelError,
        match=r"^the model has no arena of the challenge, known by the sites 'pool' and "
        r"'start_zone'; put one sauvc_arena\(\) into it, or environment = 'sauvc_course' into a",
    ):
        mission(model, mujoco.MjData(model))
