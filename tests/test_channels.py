"""Names and units of what sensors read and actuators do."""

import mujoco
import numpy as np
import pytest

from buoyancy_mj import Tank, add_ballast
from buoyancy_mj.vehicle.instruments import channels
from buoyancy_mj.vehicle.instruments.channels import describe_sensor
from buoyancy_mj.vehicle.instruments.engine_sensors import Component
from buoyancy_mj.vehicle.instruments.instruments import Instruments
from buoyancy_mj.vehicle.sensors.kinds import CHANNELS

MODEL = """<mujoco><extension><plugin plugin="mujoco.sensor.touch_grid"/></extension>
<worldbody><geom name="floor" type="plane" size="1 1 1"/><site name="eye" pos="0 0 1"/>
<camera name="eye" pos="0 0 2" resolution="2 1"/>
<body name="a" pos="0 0 .1"><joint name="hinge" axis="0 1 0" limited="true" range="-1 1"/>
  <geom name="a" size=".1"/><site name="pad" size=".1"/>
  <body name="b" pos=".5 0 0"><joint name="slide" type="slide"/><geom name="b" size=".1"/>
    <site name="tip"/></body></body>
<body name="c" pos="3 0 0"><joint name="ball" type="ball"/><geom name="c" size=".1"/></body>
</worldbody>
<tendon><spatial name="rope"><site site="eye"/><site site="tip"/></spatial>
<fixed name="sum"><joint joint="hinge" coef="1"/></fixed></tendon>
<actuator><motor name="turn" joint="hinge"/><motor name="push" joint="slide"/>
<general name="thrust" site="tip" gear="0 0 1 0 0 .1" dyntype="filter" dynprm="1"/>
<motor name="wheel" site="tip" gear="0 0 0 0 0 1"/><motor name="winch" tendon="rope"/></actuator>
<sensor>
<accelerometer name="accelerometer" site="tip"/><gyro name="gyro" site="tip"/>
<force name="force" site="tip"/><torque name="torque" site="tip"/><touch name="touch" site="pad"/>
<magnetometer name="north" site="tip"/><framequat name="attitude" objtype="site" objname="tip"/>
<jointpos name="angle" joint="hinge"/><jointvel name="rate" joint="slide"/>
<jointactuatorfrc name="effort" joint="hinge"/><ballquat name="turned" joint="ball"/>
<tendonpos name="paid" tendon="rope"/><tendonvel name="turning" tendon="sum"/>
<actuatorfrc name="pull" actuator="winch"/><actuatorpos name="moved" actuator="turn"/>
<rangefinder name="range" site="eye"/><rangefinder name="rays" camera="eye" data="dist point"/>
<contact name="touching" geom1="a" geom2="floor" data="found force" num="2"/>
<fromto name="gap" geom1="a" geom2="b" cutoff="1"/><clock/><user name="own" dim="2"/>
<plugin name="grid" plugin="mujoco.sensor.touch_grid" objtype="site" objname="pad">
<config key="size" value="1 2"/><config key="fov" value="45 45"/><config key="gamma" value="0"/>
<config key="nchannel" value="1"/></plugin>
</sensor></mujoco>"""
XYZ = ("x", "y", "z")


def along(name, unit):
    return {f"{name}.{axis}": unit for axis in XYZ}


