"""An autopilot over real sockets: a peer of the tests' own speaks ArduPilot's JSON interface."""

import json
import os
import re
import signal
import socket
import struct
import subprocess
import sys
import threading
from pathlib import Path
from typing import ClassVar

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner

from buoyancy_mj import AutopilotError, Simulation, read_thrusters
from buoyancy_mj.autopilot.battery import Battery
from buoyancy_mj.autopilot.channels import connect, find_idle
from buoyancy_mj.autopilot.link import Link
from buoyancy_mj.autopilot.lockstep import Lockstep, Turn, find_substeps, fit_timestep
from buoyancy_mj.autopilot.motor_frames import MOTOR_FRAMES
from buoyancy_mj.autopilot.packets import Servos, parse_servos, write_answer
from buoyancy_mj.autopilot.pulses import PulseMap
from buoyancy_mj.autopilot.readings import FAR, Reading, Readings
from buoyancy_mj.autopilot.session import Session
from buoyancy_mj.autopilot.thrusters import find_thrusters
from buoyancy_mj.cli import app
from buoyancy_mj.cli.autopilots import number_recording
from buoyancy_mj.scenes.scene import scene_from_table

G = 9.81
NEUTRAL = [1500] * 16

BALL = """
<mujoco>
  <worldbody>
    {others}
    <body name="ball">
      <freejoint/>
      <geom name="ball" type="sphere" size="0.2" mass="{mass}"/>
      {inside}
    </body>
  </worldbody>
  {more}
</mujoco>
"""


def packet(frame, pulses=NEUTRAL, rate=400, magic=None):
    if magic is None:
        magic = {16: 18458, 32: 29569}[len(pulses)]
    return struct.pack(f"<HHI{len(pulses)}H", magic, rate, frame, *pulses)


class Peer:
    """An autopilot: sends a packet and waits for its answer, as ArduPilot does."""

    opened: ClassVar[list["Peer"]] = []

    def __init__(self, port):
        Peer.opened.append(self)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.connect(("127.0.0.1", port))
        self.socket.settimeout(60.0)
        self.raw = b""

    def send(self, *arguments, **options):
        self.socket.send(packet(*arguments, **options))

    def ask(self, *arguments, **options):
        self.send(*arguments, **options)
        self.raw = self.socket.recv(65536)
        return json.loads(self.raw)


def simulate(xml=None, tmp_path=None, **keys):
    table = {"title": "test", "vehicle": "bluerov2_heavy", "timestep": 0.0025}
    if xml is not None:
        path = tmp_path / "vehicle.xml"
        path.write_text(xml)
        table["vehicle"] = str(path)
    return Simulation(scene_from_table(table | keys))


def ball(tmp_path, *, mass=33.5, inside="", others="", more="", **keys):
    xml = BALL.format(mass=mass, inside=inside, others=others, more=more)
    return simulate(xml, tmp_path, **keys)


def fly(session, talk, *, patience=0.3, **options):
    """Fly with a peer in another thread; what it returns, and what `fly` returns."""
    with Link(port=0) as link:
        told = []
        thread = threading.Thread(target=lambda: told.append(talk(Peer(link.port))))
        thread.start()
        rest = session.fly(link, patience=patience, **options)
        thread.join()
        return told[0], rest, link


def session_of(simulation, frame="vectored_6dof", stated=None, rate=None):
    vehicle = simulation.vehicle
    return Session(
        simulation, vehicle, connect(simulation.model, vehicle, frame, stated), rate=rate
    )


def sense(simulation, steps=1):
    readings = Readings(simulation, simulation.vehicle)
    for _ in range(steps):
        simulation.step()
        readings.feel()
    return readings.read()


@pytest.fixture(autouse=True)
def no_socket_is_left_open():
    yield
    while Peer.opened:
        Peer.opened.pop().socket.close()


@pytest.fixture(scope="module")
def rov():
    return simulate(start={"position": [0.0, 0.0, -1.0]})


# packets and answers


