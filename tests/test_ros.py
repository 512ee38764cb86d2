"""Runs as messages of ROS 2, read back by the tools that others read them with."""

import builtins
import json
import math

import numpy as np
import pytest
from mcap.reader import make_reader
from rosbags.typesys import Stores, get_typestore
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner
from websockets.sync.client import connect

from buoyancy_mj import RecordingError, Simulation
from buoyancy_mj.cli import app
from buoyancy_mj.files import GrowingFile
from buoyancy_mj.scenes.scene import scene_from_table
from buoyancy_mj.viz.ros import messages as ros
from buoyancy_mj.viz.ros.names import topic
from buoyancy_mj.viz.ros.stream import RosStream

STORE = get_typestore(Stores.ROS2_JAZZY)
XML = """
<mujoco>
  <worldbody>
    <geom name="ground" type="plane" size="9 9 1" pos="0 0 -4"/>
    <body name="buoy">
      <freejoint/>
      <geom name="hull" type="sphere" size="0.3" mass="40"/>
      <site name="imu" pos="0.1 0 0" euler="0 0 90"/>
      <site name="lonely"/>
      <site name="down" euler="180 0 0"/>
      <site name="up" pos="0.2 0 0"/>
      <body name="arm" pos="0 0 0.3">
        <joint name="hinge" axis="0 1 0" damping="1"/>
        <geom name="rod" type="capsule" size="0.02 0.1" mass="0.1"/>
      </body>
    </body>
  </worldbody>
  <sensor>
    <accelerometer name="accelerometer" site="imu"/>
    <gyro name="gyro" site="imu"/>
    <framequat name="attitude" objtype="site" objname="imu"/>
    <accelerometer name="other" site="lonely"/>
    <magnetometer name="compass" site="lonely"/>
    <rangefinder name="sounder" site="down"/>
    <rangefinder name="sky" site="up"/>
    <framepos name="place" objtype="site" objname="imu"/>
    <jointpos name="angle 1" joint="hinge"/>
    <clock name="clock"/>
    <contact name="touch" geom1="hull" geom2="ground"/>
  </sensor>
</mujoco>
"""
WAVES = {"waves": [{"kind": "regular", "amplitude": 0.1, "period": 2.0}]}


def simulate(tmp_path, **keys):
    (tmp_path / "buoy.xml").write_text(XML)
    table = {
        "title": "a buoy", "vehicle": str(tmp_path / "buoy.xml"), "duration": 0.3,
        "record_rate": 50.0, "water": WAVES,
        "start": {"position": [0.0, 0.0, -0.5], "yaw": 0.5, "velocity": [1.0, 0.0, 0.0]},
    }  # fmt: skip
    return Simulation(scene_from_table(table | keys))


def read(path):
    """Messages by topic, each with its time [s]; and the types and metadata of the file."""
    messages, types = {}, {}
    with path.open("rb") as file:
        reader = make_reader(file)
        assert reader.get_header().profile == "ros2"
        for schema, channel, message in reader.iter_messages():
            assert (schema.encoding, channel.message_encoding) == ("ros2msg", "cdr")
            assert schema.data.decode() == STORE.generate_msgdef(schema.name, ros_version=2)[0]
            types[channel.topic] = schema.name
            told = STORE.deserialize_cdr(message.data, schema.name)
            messages.setdefault(channel.topic, []).append((message.log_time / 1e9, told))
        metadata = {record.name: record.metadata for record in reader.iter_metadata()}
    return messages, types, metadata


@pytest.fixture(scope="module")
def told(tmp_path_factory):
    folder = tmp_path_factory.mktemp("ros")
    simulation = simulate(folder)
    stream = RosStream(simulation, folder / "run.mcap")
    frames = []
    for frame in simulation.frames():
        stream.add(frame)
        data = frame.data
        frames.append(
            {
                "time": frame.time, "xpos": data.xpos.copy(), "xquat": data.xquat.copy(),
                "xipos": data.xipos.copy(), "sensordata": data.sensordata.copy(),
                "qvel": data.qvel.copy(), "qpos": data.qpos.copy(),
                "loads": {k: v.copy() for k, v in frame.loads.by_cause.items()},
            }
        )  # fmt: skip
    path = stream.close(simulation.summary())
    assert path == folder / "run.mcap"
    return simulation, frames, *read(path)


def numbers(message):
    """The fields of a vector, a point or a quaternion of ROS."""
    return [getattr(message, axis) for axis in "xyzw" if hasattr(message, axis)]


