"""`Buoyancy`: the water that acts on the bodies of one MuJoCo model."""

import contextlib
import functools
import threading
from collections.abc import Iterator, Sequence
from typing import Unpack

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.engine import callbacks, passes
from buoyancy_mj.engine.checks import (
    check_actuation,
    check_sleep,
    check_waves,
    warn_of_no_volume,
)
from buoyancy_mj.engine.compiled import CompiledWater
from buoyancy_mj.engine.load_model import build_load_model
from buoyancy_mj.errors import EngineError
from buoyancy_mj.hulls.bodies import group_floating_bodies
from buoyancy_mj.hulls.geoms import find_hulls
from buoyancy_mj.hulls.gravity import read_gravity
from buoyancy_mj.kernels import clip, wrenches
from buoyancy_mj.kernels.passes import Record
from buoyancy_mj.kernels.sea import PressureModel
from buoyancy_mj.loads.added_mass import resolve_added_mass
from buoyancy_mj.loads.damping_arrays import resolve_damping
from buoyancy_mj.loads.loads import Loads, Portion
from buoyancy_mj.records import ReadOnly
from buoyancy_mj.sea.water import Water
from buoyancy_mj.settings.settings import Options, Settings, combine_settings
from buoyancy_mj.submersion.hull_set import HullSet