def test_packets_of_sixteen_and_of_thirty_two_channels_are_read():
    assert parse_servos(packet(7, list(range(16)))) == Servos(400, 7, tuple(range(16)))
    assert parse_servos(packet(8, list(range(32)))) == Servos(400, 8, tuple(range(32)))


@pytest.mark.parametrize(
    "malformed",
    [
        b"",
        b"\x1a",
        b"hello, this is no autopilot and quite long enough",
        packet(1)[:-1],
        packet(1) + b"\0",
        packet(1, magic=18459),
        packet(1, magic=29569),
        packet(1, rate=0),
    ],
)
def test_what_is_no_packet_is_told(malformed):
    assert parse_servos(malformed) is None


def test_an_answer_is_what_the_parser_of_ardupilot_takes():
    reading = Reading(
        time=1.0 / 3.0,
        gyro=(1e-7, -2.0, 3.5),
        specific_force=(0.0, 0.0, -G),
        position=(1.0, 2.0, 3.0),
        attitude=(1.0, 0.0, 0.0, 0.0),
        velocity=(0.1, 0.2, 0.3),
        distances=(4.5, 6.0),
        battery=(16.0, 3.0),
    )
    line = write_answer(reading)

    # one line between line breaks, a name's number right behind it
    assert line.startswith(b"\n{")
    assert line.endswith(b"}\n")
    assert line.count(b"\n") == 2
    assert b" " not in line
    told = json.loads(line)
    assert told == {
        "timestamp": 1.0 / 3.0,
        "imu": {"gyro": [1e-7, -2.0, 3.5], "accel_body": [0.0, 0.0, -G]},
        "position": [1.0, 2.0, 3.0],
        "quaternion": [1.0, 0.0, 0.0, 0.0],
        "velocity": [0.1, 0.2, 0.3],
        "rng_1": 4.5,
        "rng_2": 6.0,
        "battery": {"voltage": 16.0, "current": 3.0},
    }

    # the first place of each name that ArduPilot seeks is that name's own
    text = line.decode()
    for name in ("timestamp", "gyro", "accel_body", "position", "quaternion", "velocity", "rng_1"):
        assert text[text.index(name) + len(name) :].startswith('":')


# what is sensed


def test_at_rest_afloat_the_specific_force_points_up(tmp_path):
    simulation = ball(tmp_path, mass=10.0, start={"at": "equilibrium"})
    reading = sense(simulation, 4)
    assert reading.specific_force == pytest.approx((0.0, 0.0, -G), abs=1e-5)
    assert reading.gyro == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
    assert reading.time == pytest.approx(0.01)


def test_in_free_fall_in_air_nothing_is_felt(tmp_path):
    simulation = ball(tmp_path, start={"position": [3.0, 4.0, 50.0]}, damping=False)
    reading = sense(simulation, 40)
    assert reading.specific_force == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
    assert reading.velocity == pytest.approx((0.0, 0.0, G * 0.1), rel=1e-9)
    assert reading.position[:2] == pytest.approx((3.0, -4.0))


def test_a_turned_vehicle_at_rest_feels_gravity_along_its_own_axes(tmp_path):
    # held by its fixed mooring: what is felt is gravity alone, in the frame of the vehicle
    for roll, pitch, yaw in ((0.3, 0.0, 0.0), (0.0, 0.4, 1.0), (-0.7, 0.2, 2.5)):
        simulation = ball(
            tmp_path,
            mass=33.510321638,
            water={"density": 1000.0},
            damping=False,
            start={"position": [0.0, 0.0, -2.0], "roll": roll, "pitch": pitch, "yaw": yaw},
        )
        reading = sense(simulation)

        # heading to starboard is the opposite turn of one to port; bow up of bow down
        north_from_vehicle = Rotation.from_euler("ZYX", [-yaw, -pitch, roll])
        felt = north_from_vehicle.inv().apply([0.0, 0.0, -G])
        assert reading.specific_force == pytest.approx(felt, abs=2e-3)
        told = Rotation.from_quat(reading.attitude, scalar_first=True)
        assert (told.inv() * north_from_vehicle).magnitude() == pytest.approx(0.0, abs=1e-6)
        assert reading.position == pytest.approx((0.0, 0.0, 2.0), abs=1e-4)


