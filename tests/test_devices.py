"""Plugins of the vehicle: they find the water that acts, wherever MuJoCo steps."""

import gc
import pickle

import mujoco
import numpy as np
import pytest
from mujoco import rollout

from buoyancy_mj import Buoyancy, RegularWave, Water, add_water

WATER = Water(waves=RegularWave(0.05, period=2.0))
STATE = mujoco.mjtState.mjSTATE_FULLPHYSICS
BUOY = """
<mujoco>
  <option timestep="0.005"/>
  <extension><plugin plugin="buoyancy_mj.depth"/></extension>
  <worldbody>
    <body name="buoy" pos="0 0 0.1">
      <freejoint/>
      <geom type="box" size="0.2 0.15 0.1" density="500"/>
      <site name="keel" pos="0.1 0 -0.1"/>
    </body>
  </worldbody>
  <sensor>
    <plugin name="depth" plugin="buoyancy_mj.depth" objtype="site" objname="keel"/>
    <framepos name="keel" objtype="site" objname="keel"/>
  </sensor>
</mujoco>
"""


@pytest.fixture(scope="module")
def model():
    """The buoy with its own water."""
    spec = mujoco.MjSpec.from_string(BUOY)
    add_water(spec, WATER)
    return spec.compile()


def run(model, steps=60):
    """Data after some steps, read out at their end."""
    data = mujoco.MjData(model)
    for _ in range(steps):
        mujoco.mj_step(model, data)
    mujoco.mj_forward(model, data)
    return data


def test_depth_is_that_of_the_place_under_the_surface_of_the_instant(model):
    data = run(model)
    x, y, z = data.sensor("keel").data
    assert data.sensor("depth").data[0] == pytest.approx(
        WATER.elevation(x, y, data.time) - z, abs=1e-12
    )


@pytest.mark.parametrize("native", [True, False])
def test_water_that_is_installed_is_found_and_reads_the_same(model, native):
    bare = mujoco.MjModel.from_xml_string(BUOY)
    with Buoyancy(bare, WATER).installed(native=native):
        data = run(bare)
    assert np.allclose(data.sensordata, run(model).sensordata, rtol=0.0, atol=1e-12)


def test_after_the_block_there_is_no_water():
    bare = mujoco.MjModel.from_xml_string(BUOY)
    with Buoyancy(bare, WATER).installed():
        data = run(bare, 3)
        assert data.sensor("depth").data[0] > 0.0
    mujoco.mj_forward(bare, data)
    assert data.sensor("depth").data[0] == -np.inf


def test_water_that_is_called_between_the_halves_of_a_step_is_found_from_the_second_step_on():
    bare = mujoco.MjModel.from_xml_string(BUOY)
    buoyancy, data = Buoyancy(bare, WATER), mujoco.MjData(bare)
    for _ in range(2):
        mujoco.mj_step1(bare, data)
        buoyancy(bare, data)
        mujoco.mj_step2(bare, data)
    assert np.isfinite(data.sensor("depth").data[0])


def test_rollouts_and_batches_read_the_same(model):
    start, data = np.empty(mujoco.mj_stateSize(model, STATE)), mujoco.MjData(model)
    mujoco.mj_getState(model, data, start, STATE)
    for _ in range(40):
        mujoco.mj_step(model, data)
    datas = [mujoco.MjData(model) for _ in range(2)]
    _, read = rollout.rollout(model, datas, np.tile(start, (4, 1)), nstep=40)
    assert (read[:, -1] == data.sensordata).all()


def test_saved_mjcf_keeps_water_and_devices(model):
    spec = mujoco.MjSpec.from_string(BUOY)
    add_water(spec, WATER)
    spec.compile()
    read = mujoco.MjModel.from_xml_string(spec.to_xml())
    assert (run(read).sensordata == run(model).sensordata).all()


def test_pickled_models_and_data_read_on(model):
    data = run(model, 5)
    again = pickle.loads(pickle.dumps(data))
    for one in (data, again):
        mujoco.mj_step(one.model, one)
    assert (again.sensordata == data.sensordata).all()


def test_devices_of_an_attached_model_are_read_under_their_prefix():
    parent = mujoco.MjSpec()
    child = mujoco.MjSpec.from_string(BUOY)
    add_water(child, WATER)
    child.option.timestep = parent.option.timestep
    parent.attach(child, prefix="rov/", frame=parent.worldbody.add_frame(pos=[0, 0, -1]))
    data = run(parent.compile(), 1)
    assert data.sensor("rov/depth").data[0] == pytest.approx(1.05, abs=0.01)


def test_water_that_was_called_is_there_no_more_when_it_is_gone():
    model = mujoco.MjModel.from_xml_string(BUOY)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    water = Buoyancy(model, Water())
    water(model, data)
    mujoco.mj_forward(model, data)
    assert np.isfinite(data.sensor("depth").data[0])
    del water
    gc.collect()
    mujoco.mj_forward(model, data)
    assert data.sensor("depth").data[0] == -np.inf
