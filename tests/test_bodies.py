"""Which bodies can move, and which float together."""

import mujoco
import pytest

from buoyancy_mj.hulls.bodies import find_moving_bodies, group_floating_bodies

BODIES = """
<body name="pier"><geom size="0.1"/>
  <body name="crane"><joint/><geom size="0.1"/></body>
</body>
<body name="target" mocap="true"><geom size="0.1"/>
  <body name="flag"><geom size="0.1"/></body>
  <body name="spring"><joint type="slide"/><geom size="0.1"/></body>
</body>
<body name="boat"><freejoint/><geom size="0.1"/><site name="hook"/>
  <body name="mast"><geom size="0.1"/></body>
  <body name="rudder"><joint/><geom size="0.1"/></body>
</body>
<body name="raft"><freejoint/><geom size="0.1"/><site name="ring"/></body>
"""


def compile_model(equalities: str = "") -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_string(
        f"<mujoco><worldbody>{BODIES}</worldbody><equality>{equalities}</equality></mujoco>"
    )


def names(model: mujoco.MjModel, bodies) -> list[str]:
    return [model.body(body).name for body in bodies]


def test_bodies_with_a_joint_below_them_move_and_static_and_mocap_bodies_do_not():
    model = compile_model()
    moving = find_moving_bodies(model)
    assert names(model, moving.nonzero()[0]) == [
        "crane", "spring", "boat", "mast", "rudder", "raft",
    ]  # fmt: skip


def test_each_kinematic_tree_floats_by_itself():
    model = compile_model()
    assert [names(model, group) for group in group_floating_bodies(model)] == [
        ["crane"], ["spring"], ["boat", "mast", "rudder"], ["raft"],
    ]  # fmt: skip


@pytest.mark.parametrize(
    "joined",
    [
        '<weld body1="boat" body2="raft"/>',
        '<weld body1="raft" body2="rudder"/>',
        '<connect body1="boat" body2="raft" anchor="0 0 0"/>',
        '<weld site1="hook" site2="ring"/>',
        '<connect site1="ring" site2="hook"/>',
    ],
)
def test_trees_that_a_weld_or_a_connect_joins_float_together(joined: str):
    model = compile_model(joined)
    assert names(model, group_floating_bodies(model)[-1]) == ["boat", "mast", "rudder", "raft"]


@pytest.mark.parametrize(
    "apart",
    [
        '<weld body1="boat" body2="raft" active="false"/>',
        '<weld body1="boat"/><weld body1="raft"/>',
        '<weld body1="boat" body2="pier"/><weld body1="raft" body2="pier"/>',
        '<connect body1="boat" body2="target" anchor="0 0 0"/>',
    ],
)
def test_inactive_constraints_and_those_to_what_cannot_move_join_nothing(apart: str):
    assert len(group_floating_bodies(compile_model(apart))) == 4


def test_a_model_in_which_nothing_moves_has_no_groups():
    model = mujoco.MjModel.from_xml_string(
        "<mujoco><worldbody><geom size='1'/></worldbody></mujoco>"
    )
    assert group_floating_bodies(model) == ()