def test_an_imu_off_the_middle_of_a_spinning_vehicle_feels_the_centripetal_force(tmp_path):
    # in air: the centre falls freely, so that only the spin is felt
    rate, radius = 5.0, 0.15
    simulation = ball(
        tmp_path,
        inside=f'<site name="imu" pos="{radius} 0 0"/>',
        damping=False,
        start={"position": [0.0, 0.0, 50.0], "angular_velocity": [0.0, 0.0, rate]},
    )
    reading = sense(simulation)
    assert reading.gyro == pytest.approx((0.0, 0.0, -rate))
    assert reading.specific_force == pytest.approx((-(rate**2) * radius, 0.0, 0.0), abs=1e-9)

    # the place is that of the site, and so is the velocity: forward, then to port
    angle = rate * simulation.data.time
    assert reading.position[:2] == pytest.approx(
        (radius * np.cos(angle), -radius * np.sin(angle)), rel=1e-6
    )
    assert reading.velocity[:2] == pytest.approx(
        (-rate * radius * np.sin(angle), -rate * radius * np.cos(angle)), rel=1e-6
    )


def test_a_vehicle_that_is_moved_by_hand_tells_north_east_and_down(tmp_path):
    simulation = ball(tmp_path, start={"position": [1.0, 2.0, 53.0]}, water={"level": 50.0})
    data = simulation.data
    data.qvel[:] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]
    simulation.model.opt.gravity[:] = 0.0
    simulation.model.opt.timestep = 1e-9
    reading = sense(simulation)
    assert reading.position == pytest.approx((1.0, -2.0, -3.0), abs=1e-6)
    assert reading.velocity == pytest.approx((0.1, -0.2, -0.3), abs=1e-6)
    assert reading.gyro == pytest.approx((0.4, -0.5, -0.6), abs=1e-6)
    assert reading.attitude == pytest.approx((1.0, 0.0, 0.0, 0.0), abs=1e-6)


def test_the_specific_force_adds_up_to_the_velocity():
    # as an inertial navigation does it: turned to the world, with gravity, step after step
    simulation = simulate(
        start={"position": [0.0, 0.0, -1.0], "roll": 0.5, "velocity": [0.5, 0.2, 0.0]},
        water={"waves": [{"kind": "regular", "amplitude": 0.1, "period": 2.0}]},
        integrator="euler",
    )
    readings = Readings(simulation, simulation.vehicle)
    simulation.step()
    readings.feel()
    last = readings.read()
    first = velocity = np.array(last.velocity)
    attitude = Rotation.from_quat(last.attitude, scalar_first=True)
    for _ in range(200):
        simulation.step()
        readings.feel()
        now = readings.read()
        force = attitude.apply(now.specific_force)
        velocity = velocity + (force + [0.0, 0.0, G]) * (now.time - last.time)
        attitude = Rotation.from_quat(now.attitude, scalar_first=True)
        last = now
    assert np.linalg.norm(velocity - first) > 0.1
    assert velocity == pytest.approx(np.array(last.velocity), abs=5e-3)


def test_range_finders_tell_their_distance_and_far_where_they_meet_nothing(tmp_path):
    simulation = ball(
        tmp_path,
        others='<geom name="ground" type="plane" size="50 50 1" pos="0 0 -10"/>',
        inside='<site name="down" euler="180 0 0"/><site name="up"/>',
        more=(
            '<sensor><rangefinder name="a" site="up"/><rangefinder name="b" site="down"/></sensor>'
        ),
        start={"position": [0.0, 0.0, -4.0]},
    )
    assert sense(simulation).distances == pytest.approx((FAR, 6.0), abs=1e-3)


