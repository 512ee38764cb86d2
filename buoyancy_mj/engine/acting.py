"""`ActingWater`: water at work on the data of one model, by Python and by compiled code."""

import collections
import functools
import weakref
from collections.abc import Sequence

import mujoco
import numpy as np

from buoyancy_mj.engine import passes
from buoyancy_mj.engine.applied import AppliedRows
from buoyancy_mj.engine.checks import check_data
from buoyancy_mj.engine.compiled import CompiledWater
from buoyancy_mj.engine.forks import make_lock
from buoyancy_mj.engine.load_model import LoadModel, build_load_model
from buoyancy_mj.errors import EngineError
from buoyancy_mj.hulls.gravity import read_gravity
from buoyancy_mj.kernels.passes import DATA, Record
from buoyancy_mj.settings.settings import Settings


class ActingWater:
    """Measured hulls, and what passes over the data of their model write and leave.

    Threads that share it take turns, but for those in compiled code.
    """

    def __init__(
        self, model: mujoco.MjModel, settings: Settings, bodies: Sequence[int] | None
    ) -> None:
        """Measure the hulls.

        Args:
            model: the model.
            settings: the water, and how it acts.
            bodies: indices of the bodies whose geoms may displace; None for all.
        """
        self.model = model
        """The model."""
        self._settings, self._chosen = settings, bodies
        self.lock = make_lock()
        """Held while a pass is made by Python."""
        self._table = np.zeros(1, np.int64)
        self._outdated: collections.deque[CompiledWater] = collections.deque(maxlen=4)
        self.load_model: LoadModel = build_load_model(model, settings, bodies)
        """What acts, as the hulls were measured last."""
        self._applied = AppliedRows(self.load_model.arrays.bodies)
        self._make_room()

    def act(self, data: mujoco.MjData) -> None:
        """Add the forces to `data.qfrc_passive`, once in each pass.

        Raises:
            ModelError: the data are of another model.
        """
        with self.lock:
            last = self._pass_over(data)
            passes.apply(self.load_model, self.model, data, last)

    def act_on_bodies(self, data: mujoco.MjData) -> None:
        """Put the wrenches into `data.xfrc_applied`, beside those of others.

        Raises:
            ModelError: the data are of another model.
            EngineError: see `AppliedRows.find_others`.
        """
        with self.lock:
            last = self._pass_over(data)
            self._applied.assign(data, last.record.total)
            passes.augment(self.load_model, self.model, data, last)

    def leave_bodies(self, data: mujoco.MjData | None = None) -> None:
        """Take the water out of `xfrc_applied` of some data; None for all that it was put into.

        Raises:
            ModelError: the data are of another model.
            EngineError: see `AppliedRows.find_others`; for all data it is a warning.
        """
        with self.lock:
            if data is None:
                self._applied.take_out_everywhere()
            else:
                check_data(self.model, data)
                self._applied.take_out(data)

    def look(self, data: mujoco.MjData) -> Record:
        """The loads at the poses of `data`, in a record that the next look writes anew.

        It is a run of its own, so that what passes carry from step to step stays untouched.

        Raises:
            ModelError: the data are of another model.
        """
        check_data(self.model, data)
        with self.lock:
            self.measure_resized()
            self._evaluate(data, -data._address, self._looked)
            return self._looked

    def last_record(self, data: mujoco.MjData) -> Record | None:
        """What the last pass over `data` left; None if there was none, or none at their time.

        Raises:
            ModelError: the data are of another model.
        """
        check_data(self.model, data)
        with self.lock:
            record = (
                self.compiled.last_record(data._address) if "compiled" in self.__dict__ else None
            )
            if record is None:
                record = self._recent.find(data._address)
            # a pass lies no more than a step back; an older one was of other data at the address
            if record is None:
                return None
            age = abs(data.time - record.instant[0])
            return record if age <= 1.001 * data.model.opt.timestep else None

    def record_of_now(self, data: mujoco.MjData) -> Record:
        """What the last pass over `data` left, which hold its poses still.

        Raises:
            ModelError: the data are of another model.
            EngineError: there was none at their time, or they hold other poses.
        """
        record = self.last_record(data)
        if record is None:
            raise EngineError(
                f"this water has not acted on these data at their time, {data.time:g} s; "
                "step them while it acts, call mj_forward, or use evaluate"
            )
        # bit for bit, NaN too
        if record.xipos.tobytes() != data.xipos.tobytes():
            raise EngineError(
                "the bodies of these data are elsewhere than in the last pass of this water; "
                "call mj_forward while it acts, or use evaluate"
            )
        return record

    @functools.cached_property
    def compiled(self) -> CompiledWater:
        """What compiled code needs of this water.

        Raises:
            EngineError: this MuJoCo is not as expected inside.
        """
        # weakly, since compiled code may outlive this object
        measure = weakref.WeakMethod(self.measure_resized)
        return CompiledWater(
            self.model,
            self.load_model,
            self.lock,
            lambda: (measure() or _measure_nothing)(),
            self._table,
            self.threads,
        )

    @property
    def threads(self) -> int:
        """How many threads share a pass of compiled code."""
        return self._settings.threads

    @property
    def handle(self) -> int:
        """Address of the word that holds the address of the table of `compiled`."""
        return self._table.ctypes.data

    def measure_resized(self) -> None:
        """Measure the hulls again if the model's geoms have other sizes than they had then."""
        with self.lock:
            if self.model.geom_size.tobytes() == self.load_model.sizes:
                return
            self.load_model = build_load_model(self.model, self._settings, self._chosen)
            self._make_room()
            if "compiled" in self.__dict__:
                # threads may be in it still
                self._outdated.append(self.compiled)
                del self.compiled
                self.compiled  # noqa: B018

    def _pass_over(self, data: mujoco.MjData) -> passes.Pass:
        """Evaluate the loads for the callback, and keep them as those of the last pass."""
        check_data(self.model, data)
        self.measure_resized()
        last = self._recent.take(data._address)
        last.record.ids[DATA] = 0
        self._evaluate(data, data._address, last.record)
        last.record.ids[DATA] = data._address
        if "compiled" in self.__dict__:
            self.compiled.forget(data._address)
        return last

    def _evaluate(self, data: mujoco.MjData, run: int, record: Record) -> None:
        passes.evaluate(self.load_model, self.model, data, read_gravity(self.model), run, record)

    def _make_room(self) -> None:
        """Make room for what passes leave."""
        new_record = functools.partial(self.load_model.record, self.model.nbody, self.model.nC)
        self._looked = new_record()
        self._recent = passes.RecentPasses(new_record, self.model.nv)


def _measure_nothing() -> None:
    """The water has gone."""
