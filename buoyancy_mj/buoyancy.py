"""`Buoyancy`: water acting on the bodies of one MuJoCo model."""

import contextlib
import threading
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.drag import Drag, estimated
from buoyancy_mj.errors import ModelError
from buoyancy_mj.geoms import displacing_hulls
from buoyancy_mj.kernels import clip, wrenches
from buoyancy_mj.loads import Loads, Portion
from buoyancy_mj.methods import Method, method_of
from buoyancy_mj.water import Water


class Buoyancy:
    """Archimedes' force on every hull of a model, and drag on its bodies, as an `mjcb_control`.

    The force rho g V acts upward at the centroid of each hull's submerged volume. It enters through
    `data.qfrc_passive`, which MuJoCo computes anew before each call, with its own fluid forces; so
    `xfrc_applied` and `qfrc_applied` stay the user's and the viewer's alone, and saved states carry
    no water in them. Force and torque sensors see only `xfrc_applied`; `evaluate(data).xfrc` has
    its layout.

    Gravity is the model's. Without gravity there is no buoyancy.

    Args:
        model: any MuJoCo model with bodies that move.
        water: fresh and still at z = 0 if None.
        geoms: which geoms displace water, see `geoms.displacing_hulls`.
        drag: how damping is estimated; None for none.
        method: how the submersion is found: "exact", or the source paper's "convex_hull" and
            "sections", or one of `Exact`, `ConvexHull`, `Sections` with options.

    Raises:
        ModelError: gravity that is not along -z, actuation disabled (MuJoCo then skips the
            callback), sleep enabled, no geom that displaces water, a body without mass.
        MeshError: a mesh that bounds no volume.
        MethodError: there is no such method.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        water: Water | None = None,
        *,
        geoms: str | Sequence[str] | None = None,
        drag: Drag | None = Drag(),
        method: str | Method = "exact",
    ) -> None:
        self.model = model
        self.water = water or Water()
        self.drag = drag
        self.method = method_of(method)
        _refuse_options(model)
        _ = self.gravity
        self.hulls = displacing_hulls(model, geoms)
        """The hulls, in the order of the model's geoms."""
        self._hull_bodies = np.array([hull.body for hull in self.hulls])
        frames = [hull.geom for hull in self.hulls]
        turns = [hull.body_from_geom for hull in self.hulls]
        self.packed = self.method.packed([hull.mesh for hull in self.hulls], frames, self._hull_bodies, self.water, turns)
        self._damping = estimated(drag, model, self.hulls, self.water.density) if drag else None
        self.bodies = np.array(sorted({hull.body for hull in self.hulls}))
        """Indices of the bodies that have hulls."""
        roots = set(model.body_rootid[self.bodies].tolist())
        self.floating = np.array([body for body in range(model.nbody) if model.body_rootid[body] in roots])
        """Indices of all bodies of the kinematic trees that have hulls: the vehicles."""
        self._rows, self._current = self.water.rows, np.array(self.water.current)
        # what a step writes to
        self._centres = np.zeros((model.nbody, 4))
        self._causes = {cause: np.zeros((model.nbody, 6)) for cause in ("buoyancy", *(["drag"] if drag else []))}
        self._sum = np.zeros((model.nbody, 6))
        self._targets = [(int(body), self._sum[body, :3], self._sum[body, 3:]) for body in self.bodies]
        self._before, self._after = np.zeros((2, model.nv))
        self._last_data = 0
        # one set of arrays: threads that share this object take turns
        self._lock = threading.RLock()

    def __call__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Add the water's forces to `data.qfrc_passive`: an `mjcb_control`, or a call between mj_step1 and mj_step2.

        Another model than the own one is left alone. A second call in the same pass replaces the first.
        """
        if model._address != self.model._address:
            return
        with self._lock:
            self._apply(data)

    def _apply(self, data: mujoco.MjData) -> None:
        """Compute the loads and add them to `data.qfrc_passive`."""
        self._compute(data, data._address)
        passive = data.qfrc_passive
        # finite differences call the callback again without computing qfrc_passive anew
        if data._address == self._last_data and np.array_equal(passive, self._after):
            passive[:] = self._before
        self._before[:] = passive
        for body, force, torque in self._targets:
            mujoco.mj_applyFT(self.model, data, force, torque, data.xipos[body], body, passive)
        self._after[:] = passive
        self._last_data = data._address

    @contextlib.contextmanager
    def installed(self) -> Iterator["Buoyancy"]:
        """Lend itself to MuJoCo as `mjcb_control`; the callback that was there still runs, and comes back at the end.

        Raises:
            ModelError: actuation has been disabled: MuJoCo would skip the callback.
        """
        _refuse_options(self.model)
        previous = mujoco.get_mjcb_control()
        chained = _callable(previous)

        def control(model: mujoco.MjModel, data: mujoco.MjData) -> None:
            if chained is not None:
                chained(model, data)
            self(model, data)

        mujoco.set_mjcb_control(self if chained is None else control)
        try:
            yield self
        finally:
            mujoco.set_mjcb_control(previous)

    def evaluate(self, data: mujoco.MjData) -> Loads:
        """The loads at the poses and velocities that `data` holds, as mj_forward left them; writes nothing."""
        with self._lock:
            # as a run of its own, so that what the callback carries from step to step stays untouched
            self._compute(data, -data._address)
            wet, centres, rows = self.packed.results.copy(), self._centres.copy(), self._sum.copy()
            causes = {cause: wrench.copy() for cause, wrench in self._causes.items()}
        xipos = data.xipos
        force = np.zeros((len(self.hulls), 3))
        force[:, 2] = self.water.density * self.gravity * wet[:, clip.VOLUME]
        arm = np.where(force[:, 2:] > 0.0, wet[:, clip.CENTROID] - xipos[self._hull_bodies], 0.0)
        hull = Portion(wet[:, clip.VOLUME], wet[:, clip.CENTROID], force, np.cross(arm, force))
        body = Portion(centres[:, 0], centres[:, 1:], rows[:, :3], rows[:, 3:])
        everything = np.empty((1, 4))
        wrenches.merge(wet, np.zeros(len(wet), np.int64), everything)
        torque = body.torque + np.cross(xipos - self.centre_of_mass(data), body.force)
        total = Portion(everything[0, 0], everything[0, 1:], body.force.sum(axis=0), torque.sum(axis=0))
        return Loads(
            names=tuple(hull.name for hull in self.hulls),
            hull=hull,
            body=body,
            total=total,
            wetted_area=wet[:, clip.WETTED_AREA],
            waterplane_area=wet[:, clip.WATERPLANE_AREA],
            by_cause=causes,
        )

    @property
    def causes(self) -> tuple[str, ...]:
        """Names of the loads that act."""
        return tuple(self._causes)

    def centre_of_mass(self, data: mujoco.MjData) -> NDArray[np.float64]:
        """Centre of mass (3,) [m] of the floating bodies, world frame."""
        masses = self.model.body_mass[self.floating]
        return masses @ data.xipos[self.floating] / masses.sum()

    def _compute(self, data: mujoco.MjData, run: int) -> None:
        """Submersion, then each cause, then their sum, into the arrays made at construction."""
        weight = self.water.density * self.gravity
        wet = self.packed.submerge(data.geom_xpos, data.geom_xmat, data.time, run)
        wrenches.merge(wet, self._hull_bodies, self._centres)
        buoyancy = self._causes["buoyancy"]
        buoyancy[:] = 0.0
        wrenches.add_buoyancy(wet, self._hull_bodies, weight, data.xipos, buoyancy)
        self._sum[:] = buoyancy
        if self._damping is not None:
            drag, damping = self._causes["drag"], self._damping
            drag[:] = 0.0
            wrenches.add_drag(
                self._centres,
                damping.bodies,
                damping.volumes,
                damping.linear,
                damping.quadratic,
                damping.masses,
                damping.inertias,
                data.xipos,
                data.xmat,
                data.cvel,
                data.subtree_com,
                self.model.body_rootid,
                self.water.level,
                self._rows,
                self._current,
                data.time,
                self.model.opt.timestep,
                drag,
            )
            self._sum += drag

    @property
    def gravity(self) -> float:
        """Downward acceleration [m/s^2] of the model; 0 where its flags disable gravity.

        Raises:
            ModelError: it is not along -z.
        """
        x, y, z = self.model.opt.gravity
        if self.model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_GRAVITY:
            return 0.0
        if x != 0.0 or y != 0.0 or z > 0.0:
            raise ModelError(f"gravity is {x:g} {y:g} {z:g}; water needs it along -z: set <option gravity='0 0 -9.81'/>")
        return -float(z)


def _refuse_options(model: mujoco.MjModel) -> None:
    """Refuse options under which everything would sink, or stay where it is, without a word."""
    if model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_ACTUATION:
        raise ModelError(
            "this model disables actuation, and MuJoCo then skips the control callback through which water acts: "
            "remove <flag actuation='disable'/>, and disable single actuators by <option actuatorgroupdisable> instead"
        )
    if model.opt.enableflags & mujoco.mjtEnableBit.mjENBL_SLEEP:
        raise ModelError(
            "this model lets bodies at rest sleep, and MuJoCo does not wake them for water that moves: "
            "remove <flag sleep='enable'/>"
        )


def _callable(callback: Any) -> Callable[[mujoco.MjModel, mujoco.MjData], None] | None:
    """A callback as get_mjcb_control gives it, a Python function or a ctypes one, to be called from Python."""
    if hasattr(callback, "argtypes"):
        return lambda model, data: callback(model._address, data._address)
    return callback