def test_the_battery_gives_what_the_thrusters_draw(tmp_path):
    simulation = simulate(start={"position": [0.0, 0.0, -5.0]})
    battery = Battery(simulation.model, simulation.vehicle)
    channels = connect(simulation.model, simulation.vehicle, "vectored_6dof")
    pulses = PulseMap(simulation.model, channels)
    currents = []
    for width in (1500, 1900):
        pulses.apply([width] * 16, simulation.data.ctrl)
        for _ in range(100):
            simulation.step()
        drawn = [one.current for one in read_thrusters(simulation.model, simulation.data)]
        voltage, current = battery.read(simulation.data)
        assert current == pytest.approx(sum(drawn))
        currents.append(current)
    assert voltage == 16.0
    assert currents[0] < 1.0

    # the table of a T200 at 16 V says 24 A at full throttle ahead, and less where it gathers way
    assert 0.7 * 24.0 < currents[1] / 8 < 24.5
    bare = ball(tmp_path)
    assert Battery(bare.model, bare.vehicle).read(bare.data) is None


# which thruster each output drives


def test_the_channels_of_a_bluerov2_heavy_are_those_of_ardusub(rov):
    channels = connect(rov.model, rov.vehicle, "vectored_6dof")
    assert [str(channel) for channel in channels] == [
        "1=-horizontal_front_starboard",
        "2=-horizontal_front_port",
        "3=horizontal_back_starboard",
        "4=horizontal_back_port",
        "5=-vertical_front_starboard",
        "6=-vertical_front_port",
        "7=-vertical_back_starboard",
        "8=-vertical_back_port",
    ]
    assert find_idle(rov.model, rov.vehicle, channels) == []


@pytest.mark.parametrize("factor", ["roll", "pitch", "yaw", "throttle", "forward", "lateral"])
def test_what_ardusub_mixes_the_vehicle_does(rov, factor):
    # each factor of the mixer as pulses, and the sum of the thrusters' pushes and turns
    channels = {c.actuator: c for c in connect(rov.model, rov.vehicle, "vectored_6dof")}
    motors = {motor.channel: motor for motor in MOTOR_FRAMES["vectored_6dof"]}
    data = mujoco.MjData(rov.model)
    mujoco.mj_kinematics(rov.model, data)
    push, turn = np.zeros(3), np.zeros(3)
    for thruster in find_thrusters(rov.model, data, rov.vehicle):
        channel = channels[thruster.actuator]
        amount = channel.sign * getattr(motors[channel.number], factor)
        push += amount * thruster.push
        turn += amount * thruster.turn
    done = {
        "forward": push[0], "lateral": push[1], "throttle": -push[2],
        "roll": turn[0], "pitch": turn[1], "yaw": turn[2],
    }  # fmt: skip
    assert done[factor] > 0.1

    # what it pushes it does not turn: those are not what the mixer asks for
    others = {"forward", "lateral", "throttle", "yaw"} - {factor}
    assert all(abs(done[other]) < 1e-9 for other in others)


def test_the_frame_of_six_motors_leaves_two_thrusters_idle(rov):
    channels = connect(rov.model, rov.vehicle, "vectored")
    assert [channel.number for channel in channels] == [1, 2, 3, 4, 5, 6]
    assert "starboard" in channels[4].name
    assert "port" in channels[5].name
    assert len(find_idle(rov.model, rov.vehicle, channels)) == 2


def test_a_boat_has_its_left_thruster_on_output_one_and_its_right_on_three():
    simulation = simulate(vehicle="catamaran")
    channels = connect(simulation.model, simulation.vehicle, "motorboat-skid")
    assert [str(channel) for channel in channels] == ["1=thruster_port", "3=thruster_starboard"]


def test_what_is_stated_holds_and_the_rest_goes_by_geometry(rov):
    swapped = "5=vertical_back_port, 8=-vertical_front_starboard"
    channels = connect(rov.model, rov.vehicle, "vectored_6dof", swapped)
    texts = [str(channel) for channel in channels]
    assert texts[4] == "5=vertical_back_port"
    assert texts[5] == "6=-vertical_front_port"
    assert texts[7] == "8=-vertical_front_starboard"


