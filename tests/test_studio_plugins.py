"""Studio's two sides of a scene, without a window between them."""

import sys

import mujoco
import numpy as np
import pytest

from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.scene import read_scene

pytest.importorskip("mujoco.studio.app", reason="mujoco-studio is not installed")

from mujoco.studio import launch_thread, messages, sim, step_control, viewer_handle

from buoyancy_mj.studio.basin import Basin
from buoyancy_mj.studio.basin_plugin import BasinPlugin
from buoyancy_mj.studio.letters import (
    AfloatEvent,
    DropEvent,
    LaunchEvent,
    ReadoutSnapshot,
    RefusalEvent,
    RestEvent,
    SeaSnapshot,
    VerdictEvent,
    WaterEvent,
)
from buoyancy_mj.studio.sea_state import SeaState

BOX = """<mujoco><worldbody><body name="box" pos="0 0 0.3"><freejoint/>
<geom type="box" size="0.5 0.3 0.2" mass="72"/></body></worldbody></mujoco>"""


class Session:
    """The simulation's side of a window that is not there."""

    def __init__(self, basin=None, path=None):
        self.viewer, endpoint = launch_thread.make_thread_endpoints()
        self.control = step_control.StepControl()
        self.plugin = BasinPlugin(basin, path, self.control, skin=False)
        self.handle = viewer_handle.ViewerHandle(endpoint, sim_plugins=[self.control, self.plugin])
        self.handle.dispatch(messages.LoadModelEvent())

    def tell(self, letter):
        self.viewer.send_to_sim(letter)
        self.handle.sync()

    def hear(self, kind):
        """The last letter of a kind that the window got."""
        letters = [*self.viewer.get_sim_events(), *self.viewer.get_sim_snapshots()]
        found = [letter for letter in letters if isinstance(letter, kind)]
        return found[-1] if found else None

    def run(self, seconds):
        end = self.handle.data.time + seconds
        while self.handle.data.time < end:
            self.handle.sync()


@pytest.fixture
def session():
    return Session(Basin(read_scene(catalog.scene_path("hourglass_drop_still"))))


def test_the_window_gets_a_model_without_plugins_and_the_water_that_acts(session):
    letters = session.viewer.get_sim_events()
    (model,) = [one.model for one in letters if isinstance(one, messages.ModelEvent)]
    assert model.nplugin == 0
    (afloat,) = [one for one in letters if isinstance(one, AfloatEvent)]
    assert afloat.title == session.plugin._basin.scene.title
    (water,) = [one.water for one in letters if isinstance(one, WaterEvent)]
    assert water is session.plugin._basin.water


def test_the_scene_runs_and_tells_what_there_is_to_see(session):
    session.run(0.3)
    readout = session.hear(ReadoutSnapshot).readout
    assert 0.0 < readout.time <= session.handle.data.time
    ((_, one),) = readout.vehicles.items()
    assert one.root == 1


def test_a_sea_that_the_window_asks_for_acts_from_the_next_step_on(session):
    sea = SeaState(spectrum="regular", height=0.4, period=3.0, level=0.1)
    session.tell(SeaSnapshot(sea))
    water = session.hear(WaterEvent).water
    assert water is session.plugin._basin.buoyancy.water
    assert water.level == 0.1
    assert water.rows[0, 0] == pytest.approx(0.2)


def test_a_sea_that_cannot_be_is_refused_in_one_sentence(session):
    before = session.plugin._basin.water
    session.viewer.get_sim_events()
    session.tell(SeaSnapshot(SeaState(spectrum="regular", height=3.0, period=0.8)))
    letters = session.viewer.get_sim_events()
    (refusal,) = [one.sentence for one in letters if isinstance(one, RefusalEvent)]
    assert "higher than long" in refusal
    # which would take the sentence from the panel
    assert not any(isinstance(one, WaterEvent) for one in letters)
    assert session.plugin._basin.water is before


