"""What compiled code needs to act without Python: tables of the water and of where results go, and C functions."""

import collections
import ctypes
import functools
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from enum import IntEnum
from typing import Any

import mujoco
import numba
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.engine import layout
from buoyancy_mj.engine.load_model import CAUSES, LoadModel
from buoyancy_mj.errors import EngineError
from buoyancy_mj.kernels import clip
from buoyancy_mj.kernels.entries import passive as kernel
from buoyancy_mj.kernels.entries import plugin_hooks as entries
from buoyancy_mj.kernels.entries.closures import Closure
from buoyancy_mj.loads.damping_arrays import DampingArrays
from buoyancy_mj.submersion.exact import PackedHulls

THREADS = 64
"""Threads that may act at once in one water; more take turns. What is not used costs no memory."""
_WORD = ctypes.c_int64
_SIGNATURES = {
    kernel.act: "int64(int64, int64, int64, int64)",
    kernel.callback: "void(int64, int64, int64, int64, int64)",
    entries.nstate: "int32(int64, int32)",
    entries.reset: "void(int64, int64, int64, int32)",
    entries.init: "int32(int64, int64, int32, int64)",
    entries.destroy: "void(int64, int32, int64)",
    entries.copy: "void(int64, int64, int64, int32, int64)",
    entries.compute: "void(int64, int64, int32, int32, int64)",
}
"""Functions that C calls, with what is bound to them last."""


class Table:
    """Arrays, by name, where compiled code finds them: three words for each, its address, rows and columns."""

    def __init__(self, names: type[IntEnum], arrays: Mapping[str, NDArray[Any]]) -> None:
        self.arrays = {
            entry.name: np.atleast_1d(np.ascontiguousarray(arrays[entry.name])) for entry in names
        }
        shapes = [
            (a.ctypes.data, a.shape[0], a.shape[1] if a.ndim > 1 else 1)
            for a in self.arrays.values()
        ]
        self._words = np.array(shapes, np.int64)
        self.address: int = self._words.ctypes.data
        """Of the table."""


class Record(Table):
    """What an evaluation leaves: submersions, and wrenches by cause and in total, see `Loads`."""

    def __init__(self, hulls: int, bodies: int, causes: Sequence[str], inertias: int) -> None:
        """For a number of hulls, of bodies and of elements of the mass matrix, and the names of the loads that act."""
        rows = {cause: np.zeros((bodies if cause in causes else 0, 6)) for cause in CAUSES}
        self.results, self.centres = np.zeros((hulls, clip.COLUMNS)), np.zeros((bodies, 4))
        self.heads = np.zeros((hulls, 6))
        """Pressure on the hulls, see `kernels.pressure`; zeros where it is not asked for."""
        self.causes = {cause: rows[cause] for cause in causes}
        self.total = np.zeros((bodies, 6))
        self.inertia = np.zeros(inertias if "added_mass" in causes else 0)
        """The mass matrix with the added mass in it, as it was left."""
        self.instant = np.zeros(1)
        """Time [s] of it."""
        self.ids = np.zeros(len(kernel.Id), np.int64)
        """See `kernels.native.Id`."""
        plain: dict[str, NDArray[Any]]
        plain = {
            "results": self.results,
            "centres": self.centres,
            "heads": self.heads,
            "total": self.total,
        }
        plain |= {"inertia": self.inertia, "instant": self.instant, "ids": self.ids}
        super().__init__(kernel.Record, rows | plain)


def read_ids(record: int) -> NDArray[np.int64]:
    """The words `Record.ids` of the record at an address."""
    return np.ctypeslib.as_array(
        ctypes.cast(layout.word(record + 24 * kernel.Record.ids), ctypes.POINTER(ctypes.c_int64)),
        (len(kernel.Id),),
    )