@pytest.mark.parametrize(
    ("frame", "stated", "message"),
    [
        ("vectered", None, "unknown frame 'vectered'; did you mean 'vectored'? possible: bluerov1"),
        ("custom", None, "the frame 'custom' drives nothing by itself; say what each output"),
        ("custom", "one", "--map says 'one'; write OUTPUT=NAME, or OUTPUT=-NAME"),
        ("custom", "", "--map says ''; write OUTPUT=NAME"),
        ("custom", "0=vertical_back_port", "--map names output 0; there are 1 to 32"),
        ("custom", "33=vertical_back_port", "--map names output 33; there are 1 to 32"),
        ("custom", "1=vertical_back_prt", "--map names no actuator 'vertical_back_prt'; did you"),
        (
            "custom",
            "1=vertical_back_port,1=vertical_front_port",
            "--map names output 1 twice; it drives one actuator",
        ),
        (
            "custom",
            "1=vertical_back_port,2=-vertical_back_port",
            "--map names 'vertical_back_port' twice; one output drives it",
        ),
        (
            "bluerov1",
            None,
            "no thruster does what motor 1 of the frame 'bluerov1' does (yaw -1, forward +1); "
            "choose another frame, or state what it drives (--map 1=NAME); possible: horizontal_b",
        ),
    ],
)
def test_a_map_that_makes_no_sense_is_refused(rov, frame, stated, message):
    with pytest.raises(AutopilotError, match=re.escape(message)):
        connect(rov.model, rov.vehicle, frame, stated)


def test_a_vehicle_without_thrusters_is_refused(tmp_path):
    simulation = ball(tmp_path)
    with pytest.raises(AutopilotError, match=r"has 0 thrusters for them \(none\)"):
        connect(simulation.model, simulation.vehicle, "vectored")


def test_pulses_reach_the_ends_of_each_range(tmp_path):
    simulation = ball(
        tmp_path,
        inside='<site name="a"/>',
        more=(
            '<actuator><motor name="newtons" site="a" gear="0 0 1 0 0 0" ctrlrange="-40 51"/>'
            '<motor name="pulse" site="a" gear="0 0 1 0 0 0" ctrlrange="1100 1900"/>'
            '<motor name="valve" site="a" gear="0 0 1 0 0 0" ctrlrange="0 1"/>'
            '<motor name="free" site="a" gear="0 0 1 0 0 0"/></actuator>'
        ),
    )
    model = simulation.model
    channels = connect(model, simulation.vehicle, "custom", "1=newtons,3=-pulse,2=valve")
    pulses = PulseMap(model, channels)
    ctrl = np.full(4, np.nan)
    for width, expected in (
        (1500, [0.0, 1500.0, 0.5]),
        (0, [0.0, 1500.0, 0.5]),
        (1900, [51.0, 1100.0, 1.0]),
        (1100, [-40.0, 1900.0, 0.0]),
        (1700, [25.5, 1300.0, 0.75]),
        (2200, [51.0, 1100.0, 1.0]),
    ):
        pulses.apply([width] * 16, ctrl)
        assert ctrl[:3] == pytest.approx(expected)
        assert np.isnan(ctrl[3])
    with pytest.raises(AutopilotError, match="actuator 'free' has no ctrlrange, so nobody knows"):
        PulseMap(model, connect(model, simulation.vehicle, "custom", "1=free"))


# the count of frames


def test_frames_are_followed_repeated_lost_and_begun_anew():
    lockstep = Lockstep(0.0025)
    assert lockstep.take(5) is Turn.NEXT
    assert lockstep.take(6) is Turn.NEXT
    assert lockstep.take(6) is Turn.REPEATED
    assert lockstep.take(9) is Turn.NEXT
    assert lockstep.lost == 2
    assert lockstep.repeated == 1
    assert lockstep.take(0) is Turn.RESTARTED


