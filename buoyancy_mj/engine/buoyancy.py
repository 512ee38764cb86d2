"""`Buoyancy`: the water that acts on the bodies of one MuJoCo model."""

import contextlib
import dataclasses
import functools
from collections.abc import Iterator, Sequence
from typing import Any, Unpack

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.engine import callbacks, presence
from buoyancy_mj.engine.acting import ActingWater
from buoyancy_mj.engine.checks import (
    check_actuation,
    check_applied,
    check_data,
    check_forwarded,
    check_sleep,
    check_waves,
    warn_of_fixed_carrier,
    warn_of_no_volume,
    warn_of_no_waterplane,
)
from buoyancy_mj.engine.compiled import CompiledWater
from buoyancy_mj.engine.finding import keep_installed
from buoyancy_mj.engine.instances import plugin_instances
from buoyancy_mj.engine.readout import read_loads
from buoyancy_mj.hulls.bodies import group_floating_bodies
from buoyancy_mj.hulls.gravity import read_gravity
from buoyancy_mj.hulls.hull import Hull
from buoyancy_mj.hulls.verdicts import check_model
from buoyancy_mj.kernels.inertia import AddedMass
from buoyancy_mj.kernels.passes import Record
from buoyancy_mj.loads.loads import Loads
from buoyancy_mj.records import ReadOnly
from buoyancy_mj.sea.water import Water
from buoyancy_mj.settings.settings import Options, Settings, combine_settings
from buoyancy_mj.submersion.methods import Packed