class Native:
    """The water of one `Buoyancy`, ready for compiled code."""

    def __init__(self, model: mujoco.MjModel, acting: LoadModel, lock: threading.RLock) -> None:
        """Gather it.

        Args:
            model: the model.
            acting: what acts on it; hulls of `Exact` are submerged by compiled code.
            lock: held while hulls are submerged by Python code.

        Raises:
            EngineError: see `available`.
        """
        require_known_layout()
        packed, owners, water, added = acting.packed, acting.owners, acting.water, acting.added
        exact = isinstance(packed, PackedHulls)
        hulls = packed.arrays if isinstance(packed, PackedHulls) else NO_HULLS
        self._new_record = functools.partial(
            Record, len(owners), model.nbody, acting.causes, model.nC
        )
        self._scratch = [_Scratch(hulls, self._new_record()) for _ in range(THREADS)]
        self._packed, self._lock, self._geoms = packed, lock, model.ngeom
        self._submerge = wrap_python(self._submerged)
        self._text = encode_text(
            "gravity is not along -z, and water needs it so: set <option gravity='0 0 -9.81'/>"
        )
        links = [
            model._address,
            model.signature,
            _compiled(kernel.act).address,
            0 if exact else address_of(self._submerge),
            layout.symbol("mju_error"),
            ctypes.addressof(self._text),
            layout.symbol("mj_factorM"),
            layout.symbol("mj_projectConstraint"),
        ]
        drag = acting.damping or NO_DAMPING
        self._table = Table(
            kernel.Water,
            dict(hulls)
            | {
                "waves": acting.rows,
                "owners": owners.astype(np.int64),
                "bodies": np.unique(owners).astype(np.int64),
                "damped": drag.bodies.astype(np.int64),
                "volumes": drag.volumes,
                "linear": drag.linear,
                "quadratic": drag.quadratic,
                "coupled": drag.coupled,
                "matrices": drag.matrices,
                "radiation": drag.radiation,
                "panels": drag.panels,
                "members": drag.members,
                "member_starts": drag.member_starts,
                "massive": added.bodies,
                "massive_volumes": added.volumes,
                "added": added.matrices,
                "sea": np.array([water.density, water.level, float(acting.pressure)]),
                "current": acting.current,
                "offsets": np.array([layout.offset(path) for path in kernel.OFFSETS]),
                "pool": np.array([scratch.address for scratch in self._scratch]),
                "links": np.array(links, np.uint64).astype(np.int64),
            },
        )
        self.address = self._table.address
        """Of the table of the water."""
        self._records: list[Record] = []
        self._room = 16

    def callback(self, previous: int = 0, *, copies: bool = False) -> Closure:
        """A C function void(const mjModel*, mjData*) that MuJoCo may call from any thread.

        Args:
            previous: such a function that is called first.
            copies: act on copies of the model too, known by MuJoCo's compilation signature.
        """
        return make_closure(
            kernel.callback, None, (_WORD, _WORD), self.address, previous, int(copies)
        )

    def record(self, model: int) -> Record:
        """A record for one data of the model at an address, in use until its word `ALIVE` is 0."""
        if len(self._records) >= self._room:
            self._records = [record for record in self._records if record.ids[kernel.Id.alive]]
            self._room = 2 * len(self._records) + 16
        record = self._new_record()
        record.ids[[kernel.Id.alive, kernel.Id.model, kernel.Id.water]] = 1, model, self.address
        self._records.append(record)
        return record

    @property
    def used(self) -> bool:
        """Whether any record is in use."""
        return any(record.ids[kernel.Id.alive] for record in self._records)

    def last_record(self, data: int) -> Record | None:
        """What was left of the data at an address; None if nothing was, or many others came after it."""
        found = [record for record in self._all_records() if record.ids[kernel.Id.data] == data]
        return max(found, key=lambda record: float(record.instant[0]), default=None)

    def forget(self, data: int) -> None:
        """Forget that: something else acts on the data."""
        for record in self._all_records():
            if record.ids[kernel.Id.data] == data:
                record.ids[kernel.Id.data] = 0

    def _all_records(self) -> Iterator[Record]:
        yield from (scratch.record for scratch in self._scratch)
        yield from (record for record in self._records if record.ids[kernel.Id.alive])

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
            wet = self._packed.submerge(positions, rotations, time, data)
            target = ctypes.cast(
                layout.word(record + 24 * kernel.Record.results), ctypes.POINTER(ctypes.c_double)
            )
            np.ctypeslib.as_array(target, wet.shape)[:] = wet


