"""`Buoyancy`: water acting on the bodies of one MuJoCo model."""

import contextlib
import functools
import math
import threading
import warnings
from collections.abc import Iterator, Mapping, Sequence

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.engine import callbacks, passes
from buoyancy_mj.engine.compiled import CompiledWater
from buoyancy_mj.engine.load_model import build_load_model
from buoyancy_mj.errors import BuoyancyWarning, EngineError, MethodError, ModelError, choices
from buoyancy_mj.hulls.geoms import find_hulls
from buoyancy_mj.hulls.hull import Hull
from buoyancy_mj.hulls.selection import body_name
from buoyancy_mj.kernels import clip, wrenches
from buoyancy_mj.kernels.multibody import downward_gravity
from buoyancy_mj.kernels.passes import Record
from buoyancy_mj.kernels.sea import PressureModel
from buoyancy_mj.loads.added_mass import resolve_added_mass
from buoyancy_mj.loads.drag import Drag, resolve_damping
from buoyancy_mj.loads.loads import Loads, Portion
from buoyancy_mj.sea.water import Water
from buoyancy_mj.submersion.exact import Exact
from buoyancy_mj.submersion.methods import Method, parse_method


class Buoyancy:
    """Archimedes' force on every hull of a model, and drag on its bodies, as a callback of MuJoCo.

    The force rho g V acts upward at the centroid of each hull's submerged volume. It enters through
    `data.qfrc_passive`, which MuJoCo computes anew before each call, with its own fluid forces; so
    `xfrc_applied` and `qfrc_applied` stay the user's and the viewer's alone, and saved states carry
    no water in them. Force and torque sensors see only `xfrc_applied`; `evaluate(data).xfrc` has
    its layout.

    Gravity is the model's. Without gravity there is no buoyancy.

    Args:
        model: any MuJoCo model with bodies that move.
        water: fresh and still at z = 0 if None.
        geoms: which geoms displace water, see `hulls.find_hulls`.
        hull: which of them as their convex hull, likewise.
        fill: and which flood, and displace in part, likewise.
        bodies: indices of the bodies whose geoms may; None for all.
        pressure: what the pressure in waves is taken for: "archimedes" for rho g V upward, as in the
            source paper; "hydrostatic" for that of the depth under the surface, which pushes along the
            slope too; "froude-krylov" for that of linear waves, which fades with depth. See `kernels.waves.head`.
        drag: how damping is estimated; None for none.
        added_mass: "model" for what the model's `<custom>` states, numerics 'added_mass:BODY' with 6 or 36
            numbers; "estimate" for that, and an estimate where there is none; "none"; or matrices (6, 6) or
            diagonals (6,) by the name of the body. See `added_mass`.
        method: how the submersion is found: "exact", or the source paper's "convex_hull" and
            "sections", or one of `Exact`, `ConvexHull`, `Sections` with options.

    Raises:
        ModelError: gravity that is not along -z, actuation disabled (MuJoCo then skips an
            `mjcb_control`), sleep enabled, no geom that displaces water, a body without mass.
        MeshError: a mesh that bounds no volume.
        MethodError: there is no such method or pressure, or that method knows no pressure.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        water: Water | None = None,
        *,
        geoms: str | Sequence[str] | None = None,
        hull: str | Sequence[str] | None = None,
        fill: str | Sequence[str] | None = None,
        bodies: Sequence[int] | None = None,
        pressure: str = "archimedes",
        drag: Drag | None = Drag(),
        added_mass: str | Mapping[str, ArrayLike] | None = "model",
        method: str | Method = "exact",
    ) -> None:
        self.model = model
        self.water = water or Water()
        self.drag = drag
        self.method = parse_method(method)
        self.pressure = parse_pressure(pressure, self.method)
        callbacks.refuse_actuation(model)
        _refuse_sleep(model)
        _ = self.gravity
        self.hulls = find_hulls(model, geoms, bodies, hull=hull, fill=fill)
        """The hulls, in the order of the model's geoms."""
        self._owners = np.array([hull.body for hull in self.hulls])
        frames = [hull.geom for hull in self.hulls]
        turns = [hull.body_from_geom for hull in self.hulls]
        self.packed = self.method.pack(
            [hull.mesh for hull in self.hulls],
            frames,
            self._owners,
            self.water,
            turns,
            [hull.fill for hull in self.hulls],
        )
        _doubt(model, self.water, self.hulls)
        self.added_mass = resolve_added_mass(model, self.hulls, self.water.density, added_mass)
        """Added mass of those bodies that have one."""
        damping = resolve_damping(drag, model, self.hulls, self.water.density) if drag else None
        if damping is not None and len(damping.panels) and not isinstance(self.method, Exact):
            raise MethodError(
                f"drag by panels needs the method 'exact', not '{self.method.name}', which knows no triangles"
            )
        self._load_model = build_load_model(
            self.water, self.packed, self._owners, self.pressure, damping, self.added_mass
        )
        self.causes = self._load_model.causes
        """Names of the loads that act."""
        self.bodies = np.unique(self._owners)
        """Indices of the bodies that have hulls."""
        roots = set(model.body_rootid[self.bodies].tolist())
        self.floating = np.array(
            [body for body in range(model.nbody) if model.body_rootid[body] in roots]
        )
        """Indices of all bodies of the kinematic trees that have hulls: the vehicles."""
        # what a step writes to; threads that share this object take turns
        self._looked, self._record = self.record(), self.record()
        self._before, self._after = np.zeros((2, model.nv))
        self._last_data = 0
        self._lock = threading.RLock()

    def __call__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Add the water's forces to `data.qfrc_passive`: an `mjcb_control`, or a call between mj_step1 and mj_step2.

        Another model than the own one is left alone, and so are all while the water is `installed`.
        A second call in the same pass replaces the first.
        """
        if model._address == self.model._address and not callbacks.is_lent(self):
            self.act(data)

    @contextlib.contextmanager
    def installed(
        self, native: bool | None = None, *, copies: bool = False
    ) -> Iterator["Buoyancy"]:
        """Lend itself to MuJoCo; the callback that was there still runs, and comes back at the end.

        It is lent as `mjcb_passive`, which MuJoCo calls once in each pass, in `mj_inverse` and for
        finite differences too; or, since MuJoCo skips that one where a model disables springs and
        dampers, as `mjcb_control`. Installed again while it acts, it changes nothing.

        Args:
            native: as a compiled C function, which needs no Python and takes no lock, so that threads
                step side by side and `mujoco.batch` accepts it. None does so where it can be: not
                beside a callback in Python, and not as `mjcb_control`.
            copies: act on other models of the same compilation signature too, as `mujoco.batch` makes
                of its model; compiled only.

        Raises:
            ModelError: actuation has been disabled.
            EngineError: `native` or `copies` is asked for and cannot be; the message says why.
        """
        with callbacks.lend(self, native, copies=copies):
            yield self

    def act(self, data: mujoco.MjData) -> None:
        """Add the forces to `data.qfrc_passive`, once in each pass."""
        with self._lock:
            record = self._record
            self._evaluate(data, data._address, record)
            passive = data.qfrc_passive
            # finite differences call a control callback again without computing qfrc_passive anew
            if data._address == self._last_data and np.array_equal(passive, self._after):
                passive[:] = self._before
            self._before[:] = passive
            passes.apply(self._load_model, self.model, data, record)
            self._after[:] = passive
            self._last_data = data._address
            if "compiled" in self.__dict__:
                self.compiled.forget(data._address)

    def evaluate(self, data: mujoco.MjData) -> Loads:
        """The loads at the poses and velocities that `data` holds, as mj_forward left them; writes nothing."""
        with self._lock:
            # as a run of its own, so that what the callback carries from step to step stays untouched
            self._evaluate(data, -data._address, self._looked)
            return self.loads_of(self._looked, data)

    def loads(self, data: mujoco.MjData) -> Loads:
        """The loads that acted in the last pass of a step or of mj_forward over `data`, with the poses of that pass.

        Raises:
            EngineError: none acted on these data so far, or many others were stepped since.
        """
        with self._lock:
            record = (
                self.compiled.last_record(data._address) if "compiled" in self.__dict__ else None
            )
            if record is None and self._last_data == data._address:
                record = self._record
            # a pass lies no more than a step back; what is older was of other data in the same place
            if (
                record is None
                or not abs(data.time - record.instant[0]) <= 1.001 * self.model.opt.timestep
            ):
                raise EngineError(
                    f"this water has not acted on these data at their time, {data.time:g} s; step them while it acts, "
                    "call mj_forward, or use evaluate"
                )
            return self.loads_of(record, data)

    def loads_of(self, record: Record, data: mujoco.MjData) -> Loads:
        """What a record holds, as copies; its `data` still hold the poses."""
        wet, centres, rows = record.wet.copy(), record.centres.copy(), record.total.copy()
        xipos = data.xipos
        weight = self.water.density * self.gravity
        if self._load_model.has_wave_pressure:
            force, about = weight * record.heads[:, :3], weight * record.heads[:, 3:]
            origins = data.geom_xpos[[hull.geom for hull in self.hulls]]
            torque = about + np.cross(origins - xipos[self._owners], force)
        else:
            force = np.zeros((len(self.hulls), 3))
            force[:, 2] = weight * wet[:, clip.VOLUME]
            arm = np.where(force[:, 2:] > 0.0, wet[:, clip.CENTROID] - xipos[self._owners], 0.0)
            torque = np.cross(arm, force)
        hull = Portion(wet[:, clip.VOLUME], wet[:, clip.CENTROID], force, torque)
        body = Portion(centres[:, 0], centres[:, 1:], rows[:, :3], rows[:, 3:])
        everything = np.empty((1, 4))
        wrenches.merge(wet, np.zeros(len(wet), np.int64), everything)
        torque = body.torque + np.cross(xipos - self.centre_of_mass(data), body.force)
        total = Portion(
            everything[0, 0], everything[0, 1:], body.force.sum(axis=0), torque.sum(axis=0)
        )
        return Loads(
            names=tuple(hull.name for hull in self.hulls),
            hull=hull,
            body=body,
            total=total,
            wetted_area=wet[:, clip.WETTED_AREA],
            waterplane_area=wet[:, clip.WATERPLANE_AREA],
            by_cause={cause: getattr(record.causes, cause).copy() for cause in self.causes},
        )

    def record(self) -> Record:
        """Room for what one evaluation leaves."""
        return self._load_model.record(self.model.nbody, self.model.nC)

    @functools.cached_property
    def compiled(self) -> CompiledWater:
        """What compiled code needs of this water.

        Raises:
            EngineError: this MuJoCo is not as expected inside.
        """
        return CompiledWater(self.model, self._load_model, self._lock)

    def centre_of_mass(self, data: mujoco.MjData) -> NDArray[np.float64]:
        """Centre of mass (3,) [m] of the floating bodies, world frame."""
        masses = self.model.body_mass[self.floating]
        return masses @ data.xipos[self.floating] / masses.sum()

    def _evaluate(self, data: mujoco.MjData, run: int, record: Record) -> None:
        passes.evaluate(self._load_model, self.model, data, self.gravity, run, record)

    @property
    def gravity(self) -> float:
        """Downward acceleration [m/s^2] of the model; 0 where its flags disable gravity.

        Raises:
            ModelError: it is not along -z.
        """
        option = self.model.opt
        gravity = float(downward_gravity(option.gravity, option.disableflags))
        if math.isnan(gravity):
            x, y, z = option.gravity
            raise ModelError(
                f"gravity is {x:g} {y:g} {z:g}; water needs it along -z: "
                "set <option gravity='0 0 -9.81'/>"
            )
        return gravity


def parse_pressure(name: str, method: Method) -> PressureModel:
    """The kind of pressure of a name.

    Raises:
        MethodError: there is none, or the method knows no pressure.
    """
    kinds = {kind.name.replace("_", "-"): kind for kind in PressureModel}
    if name not in kinds:
        raise MethodError(f"pressure is '{name}'; {choices(name, kinds)}")
    if kinds[name] != PressureModel.archimedes and not isinstance(method, Exact):
        raise MethodError(
            f"pressure '{name}' needs the method 'exact', not '{method.name}', which knows volumes alone"
        )
    return kinds[name]


def _doubt(model: mujoco.MjModel, water: Water, hulls: Sequence[Hull]) -> None:
    """Tell of waves that break, and refuse water in which what floats would be aground."""
    for doubt in water.doubts:
        warnings.warn(f"the water has {doubt}", BuoyancyWarning, stacklevel=3)
    shallowest = float(np.min(water.rows[:, 5], initial=np.inf))
    for body in {hull.body for hull in hulls}:
        root = int(model.body_rootid[body])
        if math.isinf(shallowest) or model.body_dofnum[root] != 6:
            continue
        together = [hull for hull in hulls if model.body_rootid[hull.body] == root]
        # what it must displace, over no more than half the area of its hulls: Cauchy
        volume = min(
            float(model.body_subtreemass[root]) / water.density,
            sum(hull.displaced_volume for hull in together),
        )
        least = volume / (0.5 * sum(hull.mesh.area for hull in together))
        if least > shallowest:
            raise ModelError(
                f"the waves run in water {shallowest:g} m deep, and body '{body_name(model, body)}' has a draft of at least "
                f"{least:.3g} m in any attitude; make the waves' depth greater"
            )


def _refuse_sleep(model: mujoco.MjModel) -> None:
    """Refuse bodies that would stay where they are while the water moves."""
    if model.opt.enableflags & mujoco.mjtEnableBit.mjENBL_SLEEP:
        raise ModelError(
            "this model lets bodies at rest sleep, and MuJoCo does not wake them for water that moves: "
            "remove <flag sleep='enable'/>"
        )