class Buoyancy(ReadOnly):
    """Archimedes' force on every hull of a model, and drag on its bodies, as a callback of MuJoCo.

    The force rho g V acts upward at the centroid of each hull's submerged volume. It enters through
    `data.qfrc_passive`, which MuJoCo computes anew before each call, with its own fluid forces. So
    `xfrc_applied` and `qfrc_applied` stay the user's and the viewer's alone, and saved states carry
    no water in them. Force and torque sensors see only `xfrc_applied`: `installed` can let the
    water act there, and `evaluate(data).xfrc` has its layout.

    Gravity is the model's. Without gravity there is no buoyancy. Geoms that are resized are
    measured again in the next pass. A `Buoyancy` can be copied and pickled, with its model.

    Args:
        model: any MuJoCo model with bodies that move.
        water: the sea, fresh and still at z = 0 if None; or `Settings`, which hold it and all
            options.
        bodies: indices of the bodies whose geoms may displace; None for all.
        options: any of the other fields of `Settings`: method, pressure, damping, added_mass,
            slamming, selection, threads.

    Raises:
        WaterError: a wave that states another gravity than the model's.
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
        """All options, as they were given."""

        # what water asks of a model
        check_model(model)
        check_actuation(model)
        check_sleep(model)
        gravity = read_gravity(model)

        # the sea, whose waves run under the model's gravity
        self.water = self.settings.water.with_gravity(gravity)
        """The sea, with waves under the model's gravity."""
        settings = dataclasses.replace(self.settings, water=self.water)

        # the hulls, and what acts on them
        self._chosen = bodies
        self._acting = ActingWater(model, settings, bodies)
        check_waves(model, self.water, self.hulls)
        warn_of_no_volume(model)
        warn_of_fixed_carrier(model, self.hulls)
        warn_of_no_waterplane(model, self.added_mass, self.settings.method)

        # the bodies
        self.bodies = self._acting.load_model.arrays.bodies
        """Indices of the bodies that have hulls or foils."""
        groups = group_floating_bodies(model)
        afloat = [group for group in groups if np.isin(group, self.bodies).any()]
        self.floating = np.sort(np.concatenate(afloat))
        """Indices of all bodies that float, and of those that they carry: the vehicles."""
        self._seal("make another Buoyancy(model, water, ...)", Buoyancy)

    @property
    def hulls(self) -> tuple[Hull, ...]:
        """The hulls, in the order of the model's geoms, as they were measured last."""
        return self._acting.load_model.hulls

    @property
    def packed(self) -> Packed:
        """The hulls as the method keeps them, ready to be submerged again and again."""
        return self._acting.load_model.packed

    @property
    def added_mass(self) -> AddedMass:
        """Added mass of those bodies that have one."""
        return self._acting.load_model.arrays.added_mass

    @property
    def causes(self) -> tuple[str, ...]:
        """Names of the loads that act."""
        return self._acting.load_model.causes

    def __repr__(self) -> str:
        volume = sum(hull.displaced_volume for hull in self.hulls)
        return (
            f"Buoyancy(hulls: {len(self.hulls)}, bodies: {len(self.bodies)}, "
            f"displacement: {self.water.density * volume:.4g} kg, "
            f"waves: {len(self.water.rows)}, method: {self.settings.method.name}, "
            f"loads: {', '.join(self.causes)})"
        )

    def __reduce__(self) -> tuple[Any, ...]:
        # made anew: its model and settings are all that it is
        return functools.partial(type(self), bodies=self._chosen), (self.model, self.settings)

    def __call__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Add the water's forces to `data.qfrc_passive`, unless the water is `installed`.

        It has the signature of an `mjcb_control`, and may be called between mj_step1 and mj_step2.
        Data of other models are left alone. A second call in the same pass replaces the first.
        """
        if model._address == self.model._address and not callbacks.is_installed(self._acting):
            self.act(data)

    @contextlib.contextmanager
    def installed(
        self,
        native: bool | None = None,
        *,
        through: str = callbacks.PASSIVE,
        copies: bool = False,
    ) -> Iterator["Buoyancy"]:
        """Install the water as a callback of MuJoCo for the length of a `with` block.

        The callback that was there still runs first, and is put back at the end. The water becomes
        `mjcb_passive`, which MuJoCo calls once in each pass, in `mj_inverse` and for finite
        differences too. Where a model disables springs and dampers, MuJoCo skips that callback, and
        the water becomes `mjcb_control`. A second `installed` inside the block changes nothing, and
        blocks may end in any order.

        Through `xfrc_applied` the water is an `mjcb_control` in Python that writes its wrench on
        each body there, about its `xipos`: force and torque sensors and `cfrc_ext` read it, and the
        motion is the same. In each pass the water assigns the rows of its bodies, to its own wrench
        plus what others want there. Others want what was there before, until they assign a row
        anew, clear it, reset the data or restore a state. So assign a row, between steps. A `+=`
        would count the water in the row twice; `external(data)[body] += wrench` does not. At the
        end the rows hold what others want.

        Args:
            native: whether to install a compiled C function. It needs no Python and takes no lock,
                so that threads step side by side and `mujoco.batch` accepts it. None does so where
                it is possible: not beside a callback in Python, and not as `mjcb_control`.
            through: 'qfrc_passive' or 'xfrc_applied', where the forces enter.
            copies: whether to act on other models of the same compilation signature too, such as
                `mujoco.batch` makes of its model; compiled only.

        Raises:
            ModelError: the model disables actuation, or brings its own water; or, through
                `xfrc_applied`, another water acts there, or a sensor would misread added mass.
            EngineError: `native`, `through`, `copies` or several threads are asked for and cannot
                be; the message says why.
        """
        if through == callbacks.APPLIED:
            check_applied(self.model, self.causes, augments=self._acting.load_model.augments)
        link = callbacks.install(self._acting, native, through=through, copies=copies)
        with link, keep_installed(self):
            yield self

    def act(self, data: mujoco.MjData) -> None:
        """Add the forces to `data.qfrc_passive`, once in each pass.

        Raises:
            ModelError: the data are of another model, or their bodies are placed nowhere yet; or
                the model brings its own water.
        """
        callbacks.check_single(self.model)
        check_data(self.model, data)
        check_forwarded(data)
        presence.note_called(self._acting)
        self._acting.act(data)

    def act_late(self, data: mujoco.MjData) -> None:
        """Act where a pass calls mjcb_control, unless the water has acted in that pass already.

        It is for `engine.forward`, which goes through the stages of a pass without that callback.
        """
        if not plugin_instances(data.model):
            callbacks.act_in_control(self._acting, data)

    def external(self, data: mujoco.MjData) -> NDArray[np.float64]:
        """`data.xfrc_applied` (nbody, 6) without the water, until the next pass puts it back.

        It is MuJoCo's own array: what is written to it, or added, is counted beside the water.

        Args:
            data: of this model.

        Raises:
            ModelError: the data are of another model.
            EngineError: others wrote over water of a pass so long ago that it is forgotten.

        Example:
            `buoyancy.external(data)[body, :3] += [10.0, 0.0, 0.0]`
        """
        check_data(self.model, data)
        self._acting.leave_bodies(data)
        rows: NDArray[np.float64] = data.xfrc_applied
        return rows

    def evaluate(self, data: mujoco.MjData) -> Loads:
        """The loads at the poses and velocities of `data`, as mj_forward left them; writes nothing.

        Args:
            data: of this model.

        Raises:
            ModelError: the data are of another model, or their bodies are placed nowhere yet, as in
                new data before mj_forward.
        """
        check_data(self.model, data)
        check_forwarded(data)
        with self._acting.lock:
            return self._read(self._acting.look(data), data)

    def loads(self, data: mujoco.MjData) -> Loads:
        """The loads that acted in the last pass over `data`, at the poses of that pass.

        A pass is part of a step, or of mj_forward. Those over the last 64 data are kept, and with
        water in the model itself those over all data.

        Raises:
            ModelError: the data are of another model.
            EngineError: none acted on these data so far, 64 others were stepped since, or the data
                hold other poses now.
        """
        with self._acting.lock:
            return self._read(self._acting.record_of_now(data), data)

    @property
    def acting(self) -> ActingWater:
        """What acts on data: the hulls, and what passes over them leave."""
        return self._acting

    @property
    def compiled(self) -> CompiledWater:
        """What compiled code needs of this water.

        Raises:
            EngineError: this MuJoCo is not as expected inside.
        """
        return self._acting.compiled

    def centre_of_mass(self, data: mujoco.MjData) -> NDArray[np.float64]:
        """Centre of mass (3,) [m] of the floating bodies, world frame.

        Raises:
            ModelError: the data are of another model.
        """
        check_data(self.model, data)
        masses = data.model.body_mass[self.floating]
        centre: NDArray[np.float64] = masses @ data.xipos[self.floating] / masses.sum()
        return centre

    @property
    def gravity(self) -> float:
        """Downward acceleration [m/s^2] of the model; 0 where its flags disable gravity.

        Raises:
            ModelError: it is not along -z.
        """
        return read_gravity(self.model)

    def _read(self, record: Record, data: mujoco.MjData) -> Loads:
        """What a record holds; its data still hold the poses."""
        centre = self.centre_of_mass(data)
        return read_loads(self._acting.load_model, record, data, self.gravity, centre)
