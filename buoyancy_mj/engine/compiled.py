"""`CompiledWater`: tables and C functions by which compiled code acts without Python."""

import ctypes
import functools
import itertools
import os
import threading
import weakref
from collections.abc import Callable, Iterator

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.engine import crews, layout, library
from buoyancy_mj.engine.c_functions import PythonFunction, encode_text
from buoyancy_mj.engine.load_model import LoadModel
from buoyancy_mj.errors import EngineError
from buoyancy_mj.kernels.entries import loads, passive
from buoyancy_mj.kernels.entries.closures import compile_kernel
from buoyancy_mj.kernels.entries.tables import Links, WaterTable, Workplace
from buoyancy_mj.kernels.entries.views import WORDS, Table, slot
from buoyancy_mj.kernels.multibody import NO_GRAVITY, PGS, sum_sizes
from buoyancy_mj.kernels.passes import ALIVE, DATA, IDS, MODEL, WATER, Record, count_items
from buoyancy_mj.kernels.paths import PATHS
from buoyancy_mj.submersion.exact import PackedHulls

THREADS = 64
"""Threads that may act at once in one water; more take turns. What is not used costs no memory. A
callback keeps records of as many data."""
_WET, _IDS = (8 * WORDS * slot(Record, name) for name in ("wet", "ids"))
"""Bytes in the table of a record before the addresses of these arrays."""


def read_ids(record: int) -> NDArray[np.int64]:
    """`Record.ids` of the record whose table is at an address."""
    words = ctypes.cast(layout.word(record + _IDS), ctypes.POINTER(ctypes.c_int64))
    return np.ctypeslib.as_array(words, (IDS,))