class Buoyancy(ReadOnly):
    """Archimedes' force on every hull of a model, and drag on its bodies, as a callback of MuJoCo.

    The force rho g V acts upward at the centroid of each hull's submerged volume. It enters through
    `data.qfrc_passive`, which MuJoCo computes anew before each call, with its own fluid forces. So
    `xfrc_applied` and `qfrc_applied` stay the user's and the viewer's alone, and saved states carry
    no water in them. Force and torque sensors see only `xfrc_applied`; `evaluate(data).xfrc` has
    its layout.

    Gravity is the model's. Without gravity there is no buoyancy.

    Args:
        model: any MuJoCo model with bodies that move.
        water: the sea, fresh and still at z = 0 if None; or `Settings`, which hold it and all
            options.
        bodies: indices of the bodies whose geoms may displace; None for all.
        options: any of the other fields of `Settings`: method, pressure, damping, added_mass,
            selection.

    Raises:
        ModelError: gravity that is not along -z, actuation disabled (MuJoCo then skips an
            `mjcb_control`), sleep enabled, no geom that displaces water, a body without mass.
        MeshError: a mesh that bounds no volume.
        MethodError: there is no such method or pressure, or that method knows no pressure.

    Example:
        >>> buoyancy = Buoyancy(model, Water(waves=RegularWave(0.3, period=4.0)))
        >>> with buoyancy.installed():
        ...     mujoco.mj_step(model, data)
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        water: Water | Settings | None = None,
        *,
        bodies: Sequence[int] | None = None,
        **options: Unpack[Options],
    ) -> None:
        self.model = model
        """The model."""
        self.settings = combine_settings(water, options)
        """All options."""
        self.water = self.settings.water
        """The sea."""

        # what water asks of a model
        check_actuation(model)
        check_sleep(model)
        read_gravity(model)

        # the hulls
        self.hulls = find_hulls(model, self.settings.selection, bodies)
        """The hulls, in the order of the model's geoms."""
        self._owners = np.array([hull.body for hull in self.hulls])
        hulls = HullSet(
            [hull.mesh for hull in self.hulls],
            frames=[hull.geom for hull in self.hulls],
            bodies=self._owners,
            turns=[hull.body_from_geom for hull in self.hulls],
            fills=[hull.fill for hull in self.hulls],
        )
        self.packed = self.settings.method.pack(hulls, self.water)
        """The hulls as the method keeps them, ready to be submerged again and again."""
        check_waves(model, self.water, self.hulls)
        warn_of_no_volume(model)

        # the loads
        self.added_mass = resolve_added_mass(
            model, self.hulls, self.water.density, self.settings.added_mass
        )
        """Added mass of those bodies that have one."""
        damping = self.settings.damping
        self._load_model = build_load_model(
            self.water,
            self.packed,
            self._owners,
            PressureModel[self.settings.pressure.replace("-", "_")],
            resolve_damping(damping, model, self.hulls, self.water.density) if damping else None,
            self.added_mass,
        )
        self.causes = self._load_model.causes
        """Names of the loads that act."""

        # the bodies
        self.bodies = np.unique(self._owners)
        """Indices of the bodies that have hulls."""
        groups = group_floating_bodies(model)
        afloat = [group for group in groups if np.isin(group, self.bodies).any()]
        self.floating = np.sort(np.concatenate(afloat))
        """Indices of all bodies that float, and of those that they carry: the vehicles."""

        # what a step writes to; threads that share this object take turns
        self._looked = self.record()
        self._record = self.record()
        self._before = np.zeros(model.nv)
        self._after = np.zeros(model.nv)
        self._last_data = 0
        self._lock = threading.RLock()
        self._seal("make another Buoyancy(model, water, ...)", Buoyancy)

    def __call__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Add the water's forces to `data.qfrc_passive`, unless the water is `installed`.

        It has the signature of an `mjcb_control`, and may be called between mj_step1 and mj_step2.
        Data of other models are left alone. A second call in the same pass replaces the first.
        """
        if model._address == self.model._address and not callbacks.is_installed(self):
            self.act(data)

    @contextlib.contextmanager
    def installed(
        self, native: bool | None = None, *, copies: bool = False
    ) -> Iterator["Buoyancy"]:
        """Install the water as a callback of MuJoCo for the length of a `with` block.

        The callback that was there still runs, and is put back at the end. The water becomes
        `mjcb_passive`, which MuJoCo calls once in each pass, in `mj_inverse` and for finite
        differences too. Where a model disables springs and dampers, MuJoCo skips that callback, and
        the water becomes `mjcb_control`. A second `installed` inside the block changes nothing.

        Args:
            native: whether to install a compiled C function. It needs no Python and takes no lock,
                so that threads step side by side and `mujoco.batch` accepts it. None does so where
                it is possible: not beside a callback in Python, and not as `mjcb_control`.
            copies: whether to act on other models of the same compilation signature too, such as
                `mujoco.batch` makes of its model; compiled only.

        Raises:
            ModelError: the model disables actuation, or brings its own water.
            EngineError: `native` or `copies` is asked for and cannot be; the message says why.
        """
        with callbacks.install(self, native, copies=copies):
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
        """The loads at the poses and velocities of `data`, as mj_forward left them; writes nothing.

        Args:
            data: of this model.
        """
        with self._lock:
            # as a separate run, so that what the callback carries between steps stays untouched
            self._evaluate(data, -data._address, self._looked)
            return self.loads_of(self._looked, data)

    def loads(self, data: mujoco.MjData) -> Loads:
        """The loads that acted in the last pass over `data`, at the poses of that pass.

        A pass is part of a step, or of mj_forward.

        Raises:
            EngineError: none acted on these data so far, or many others were stepped since.
        """
        with self._lock:
            record = (
                self.compiled.last_record(data._address) if "compiled" in self.__dict__ else None
            )
            if record is None and self._last_data == data._address:
                record = self._record
            # a pass lies no more than a step back; an older one was of other data at the address
            if (
                record is None
                or not abs(data.time - record.instant[0]) <= 1.001 * self.model.opt.timestep
            ):
                raise EngineError(
                    f"this water has not acted on these data at their time, {data.time:g} s; "
                    "step them while it acts, call mj_forward, or use evaluate"
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
        centre: NDArray[np.float64] = masses @ data.xipos[self.floating] / masses.sum()
        return centre

    def _evaluate(self, data: mujoco.MjData, run: int, record: Record) -> None:
        passes.evaluate(self._load_model, self.model, data, self.gravity, run, record)

    @property
    def gravity(self) -> float:
        """Downward acceleration [m/s^2] of the model; 0 where its flags disable gravity.

        Raises:
            ModelError: it is not along -z.
        """
        return read_gravity(self.model)