EXPECTED = (
    along("accelerometer", "m/s^2")
    | along("gyro", "rad/s")
    | along("force", "N")
    | along("torque", "N m")
    | {"touch": "N"}
    | along("north", "T")
    | {f"attitude.{axis}": "" for axis in "wxyz"}
    | {"angle": "rad", "rate": "m/s", "effort": "N m"}
    | {f"turned.{axis}": "" for axis in "wxyz"}
    | {"paid": "m", "turning": "rad/s", "pull": "N", "moved": "rad", "range": "m"}
    | {"rays.distance_1": "m", **{f"rays.point_{axis}_1": "m" for axis in XYZ}}
    | {"rays.distance_2": "m", **{f"rays.point_{axis}_2": "m" for axis in XYZ}}
    | {"touching.found_1": "", **{f"touching.force_{axis}_1": "N" for axis in XYZ}}
    | {"touching.found_2": "", **{f"touching.force_{axis}_2": "N" for axis in XYZ}}
    | {f"gap.{end}_{axis}": "m" for end in ("from", "to") for axis in XYZ}
    | {"sensor 19": "s", "own.1": "", "own.2": "", "grid.1": "", "grid.2": ""}
    | {f"{name}.control": "" for name in ("turn", "push", "thrust", "wheel", "winch")}
    | {"turn.force": "N m", "push.force": "N", "thrust.force": "N"}
    | {"wheel.force": "N m", "winch.force": "N", "thrust.activation": ""}
)
"""Each number of the model, in its order, and its unit."""


@pytest.fixture(scope="module")
def model():
    return mujoco.MjModel.from_xml_string(MODEL)


def test_each_number_has_its_name_and_unit_in_the_order_of_the_model(model):
    found = [(channel.name, channel.unit) for channel in Instruments(model).channels]
    assert found == list(EXPECTED.items())


def test_numbers_are_read_where_the_engine_has_them(model):
    data = mujoco.MjData(model)
    data.qpos[0], data.qvel[1] = 0.3, 0.2
    data.ctrl[:] = 1.0, 2.0, 3.0, 4.0, 5.0
    data.act[:] = 6.0
    mujoco.mj_forward(model, data)
    instruments = Instruments(model)
    numbers = instruments.read(data)
    values = {one.name: value for one, value in zip(instruments.channels, numbers, strict=True)}
    for name in ("gyro", "touching", "rays", "gap", "own", "grid"):
        own = [value for key, value in values.items() if key.split(".")[0] == name]
        assert np.array_equal(own, data.sensor(name).data), name
    assert values["angle"] == 0.3
    assert values["rate"] == 0.2
    assert values["winch.control"] == 5.0
    assert values["pull"] == values["winch.force"] == data.actuator("winch").force
    assert values["thrust.activation"] == 6.0


def test_ballast_is_commanded_and_kept_in_cubic_metres():
    spec = mujoco.MjSpec()
    body = spec.worldbody.add_body(name="hull")
    body.add_freejoint()
    body.add_geom(name="tank", size=[0.1, 0, 0])
    add_ballast(spec, "tank", Tank(rate=1e-3))
    units = {channel.name: channel.unit for channel in Instruments(spec.compile()).channels}
    assert units == {"tank.control": "m^3", "tank.force": "N", "tank.activation": "m^3"}


def test_a_model_without_instruments_has_no_channels():
    model = mujoco.MjModel.from_xml_string("<mujoco/>")
    instruments = Instruments(model)
    assert instruments.channels == ()
    assert instruments.read(mujoco.MjData(model)).shape == (0,)


def test_a_sensor_of_a_plugin_is_described_by_the_name_of_its_plugin(model, monkeypatch):
    grid = model.sensor("grid").id
    assert describe_sensor(model, grid) == [("1", ""), ("2", "")]
    known = (Component("bow", "Pa"), Component("stern", "Pa"))
    monkeypatch.setattr(channels, "CHANNELS", {"mujoco.sensor.touch_grid": known})
    assert describe_sensor(model, grid) == [("bow", "Pa"), ("stern", "Pa")]
    # a table that is too short for the sensor says nothing of it
    monkeypatch.setattr(channels, "CHANNELS", {"mujoco.sensor.touch_grid": known[:1]})
    assert describe_sensor(model, grid) == [("1", ""), ("2", "")]


@pytest.mark.parametrize("plugin", CHANNELS)
def test_the_numbers_of_our_sensors_differ_in_name(plugin):
    names = [name for name, _ in CHANNELS[plugin]]
    assert len(set(names)) == len(names)
    assert ("" in names) == (len(names) == 1)