def test_a_timestep_divides_a_frame_or_is_refused():
    assert find_substeps(400, 0.0025) == 1
    assert find_substeps(50, 0.005) == 4
    assert find_substeps(1200, 1.0 / 1200.0) == 1
    assert Lockstep(0.0025, rate=200.0).substeps(1200) == 2
    with pytest.raises(AutopilotError, match=r"asks for 1200 frames in a second, and the timestep"):
        find_substeps(1200, 0.0025)
    with pytest.raises(AutopilotError, match=r"of 0\.01 s does not divide them; give --rate 400"):
        find_substeps(400, 0.01)


@pytest.mark.parametrize(
    ("rate", "timestep", "fitted"),
    [(400, 0.01, 0.0025), (400, 0.0025, 0.0025), (400, 0.002, 0.00125), (30, 0.01, 1 / 120)],
)
def test_a_fitted_timestep_is_the_longest_that_divides(rate, timestep, fitted):
    assert fit_timestep(rate, timestep) == pytest.approx(fitted)
    assert find_substeps(rate, fit_timestep(rate, timestep)) >= 1


# over sockets


def test_each_frame_takes_one_step_of_its_rate_and_is_answered():
    simulation = simulate(start={"position": [0.0, 0.0, -1.0]})

    def talk(peer):
        return [peer.ask(frame, rate=200) for frame in range(20)]

    answers, rest, _ = fly(session_of(simulation), talk)
    assert rest is None
    assert [answer["timestamp"] for answer in answers] == pytest.approx(
        [0.005 * i for i in range(1, 21)]
    )
    assert answers[-1]["position"][2] == pytest.approx(-0.02 - simulation.data.qpos[2], abs=1e-6)


def test_pulses_move_the_vehicle_as_the_autopilot_wants_it():
    # up, with yaw to starboard
    pulses = [1550, 1450, 1450, 1550, 1400, 1400, 1400, 1400] + [0] * 24
    simulation = simulate(start={"position": [0.0, 0.0, -5.0]})
    answers, *_ = fly(
        session_of(simulation), lambda peer: [peer.ask(frame, pulses) for frame in range(400)]
    )
    assert answers[-1]["velocity"][2] < -0.1
    assert answers[-1]["imu"]["gyro"][2] > 0.05
    q = Rotation.from_quat(answers[-1]["quaternion"], scalar_first=True)
    assert q.as_euler("ZYX")[0] > 0.02


def test_a_repeated_frame_gets_the_last_answer_again():
    simulation = simulate(start={"position": [0.0, 0.0, -1.0]})
    session = session_of(simulation)

    def talk(peer):
        first = [peer.ask(0)["timestamp"], peer.raw]
        again = [peer.ask(0)["timestamp"], peer.raw]
        return first, again, peer.ask(3)["timestamp"]

    (first, again, later), _, _ = fly(session, talk)
    assert first == again
    assert later == pytest.approx(2.0 * first[0])
    assert session.lockstep.repeated == 1
    assert session.lockstep.lost == 2
    assert session.frames == 2


def test_of_packets_that_wait_only_the_newest_is_answered():
    simulation = simulate()
    session = session_of(simulation)
    with Link(port=0) as link:
        peer = Peer(link.port)
        for _ in range(4):
            peer.send(0)
        session.fly(link, patience=0.1)
        assert json.loads(peer.socket.recv(65536))["timestamp"] == pytest.approx(0.0025)
        peer.socket.settimeout(0.05)
        with pytest.raises(TimeoutError):
            peer.socket.recv(65536)
        assert link.skipped == 3
    assert session.frames == 1


def test_malformed_packets_are_counted_and_ignored_and_do_not_wake_a_silent_link():
    with Link(port=0) as link:
        peer = Peer(link.port)
        for _ in range(5):
            peer.socket.send(b"not an autopilot")
        assert link.receive(0.05) is None
        assert link.malformed == 5
        peer.socket.send(b"")
        peer.send(4)
        assert link.receive(1.0).frame == 4
        assert link.malformed == 6