def test_topics_have_the_types_of_ros_2(told):
    types = told[3]
    assert types == {
        "/clock": "rosgraph_msgs/msg/Clock",
        "/tf": "tf2_msgs/msg/TFMessage",
        "/tf_static": "tf2_msgs/msg/TFMessage",
        "/meshes": "visualization_msgs/msg/MarkerArray",
        "/sea": "visualization_msgs/msg/Marker",
        "/buoy/pose": "geometry_msgs/msg/PoseStamped",
        "/buoy/odom": "nav_msgs/msg/Odometry",
        "/buoy/joint_states": "sensor_msgs/msg/JointState",
        "/buoy/loads/buoyancy": "geometry_msgs/msg/WrenchStamped",
        "/buoy/loads/drag": "geometry_msgs/msg/WrenchStamped",
        "/buoy/sensors/imu": "sensor_msgs/msg/Imu",
        "/buoy/sensors/other": "geometry_msgs/msg/Vector3Stamped",
        "/buoy/sensors/compass": "sensor_msgs/msg/MagneticField",
        "/buoy/sensors/sounder": "sensor_msgs/msg/Range",
        "/buoy/sensors/sky": "sensor_msgs/msg/Range",
        "/buoy/sensors/place": "geometry_msgs/msg/PointStamped",
        "/buoy/sensors/angle_1": "std_msgs/msg/Float64",
        "/sensors/clock": "std_msgs/msg/Float64",
        "/buoy/sensors/touch": "std_msgs/msg/Float64",
    }


def test_each_frame_is_told_at_its_time(told):
    _, frames, messages, *_ = told
    times = [frame["time"] for frame in frames]
    for name in ("/tf", "/buoy/odom", "/buoy/sensors/imu"):
        assert [time for time, _ in messages[name]] == pytest.approx(times)
    last = messages["/buoy/odom"][-1][1].header.stamp
    assert last.sec + 1e-9 * last.nanosec == pytest.approx(times[-1])

    # what is large comes less often
    assert len(messages["/meshes"]) == len(messages["/tf_static"]) == 1
    assert len(messages["/sea"]) == 4


def test_transforms_are_the_poses_of_the_bodies(told):
    simulation, frames, messages, *_ = told
    for frame, (_, message) in zip(frames, messages["/tf"], strict=True):
        for one in message.transforms:
            body = simulation.model.body(one.child_frame_id).id
            x, y, z, w = numbers(one.transform.rotation)
            assert one.header.frame_id == "world"
            assert numbers(one.transform.translation) == pytest.approx(frame["xpos"][body])
            assert [w, x, y, z] == pytest.approx(frame["xquat"][body])
        assert [one.child_frame_id for one in message.transforms] == ["buoy", "arm"]
    sites = {one.child_frame_id: one for one in messages["/tf_static"][0][1].transforms}
    assert numbers(sites["buoy/imu"].transform.translation) == pytest.approx([0.1, 0.0, 0.0])
    assert sites["buoy/imu"].header.frame_id == "buoy"


def test_odometry_has_velocities_in_the_axes_of_the_body(told):
    _, frames, messages, *_ = told
    frame, message = frames[-1], messages["/buoy/odom"][-1][1]
    turned = Rotation.from_quat(frame["qpos"][3:7], scalar_first=True)
    velocity = turned.inv().apply(frame["qvel"][:3])
    assert message.child_frame_id == "buoy"
    assert numbers(message.twist.twist.linear) == pytest.approx(velocity)
    assert numbers(message.twist.twist.angular) == pytest.approx(frame["qvel"][3:6])


def test_loads_are_about_the_origin_of_the_vehicle_in_its_axes(told):
    simulation, frames, messages, *_ = told
    bodies = simulation.vehicle.bodies
    for frame, (_, message) in zip(frames, messages["/buoy/loads/drag"], strict=True):
        rows = frame["loads"]["drag"][bodies]
        turned = Rotation.from_quat(frame["xquat"][bodies[0]], scalar_first=True).inv()
        arms = frame["xipos"][bodies] - frame["xpos"][bodies[0]]
        torque = rows[:, 3:].sum(axis=0) + np.cross(arms, rows[:, :3]).sum(axis=0)
        assert message.header.frame_id == "buoy"
        assert numbers(message.wrench.force) == pytest.approx(
            turned.apply(rows[:, :3].sum(axis=0)), abs=1e-9
        )
        assert numbers(message.wrench.torque) == pytest.approx(turned.apply(torque), abs=1e-9)
    assert any(np.abs(frame["loads"]["drag"]).max() > 1.0 for frame in frames)


