"""One pass of the water by Python, over the same kernels as compiled code: see `kernels.native`."""

import mujoco
import numpy as np

from buoyancy_mj.engine.load_model import LoadModel
from buoyancy_mj.engine.native import Record
from buoyancy_mj.kernels import damping, inertia, panels, wrenches
from buoyancy_mj.kernels.entries.passive import Id, Pressure
from buoyancy_mj.loads.damping_arrays import DampingArrays
from buoyancy_mj.submersion.exact import PackedHulls


def evaluate(
    acting: LoadModel,
    model: mujoco.MjModel,
    data: mujoco.MjData,
    weight: float,
    run: int,
    record: Record,
) -> None:
    """Submersion, then each cause, then their sum, into a record.

    Args:
        acting: the water.
        model: the model.
        data: its data, as mj_forward left them.
        weight: of the water [N/m^3].
        run: a number for whatever the method carries from step to step.
        record: where all that goes.
    """
    record.instant[0] = data.time
    record.results[:] = acting.packed.submerge(data.geom_xpos, data.geom_xmat, data.time, run)
    wrenches.merge(record.results, acting.owners, record.centres)
    buoyancy = record.causes["buoyancy"]
    buoyancy[:] = 0.0
    wrenches.add_buoyancy(record.results, acting.owners, weight, data.xipos, buoyancy)
    record.total[:] = buoyancy
    if acting.has_wave_pressure:
        assert isinstance(acting.packed, PackedHulls)
        pushed, dynamic = record.causes["wave_pressure"], acting.pressure == Pressure.froude_krylov
        pushed[:] = 0.0
        record.heads[:] = acting.packed.press(
            data.geom_xpos, data.geom_xmat, data.time, dynamic=dynamic
        )
        wrenches.add_wave_pressure(
            record.heads,
            record.results,
            acting.owners,
            acting.packed.frames,
            data.geom_xpos,
            weight,
            data.xipos,
            pushed,
        )
        record.total += pushed
    if acting.damping is not None:
        _slow_down(acting, acting.damping, model, data, record)
    if acting.has_added_mass:
        reaction, added = record.causes["added_mass"], acting.added
        reaction[:] = 0.0
        inertia.add_reaction(
            record.centres,
            added.bodies,
            added.volumes,
            added.matrices,
            data.xipos,
            data.xpos,
            data.xmat,
            data.cvel,
            data.subtree_com,
            model.body_rootid,
            model.body_parentid,
            model.body_dofnum,
            model.body_dofadr,
            model.dof_parentid,
            data.cdof_dot,
            data.qvel,
            acting.water.level,
            acting.rows,
            acting.current,
            data.time,
            reaction,
        )
        record.total += reaction


def _slow_down(
    acting: LoadModel,
    slow: DampingArrays,
    model: mujoco.MjModel,
    data: mujoco.MjData,
    record: Record,
) -> None:
    """Drag and the damping by waves made."""
    moving = damping.Moving(
        slow.bodies,
        slow.members,
        slow.member_starts,
        model.body_mass,
        model.body_inertia,
        data.xpos,
        data.xipos,
        data.ximat,
        data.xmat,
        data.cvel,
        data.subtree_com,
        model.body_rootid,
        acting.water.level,
        acting.rows,
        acting.current,
        data.time,
        model.opt.timestep,
    )
    drag = record.causes["drag"]
    drag[:] = 0.0
    damping.add_drag(
        moving,
        record.centres,
        slow.volumes,
        slow.linear,
        slow.quadratic,
        slow.coupled,
        slow.matrices,
        drag,
    )
    if len(slow.panels):
        assert isinstance(acting.packed, PackedHulls)
        places = data.geom_xpos, data.geom_xmat
        panels.add_panels(
            moving,
            *acting.packed.triangles,
            *places,
            record.results,
            acting.owners,
            slow.panels,
            drag,
        )
    record.total += drag
    if slow.radiates:
        made = record.causes["radiation"]
        made[:] = 0.0
        damping.add_radiation(
            moving, record.results, acting.owners, record.centres, slow.radiation, made
        )
        record.total += made


def add_inertia(
    acting: LoadModel, model: mujoco.MjModel, data: mujoco.MjData, record: Record
) -> None:
    """Add the added mass to the engine's mass matrix, once in each pass."""
    added, heavier = acting.added, record.ids[Id.heavier]
    if heavier and np.array_equal(data.M, record.inertia):
        return
    record.ids[Id.heavier] = inertia.add_inertia(
        record.centres,
        added.bodies,
        added.volumes,
        added.matrices,
        data.xpos,
        data.xmat,
        data.subtree_com,
        model.body_rootid,
        model.body_parentid,
        model.body_dofnum,
        model.body_dofadr,
        model.dof_parentid,
        data.cdof,
        model.M_rownnz,
        model.M_rowadr,
        model.M_colind,
        data.M,
    )
    if record.ids[Id.heavier]:
        mujoco.mj_factorM(model, data)
        if model.opt.solver == mujoco.mjtSolver.mjSOL_PGS or model.opt.noslip_iterations > 0:
            mujoco.mj_projectConstraint(model, data)
        record.inertia[:] = data.M