def test_a_count_that_falls_back_ends_the_run_and_begins_the_next():
    def talk(peer):
        peer.ask(10)
        peer.ask(11)
        peer.send(0)
        return peer

    peer, rest, _ = fly(session_of(simulate()), talk)
    assert rest.frame == 0
    with Link(port=0) as link:
        link._peer = peer.socket.getsockname()
        session = session_of(simulate())
        session.fly(link, patience=0.01, first=rest)
    assert session.frames == 1


def test_frames_for_recordings_come_at_the_record_rate_and_at_the_end():
    simulation = simulate(record_rate=20.0)
    frames = []
    fly(
        session_of(simulation),
        lambda peer: [peer.ask(i) for i in range(50)],
        add=lambda frame: frames.append(frame.time),
    )
    assert frames == pytest.approx([0.0, 0.05, 0.1, 0.125])


def test_a_session_ends_at_its_duration():
    session = session_of(simulate())
    fly(session, lambda peer: [peer.ask(i) for i in range(4)], duration=0.01, patience=60.0)
    assert session.simulation.data.time == pytest.approx(0.01)
    assert session.summary().simulated_time == pytest.approx(0.01)
    assert session.summary().real_time_factor > 0.0


def test_a_session_watches_every_step():
    session = session_of(simulate(start={"position": [0.0, 0.0, -1.0]}))
    fly(session, lambda peer: [peer.ask(i) for i in range(9)])
    alone = simulate(start={"position": [0.0, 0.0, -1.0]})
    alone.advance(round(session.simulation.data.time / alone.model.opt.timestep))
    assert session.summary().peak_draft == pytest.approx(alone.summary().peak_draft, abs=1e-3)
    assert session.summary().seakeeping.heave.range > 0.0


def test_outputs_beyond_those_that_are_sent_are_refused(rov):
    session = session_of(rov, "custom", "17=vertical_back_port")
    with Link(port=0) as link:
        Peer(link.port).send(0)
        with pytest.raises(AutopilotError, match="output 17 drives an actuator, and the autopilot"):
            session.fly(link, patience=1.0)


def test_a_port_in_use_and_addresses_that_others_reach_are_refused():
    with Link(port=0) as link, pytest.raises(AutopilotError, match="is in use; end what listens"):
        Link(port=link.port)
    with pytest.raises(AutopilotError, match=r"could reach '0\.0\.0\.0' and drive the vehicle"):
        Link("0.0.0.0", 0)
    with Link("0.0.0.0", 0, expose=True) as link:
        assert link.host == "0.0.0.0"
    with pytest.raises(AutopilotError, match=r"port is 70000; it must be a whole number"):
        Link(port=70000)
    with pytest.raises(AutopilotError, match=r"'no\.such\.host\.invalid' is no address"):
        Link("no.such.host.invalid", 0)
    with pytest.raises(AutopilotError, match=r"'192\.0\.2\.1' is no address of this machine"):
        Link("192.0.2.1", 0, expose=True)


# the command line


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def run_sitl(*arguments):
    return CliRunner().invoke(app, ["sitl", *arguments])


def ask_until_answered(peer, frame, **options):
    """Send a packet again and again, as ArduPilot does, until somebody listens."""
    peer.socket.settimeout(0.1)
    while True:
        try:
            answer = peer.ask(frame, **options)
        except (TimeoutError, ConnectionRefusedError):
            continue
        peer.socket.settimeout(60.0)
        return answer