def test_an_accelerometer_a_gyro_and_an_attitude_at_one_site_are_an_imu(told):
    simulation, frames, messages, *_ = told
    sensors = {simulation.model.sensor(i).name: i for i in range(simulation.model.nsensor)}
    frame, (_, message) = frames[-1], messages["/buoy/sensors/imu"][-1]

    def part(name, count):
        first = simulation.model.sensor_adr[sensors[name]]
        return frame["sensordata"][first : first + count]

    w, x, y, z = part("attitude", 4)
    assert message.header.frame_id == "buoy/imu"
    assert numbers(message.linear_acceleration) == pytest.approx(part("accelerometer", 3))
    assert numbers(message.angular_velocity) == pytest.approx(part("gyro", 3))
    assert numbers(message.orientation) == pytest.approx([x, y, z, w])
    assert message.orientation_covariance[0] == 0.0


def test_range_finders_that_meet_nothing_are_infinite(told):
    _, frames, messages, *_ = told
    depth = 4.0 + frames[0]["xpos"][1][2]
    assert messages["/buoy/sensors/sounder"][0][1].range == pytest.approx(depth, abs=1e-6)
    assert messages["/buoy/sensors/sky"][0][1].range == math.inf


def test_the_sea_lies_on_the_surface_around_the_vehicle(told):
    simulation, _, messages, *_ = told
    time, sea = messages["/sea"][-1]
    corners = np.array([numbers(point) for point in sea.points])
    assert corners[:, 2] == pytest.approx(
        simulation.buoyancy.water.elevation(corners[:, 0], corners[:, 1], time)
    )
    assert np.ptp(corners[:, 2]) > 0.01
    assert abs(corners[:, :2].mean(axis=0)).max() < 1.0

    # triangles that face upwards and fill the square
    a, b, c = corners.reshape(-1, 3, 3).transpose(1, 0, 2)
    areas = 0.5 * np.cross(b - a, c - a)[:, 2]
    assert (areas > 0.0).all()
    assert areas.sum() == pytest.approx(np.ptp(corners[:, 0]) * np.ptp(corners[:, 1]))


def test_meshes_lie_in_the_frames_of_their_bodies(told):
    markers = {marker.ns: marker for marker in told[2]["/meshes"][0][1].markers}
    names = [told[0].model.geom(int(ns)).name for ns in markers]
    assert sorted(names) == ["ground", "hull", "rod"]
    hull = markers[str(told[0].model.geom("hull").id)]
    radii = np.linalg.norm([numbers(point) for point in hull.points], axis=1)
    assert hull.header.frame_id == "buoy"
    assert hull.frame_locked
    assert radii == pytest.approx(np.full(len(radii), 0.3), rel=0.05)
    assert markers[str(told[0].model.geom("ground").id)].header.frame_id == "world"


def test_the_summary_is_kept_in_the_file(told):
    assert told[4]["summary"]["scene"] == "a buoy"
    assert float(told[4]["summary"]["mass"]) == pytest.approx(40.1)


def test_an_imu_without_an_attitude_says_so_and_topics_are_never_two_things(tmp_path):
    xml = XML.replace('<framequat name="attitude" objtype="site" objname="imu"/>', "")
    (tmp_path / "buoy.xml").write_text(xml.replace('name="compass"', 'name="imu"'))
    table = {"title": "t", "vehicle": str(tmp_path / "buoy.xml"), "duration": 0.01}
    simulation = Simulation(scene_from_table(table))
    stream = RosStream(simulation, tmp_path / "run.mcap")
    for frame in simulation.frames():
        stream.add(frame)
    messages, types, _ = read(stream.close())
    assert messages["/buoy/sensors/imu"][0][1].orientation_covariance[0] == -1.0
    assert types["/buoy/sensors/imu_2"] == "sensor_msgs/msg/MagneticField"


@pytest.mark.parametrize(
    ("parts", "name"),
    [
        (("auv", "sensors", "depth"), "/auv/sensors/depth"),
        (("", "a/b c", "ü-1"), "/a/b_c/__1"),
        (("2nd",), "/_2nd"),
    ],
)
def test_topics_are_of_the_letters_that_ros_allows(parts, name):
    assert topic(*parts) == name


def test_times_keep_their_nanoseconds():
    one = ros.stamp(12.345678901)
    assert (one.sec, one.nanosec) == (12, 345678901)
    assert ros.stamp(0.9999999999).sec == 1


def test_a_run_that_breaks_off_keeps_its_file_and_replaces_none(tmp_path):
    simulation = simulate(tmp_path)
    for expected in ("run.mcap", "run.partial.mcap"):
        stream = RosStream(simulation, tmp_path / "run.mcap")
        stream.add(simulation.frame())
        assert stream.close(complete=False) == tmp_path / expected
        assert len(read(tmp_path / expected)[0]["/tf"]) == 1