class CompiledWater:
    """The water of one `Buoyancy`, ready for compiled code."""

    def __init__(
        self,
        model: mujoco.MjModel,
        load_model: LoadModel,
        lock: threading.RLock,
        measure: Callable[[], None],
        handle: NDArray[np.int64],
        threads: int = 1,
    ) -> None:
        """Gather it.

        Args:
            model: the model.
            load_model: what acts on it; hulls of `Exact` are submerged by compiled code.
            lock: held while hulls are submerged by Python code.
            measure: called when the model's geoms have other sizes than those of `load_model`.
            handle: a word (1,) that is set to the address of the water's table.
            threads: how many share the hulls and bodies of a pass.

        Raises:
            EngineError: see `require_known_layout`.
        """
        require_known_layout()
        self._load_model, self._lock = load_model, lock
        self._sizes, self._geoms = (model.nbody, model.nC), model.ngeom

        # C functions of Python, and what the engine is told
        exact = isinstance(load_model.packed, PackedHulls)
        self._submerge = (
            compile_kernel(loads.submerge) if exact else PythonFunction(self._submerged)
        )
        self._measure = PythonFunction(lambda *_: measure())
        self._text = encode_text(
            "gravity is not along -z, and water needs it so: set <option gravity='0 0 -9.81'/>"
        )
        self._sizes_text = encode_text(
            "a copy of the model has geoms of other sizes than the model of the water: "
            "add_water(spec) makes water that is measured for each"
        )
        links = Links(
            model=model._address,
            signature=model.signature,
            sizes=sum_sizes(np.frombuffer(load_model.sizes, np.int64).copy().reshape(-1, 3)),
            measure=self._measure.address,
            sizes_text=ctypes.addressof(self._sizes_text),
            act=compile_kernel(passive.act).address,
            submerge=self._submerge.address,
            augment=compile_kernel(loads.augment).address if load_model.augments else 0,
            inertia=compile_kernel(loads.add_inertia).address if load_model.augments else 0,
            error=library.symbol("mju_error"),
            gravity_text=ctypes.addressof(self._text),
            factor=library.symbol("mj_factorM"),
            project=library.symbol("mj_projectConstraint"),
            crew=crews.crew().table.address if threads > 1 else 0,
            threads=threads,
        )

        # where threads work, and what they leave
        self._offsets = np.array([layout.offset(path) for path in PATHS], np.int64)
        self._taken, self._busy = np.zeros((2, THREADS), np.int64)
        self._places = [
            Table(Workplace(scratch, taken))
            for scratch, taken in zip(
                load_model.new_scratches(THREADS), _addresses(self._taken), strict=True
            )
        ]
        self._last = [self._new_record() for _ in range(THREADS)]
        self._turn = np.zeros(1, np.int64)
        self._table = Table(
            WaterTable(
                load_model.arrays,
                Links._make(np.array([int(n) % 2**64 for n in links], np.uint64).view(np.int64)),
                acting=np.array(
                    [compile_kernel(loads.make_entry(load)).address for load in load_model.acting]
                ),
                items=np.array(
                    [count_items(load, load_model.arrays) for load in load_model.acting]
                ),
                hulls=len(load_model.packed.volumes) if exact else 1,
                offsets=self._offsets.ctypes.data,
                pool=np.array([place.address for place in self._places]),
                records=np.array([record.address for record in self._last]),
                datas=np.zeros(THREADS, np.int64),
                busy=_addresses(self._busy),
                turn=self._turn.ctypes.data,
            )
        )
        self.address = self._table.address
        """Of the table of the water."""
        self._handle = handle
        self._handle[0] = self.address
        self._records: list[Table[Record]] = []
        self._room = 16
        _WATERS.add(self)

    def record(self, model: int) -> Table[Record]:
        """A record for one data of the model at an address, in use while `ids[ALIVE]` is 1."""
        if len(self._records) >= self._room:
            self._records = [record for record in self._records if record.arrays.ids[ALIVE]]
            self._room = 2 * len(self._records) + 16
        record = self._new_record()
        record.arrays.ids[[ALIVE, MODEL, WATER]] = 1, model, self.address
        self._records.append(record)
        return record

    @property
    def used(self) -> bool:
        """Whether any record is in use."""
        return any(record.arrays.ids[ALIVE] for record in self._records)

    def last_record(self, data: int) -> Record | None:
        """The record of the last pass over the data at an address; None if there is none.

        It is gone too when a callback acted on `THREADS` others since.
        """
        places = np.flatnonzero(self._table.arrays.datas == data).tolist()
        likely = [self._last[place].arrays for place in places]
        alive = (record.arrays for record in self._records if record.arrays.ids[ALIVE])
        records = itertools.chain(likely, alive)
        return next((record for record in records if record.ids[DATA] == data), None)

    def forget(self, data: int) -> None:
        """Forget that: something else acts on the data."""
        for record in self._all_records():
            if record.ids[DATA] == data:
                record.ids[DATA] = 0

    def _new_record(self) -> Table[Record]:
        return Table(self._load_model.record(*self._sizes))

    def _all_records(self) -> Iterator[Record]:
        yield from (record.arrays for record in self._last)
        yield from (record.arrays for record in self._records if record.arrays.ids[ALIVE])

    def _submerged(self, _: int, data: int, record: int) -> None:
        """Submerge by Python code what the engine's data hold."""
        # data hold no sizes
        positions, rotations = (
            np.ctypeslib.as_array(
                ctypes.cast(
                    layout.word(data + layout.offset(f"mjData.{name}")),
                    ctypes.POINTER(ctypes.c_double),
                ),
                (self._geoms, n),
            )
            for name, n in (("geom_xpos", 3), ("geom_xmat", 9))
        )
        time = float(
            np.frombuffer(np.int64(layout.word(data + layout.offset("mjData.time"))).tobytes())[0]
        )
        with self._lock:
            wet = self._load_model.packed.submerge(positions, rotations, time, data)
            target = ctypes.cast(layout.word(record + _WET), ctypes.POINTER(ctypes.c_double))
            np.ctypeslib.as_array(target, wet.shape)[:] = wet


_WATERS: weakref.WeakSet[CompiledWater] = weakref.WeakSet()
"""All that there are."""


def _vacate_all() -> None:
    """Take back what threads were working at that a forked child does not have."""
    for water in list(_WATERS):
        water._taken[:] = water._busy[:] = 0


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_vacate_all)


def _addresses(words: NDArray[np.int64]) -> NDArray[np.int64]:
    """The address of each word of an array."""
    return words.ctypes.data + 8 * np.arange(len(words))


@functools.cache
def require_known_layout() -> None:
    """See that this MuJoCo keeps its numbers where compiled code will look for them.

    Raises:
        EngineError: it does not.
    """
    theirs = int(mujoco.mjtDisableBit.mjDSBL_GRAVITY), int(mujoco.mjtSolver.mjSOL_PGS)
    if theirs != (NO_GRAVITY, PGS):
        raise EngineError(
            f"MuJoCo {mujoco.__version__} has other flags than expected; "
            "use buoyancy.installed(native=False)"
        )
    layout.verify(PATHS)
    library.symbol("mju_error")