def test_the_command_serves_an_autopilot_that_starts_twice():
    port = free_port()
    answers = []

    def talk():
        peer = Peer(port)
        answers.append(ask_until_answered(peer, 0, rate=1200))
        answers.extend(peer.ask(i, rate=1200) for i in range(1, 30))
        answers.append(ask_until_answered(peer, 0, rate=1200))

    thread = threading.Thread(target=talk)
    thread.start()
    done = run_sitl(
        "bluerov2_heavy_dive", "--rate", "400", "--port", str(port), "--timeout", "2", "--json",
        "--duration", "0.1",
    )  # fmt: skip
    thread.join()
    assert done.exit_code == 0, done.output
    texts = done.stdout.replace("}\n{", "}\0{").split("\0")
    first, second = map(json.loads, texts)
    assert first["autopilot"] == {
        "frames": 30, "asked_rate": 1200, "lost_frames": 0,
        "repeated_packets": first["autopilot"]["repeated_packets"], "malformed_packets": 0,
    }  # fmt: skip
    assert first["simulated_time"] == pytest.approx(30 / 400)
    assert second["autopilot"]["frames"] == 1
    assert answers[-1]["timestamp"] == pytest.approx(1 / 400)
    assert "1=-horizontal_front_starboard" in done.stderr
    assert "the autopilot has started anew, and so does the scene" in done.stderr
    assert "the autopilot has been silent for 2 s" in done.stderr


def test_each_start_of_an_autopilot_has_a_recording_of_its_own():
    assert number_recording(Path("a/run.rrd"), 1) == Path("a/run.rrd")
    assert number_recording(Path("a/run.rrd"), 3) == Path("a/run-3.rrd")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["bluerov2_heavy_dive", "--frame", "quad"], "error: unknown frame 'quad'; possible: "),
        (
            ["bluerov2_heavy_dive", "--timeout", "0.05"],
            "for 0.05 s; start ArduPilot with --model JSON:127.0.0.1, or wait longer (--timeout)",
        ),
        (["bluerov2_heavy_dive", "--rate", "0"], "error: --rate is 0.0; it must be at least 1"),
        (["bluerov2_heavy_dive", "--host", "0.0.0.0"], "allow it (--expose)"),
        (
            ["fleet"],
            "error: the scene has 4 vehicles, and an autopilot drives one; name it (--vehicle); "
            "possible: catamaran, middle, port, starboard",
        ),
        (
            ["bluerov2_heavy_station", "--timeout", "0.05"],
            "note: the scene's [control] of this vehicle rests",
        ),
        (["fleet", "--vehicle", "cat"], "error: the scene has no vehicle 'cat'; possible: "),
        (
            ["auv_waves", "--vehicle", "hourglass"],
            "and vehicle 'hourglass' has 0 thrusters for them (none)",
        ),
    ],
)
def test_what_cannot_be_served_is_one_sentence(arguments, message):
    done = run_sitl(*arguments, "--port", "0")
    assert done.exit_code == 1
    assert message in done.stderr.replace("\n", " ")


def test_one_vehicle_of_a_fleet_is_driven():
    boats = [{"model": "catamaran"}, {"model": "catamaran", "start": {"position": [3.0, 0.0, 0.0]}}]
    simulation = Simulation(scene_from_table({"title": "two boats", "vehicles": boats}))
    vehicle = simulation.vehicles["catamaran_2"]
    channels = connect(simulation.model, vehicle, "motorboat-skid")
    assert [str(channel) for channel in channels] == ["1=thruster_port", "3=thruster_starboard"]
    readings = Readings(simulation, vehicle)
    simulation.step()
    readings.feel()
    assert readings.read().position[0] == pytest.approx(3.0, abs=0.01)


@pytest.mark.slow
def test_ctrl_c_ends_with_a_summary(tmp_path):
    port = free_port()
    process = subprocess.Popen(
        [sys.executable, "-m", "buoyancy_mj", "sitl", "bluerov2_heavy_dive", "--rate", "400",
         "--port", str(port), "--record", str(tmp_path / "run.rrd")],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=os.environ,
    )  # fmt: skip
    ask_until_answered(Peer(port), 0)
    process.send_signal(signal.SIGINT)
    out, errors = process.communicate(timeout=60.0)
    assert process.returncode == 130, errors
    assert "simulated time" in out
    assert "open the recording" in out
    assert (tmp_path / "run.rrd").exists()