def test_a_full_disk_ends_the_file_with_one_sentence(tmp_path, monkeypatch):
    simulation = simulate(tmp_path)
    stream = RosStream(simulation, tmp_path / "run.mcap")

    def refuse(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(GrowingFile, "append", refuse)
    with pytest.raises(RecordingError, match=r"the MCAP file broke off: No space left on device"):
        stream.add(simulation.frame())
    assert stream.closed


@pytest.mark.parametrize(
    ("name", "message"),
    [("folder.mcap", "it is a folder"), ("file/run.mcap", r"choose another place \(--mcap\)")],
)
def test_a_file_that_cannot_be_written_is_refused(tmp_path, name, message):
    simulation = simulate(tmp_path)
    (tmp_path / "folder.mcap").mkdir()
    (tmp_path / "file").write_text("")
    with pytest.raises(RecordingError, match=message):
        RosStream(simulation, tmp_path / name)


def test_a_viewer_is_served_and_gets_the_meshes_whenever_it_comes(tmp_path):
    simulation = simulate(tmp_path)
    stream = RosStream(simulation, port=0, waits=True)
    frames = simulation.frames()
    stream.add(next(frames))
    with connect(f"ws://127.0.0.1:{stream.port}", subprotocols=["foxglove.sdk.v1"]) as viewer:
        # topics are advertised, and asked for
        channels = {}
        while "/sea" not in channels:
            text = viewer.recv(timeout=30.0)
            if isinstance(text, str) and json.loads(text)["op"] == "advertise":
                channels |= {one["topic"]: one for one in json.loads(text)["channels"]}
        assert channels["/buoy/odom"]["schemaName"] == "nav_msgs/msg/Odometry"
        assert channels["/buoy/odom"]["schemaEncoding"] == "ros2msg"
        asked = [("/buoy/odom", 1), ("/meshes", 2)]
        subscriptions = [{"id": i, "channelId": channels[name]["id"]} for name, i in asked]
        viewer.send(json.dumps({"op": "subscribe", "subscriptions": subscriptions}))

        # the run goes on with it, and the meshes, which were told long ago, are told again
        stream.add(next(frames))
        assert stream.has_viewer
        seen = {}
        while set(seen) != {1, 2}:
            piece = viewer.recv(timeout=30.0)
            if isinstance(piece, bytes) and piece[0] == 1:
                seen[int.from_bytes(piece[1:5], "little")] = piece[13:]
    odometry = STORE.deserialize_cdr(seen[1], "nav_msgs/msg/Odometry")
    assert odometry.pose.pose.position.x == pytest.approx(simulation.data.qpos[0])
    meshes = STORE.deserialize_cdr(seen[2], "visualization_msgs/msg/MarkerArray")
    assert len(meshes.markers) == 3

    # another server cannot have the same port
    with pytest.raises(RecordingError, match=r"end what listens there, or take another \(--foxglo"):
        RosStream(simulation, tmp_path / "run.mcap", port=stream.port)
    assert not list(tmp_path.glob("*.mcap"))
    stream.close()


def test_the_command_writes_a_file_for_ros(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(
        app,
        ["run", "bluerov2_heavy_dive", "--duration", "0.1", "--no-record", "--mcap", "a.mcap"],
    )
    assert done.exit_code == 0, done.output
    assert "the messages of ROS 2 are in 'a.mcap'" in done.stdout
    _, types, _ = read(tmp_path / "a.mcap")
    assert types["/bluerov2_heavy/sensors/imu"] == "sensor_msgs/msg/Imu"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--mcap", "a.bag"], "error: --mcap is 'a.bag'; the file's name ends in .mcap"),
        (["--foxglove-port", "9"], "error: --foxglove-port is given without --foxglove; give both"),
        (["--foxglove", "--foxglove-port", "70000"], "error: --foxglove-port is 70000; it must be"),
    ],
)
def test_flags_that_make_no_sense_are_refused(arguments, message):
    done = CliRunner().invoke(app, ["run", "bluerov2_heavy_dive", *arguments])
    assert done.exit_code == 1
    assert message in done.stderr


def test_what_is_not_installed_is_named(monkeypatch, tmp_path):
    real = builtins.__import__

    def refuse(name, *arguments, **named):
        if name == "buoyancy_mj.viz.ros.stream":
            raise ModuleNotFoundError("No module named 'foxglove'", name="foxglove")
        return real(name, *arguments, **named)

    monkeypatch.setattr(builtins, "__import__", refuse)
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(
        app, ["run", "bluerov2_heavy_dive", "--duration", "0.1", "--mcap", "a.mcap"]
    )
    assert done.exit_code == 1
    assert (
        "error: --mcap and --foxglove need foxglove, which is not installed: "
        "pip install 'buoyancy_mj[foxglove]'" in done.stderr.replace("\n", " ")
    )


def test_the_numbers_of_a_quaternion_change_their_order():
    told = ros.quaternion(np.array([0.5, 0.1, 0.2, 0.3]))
    assert numbers(told) == [0.1, 0.2, 0.3, 0.5]