class _Scratch(Table):
    """Where one thread works."""

    def __init__(self, arrays: Mapping[str, NDArray[Any]], record: Record) -> None:
        self.record = record
        own = {name: np.empty_like(arrays[name]) for name in ("depths", "swell")}
        super().__init__(kernel.Scratch, own | {"state": np.array([0, record.address])})


NO_HULLS: Mapping[str, NDArray[Any]] = {name: np.zeros(0, np.int64) for name in PackedHulls.ARRAYS}
"""Of a water whose hulls compiled code does not submerge."""
NO_DAMPING = DampingArrays(
    np.zeros(0, np.int64),
    np.zeros(0),
    np.zeros((0, 6)),
    np.zeros((0, 6)),
    np.zeros(0, np.int64),
    np.zeros((0, 72)),
    np.zeros((0, 4)),
    np.zeros((0, 5)),
    np.zeros(0, np.int64),
    np.zeros(1, np.int64),
)


def wrap_python(function: Callable[[int, int, int], None]) -> Any:
    """A Python function of three words as a C function that gives 0, or the address of a text if it raises."""

    def called(first: int, second: int, third: int) -> int:
        try:
            function(first, second, third)
        except BaseException as error:
            # without its frames: what they hold must not be freed by the end of a thread
            error.__context__ = error.__cause__ = None
            _RAISED.error = error.with_traceback(None)
            # kept for the engine to read; a thread that is not Python's keeps nothing of its own
            _TEXTS.append(encode_text(f"buoyancy_mj: {error}"))
            return ctypes.addressof(_TEXTS[-1])
        return 0

    return _THREE_WORDS(called)


def pop_error() -> BaseException | None:
    """What the last function of `wrap_python` that failed in this thread raised; then forgotten."""
    error: BaseException | None = getattr(_RAISED, "error", None)
    _RAISED.error = None
    return error


def encode_text(text: str) -> Any:
    """A text for MuJoCo's error function, which formats it and has room for a thousand letters."""
    return ctypes.create_string_buffer(text.replace("%", "%%").encode()[:1000])


def address_of(function: Any) -> int:
    """Of a ctypes function."""
    return ctypes.cast(function, ctypes.c_void_p).value or 0


_THREE_WORDS = ctypes.CFUNCTYPE(_WORD, _WORD, _WORD, _WORD)
_RAISED = threading.local()
_TEXTS: collections.deque[Any] = collections.deque(maxlen=4 * THREADS)


@functools.cache
def require_known_layout() -> None:
    """See that this MuJoCo keeps its numbers where compiled code will look for them.

    Raises:
        EngineError: it does not.
    """
    theirs = int(mujoco.mjtDisableBit.mjDSBL_GRAVITY), int(mujoco.mjtSolver.mjSOL_PGS)
    if theirs != (kernel.NO_GRAVITY, kernel.PGS):
        raise EngineError(
            f"MuJoCo {mujoco.__version__} has other flags than expected; use buoyancy.installed(native=False)"
        )
    layout.verify(kernel.OFFSETS)
    layout.symbol("mju_error")


def make_closure(
    function: Callable[..., Any], result: type | None, arguments: tuple[type, ...], *bound: int
) -> Closure:
    """A kernel as a C function, with its last arguments bound."""
    return Closure(_compiled(function).address, result, arguments, *bound)


@functools.cache
def _compiled(function: Callable[..., Any]) -> Any:
    return numba.cfunc(_SIGNATURES[function], cache=True)(function)