def test_buttons_move_the_vehicle_that_the_window_shows(session):
    (name,) = session.plugin._basin.vehicles
    session.control.step_control.set_pause_state(sim.PauseState.NORMAL_PAUSED)
    session.tell(DropEvent(name, 2.0))
    assert session.plugin._basin.frame().draft == pytest.approx(-2.0)
    assert session.handle.data.qpos == pytest.approx(session.plugin._basin.data.qpos)
    session.tell(RestEvent(name))
    assert session.plugin._basin.frame().draft > 0.0


def test_a_paused_scene_stands_still_and_a_reset_leads_to_its_start(session):
    start = session.handle.data.qpos.copy()
    session.run(0.1)
    session.control.step_control.set_pause_state(sim.PauseState.NORMAL_PAUSED)
    session.handle.sync()
    now = session.handle.data.time
    session.handle.sync()
    assert session.handle.data.time == now
    session.tell(messages.ResetEvent())
    assert session.handle.data.time == 0.0
    assert np.array_equal(session.handle.data.qpos, start)


def test_a_run_that_diverges_stops_at_its_start_with_the_reason(session):
    start = session.plugin._basin.data.qpos.copy()
    data = session.handle.data
    data.qvel[0] = 1e6
    session.plugin._twin.give(session.plugin._basin)
    for _ in range(200):
        session.handle.sync()
        refusal = session.hear(RefusalEvent)
        if refusal is not None:
            break
    assert "the simulation diverged" in refusal.sentence
    assert session.control.step_control.get_pause_state() == sim.PauseState.NORMAL_PAUSED
    assert np.array_equal(session.plugin._basin.data.qpos, start)


def test_a_pose_that_the_window_sets_is_the_scenes(session):
    session.control.step_control.set_pause_state(sim.PauseState.NORMAL_PAUSED)
    data = mujoco.MjData(session.handle.model)
    data.qpos[:] = session.handle.data.qpos
    data.qpos[2] = 4.0
    where = int(mujoco.mjtState.mjSTATE_QPOS)
    session.tell(messages.StateEvent.from_data(session.handle.model, data, where))
    assert session.plugin._basin.data.qpos[2] == 4.0


def test_a_dry_model_is_judged_stands_still_and_floats_when_it_is_put_into_water(tmp_path):
    path = tmp_path / "box.xml"
    path.write_text(BOX)
    session = Session(path=path)
    verdict = session.hear(VerdictEvent)
    assert verdict.can_float
    assert verdict.lines[0].startswith("box: floats: 168 kg reserve")
    session.handle.sync()
    assert session.handle.data.time == 0.0
    session.tell(LaunchEvent())
    assert session.hear(AfloatEvent).title == "box"
    session.run(0.1)
    assert session.handle.data.qpos[2] < 0.3


def test_a_file_that_is_no_model_is_refused_and_the_scene_goes_on(session, tmp_path):
    path = tmp_path / "bad.xml"
    path.write_text("<mujoco><nonsense/></mujoco>")
    model = session.handle.model
    session.tell(messages.LoadModelEvent(path=str(path)))
    assert "bad.xml" in session.hear(RefusalEvent).sentence
    assert session.handle.model is model
    session.run(0.02)


def test_a_model_in_which_nothing_can_float_is_refused_and_the_scene_goes_on(session, tmp_path):
    path = tmp_path / "still.xml"
    path.write_text("<mujoco><worldbody><geom type='box' size='1 1 1'/></worldbody></mujoco>")
    before = session.handle.model
    session.tell(messages.LoadModelEvent(path=str(path)))
    assert session.hear(RefusalEvent).sentence
    assert session.handle.model is before
    time = session.handle.data.time
    session.run(0.05)
    assert session.handle.data.time > time


def test_studio_is_loaded_in_this_python():
    from buoyancy_mj.studio.library import load_studio

    load_studio()
    assert "mujoco.studio.native_viewer" in sys.modules
