"""The water in `xfrc_applied`, and what others have written there.

MuJoCo keeps those rows from step to step, copies them with data, saves them in states and clears
them on a reset; users and the viewer's mouse write them. The water assigns the rows of its bodies,
to the sum of its own wrench and that of others, and so must know again what it wrote. It seals what
it writes, in the row of the world, which MuJoCo never reads: digests of the rows and of the part of
others, as numbers under 1e-309. The seal goes with the rows wherever MuJoCo takes them.
"""

import collections
import hashlib
import warnings
import weakref

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import BuoyancyWarning, EngineError

MOST_REMEMBERED = 1024
"""Rows that were written last, and forces of others that were met last, which are remembered."""
_MARK = b"sea:"
_WORD = 6
"""Bytes of a seal in each number: below 2^48, the bits of a double are those of a tiny number."""
Digest = bytes


class AppliedRows:
    """The rows of `xfrc_applied` of the bodies in one water."""

    def __init__(self, bodies: NDArray[np.int64]) -> None:
        """Of a model's data.

        Args:
            bodies: indices of the bodies (n,).
        """
        self._bodies = bodies
        self._none = np.zeros((len(bodies), 6))
        self._written: _Memory = collections.OrderedDict()
        self._others: _Memory = collections.OrderedDict()
        self._datas: weakref.WeakValueDictionary[int, mujoco.MjData]
        self._datas = weakref.WeakValueDictionary()

    def assign(self, data: mujoco.MjData, wrenches: NDArray[np.float64]) -> None:
        """Set the rows to the water's wrenches (nbody, 6) and those of others.

        Raises:
            EngineError: see `find_others`.
        """
        others = self.find_others(data)
        rows = others + wrenches[self._bodies]
        data.xfrc_applied[self._bodies] = rows
        data.xfrc_applied[0] = _seal(self._digest(rows), self._digest(others))
        _remember(self._written, self._digest(rows), rows)
        _remember(self._others, self._digest(others), others)
        self._datas[data._address] = data

    def take_out(self, data: mujoco.MjData) -> None:
        """Set the rows to what others want there, without the water.

        Raises:
            EngineError: see `find_others`.
        """
        others = self.find_others(data)
        if _read_seal(data.xfrc_applied[0]) is not None:
            data.xfrc_applied[self._bodies] = others
            data.xfrc_applied[0] = 0.0

    def take_out_everywhere(self) -> None:
        """Take the water out of all data that it was put into."""
        for data in list(self._datas.values()):
            try:
                self.take_out(data)
            except EngineError as error:
                warnings.warn(f"the water stays in data: {error}", BuoyancyWarning, stacklevel=2)
        self._datas.clear()

    def find_others(self, data: mujoco.MjData) -> NDArray[np.float64]:
        """The rows (n, 6) that others want.

        A number that the water wrote still has the others' part that it had then. A number that is
        another now was assigned by others since. Without a seal, all were.

        Raises:
            EngineError: rows were assigned over water that is not remembered any more.
        """
        rows: NDArray[np.float64] = data.xfrc_applied[self._bodies]
        seal = _read_seal(data.xfrc_applied[0])
        if seal is None:
            return rows
        written, others = seal
        then = self._none if others == self._digest(self._none) else self._others.get(others)
        if then is not None and self._digest(rows) == written:
            return then.copy()
        before = self._written.get(written)
        if then is None or before is None:
            raise EngineError(
                "xfrc_applied holds the water of a pass long ago together with forces of others, "
                "and the two cannot be told apart any more: set xfrc_applied to 0, then to those "
                "forces"
            )
        return np.where(rows.view(np.int64) == before.view(np.int64), then, rows)

    def _digest(self, rows: NDArray[np.float64]) -> Digest:
        """A hash (16 bytes) of rows and of the bodies that they are of."""
        digest = hashlib.blake2b(self._bodies.tobytes(), digest_size=16)
        digest.update(rows.tobytes())
        return digest.digest()


_Memory = collections.OrderedDict[Digest, NDArray[np.float64]]


def _remember(memory: _Memory, digest: Digest, rows: NDArray[np.float64]) -> None:
    """Remember rows as the newest, and forget the oldest."""
    memory[digest] = rows
    memory.move_to_end(digest)
    if len(memory) > MOST_REMEMBERED:
        memory.popitem(last=False)


def _seal(written: Digest, others: Digest) -> NDArray[np.float64]:
    """The row of the world (6,) for what was written and what others want."""
    text = _MARK + written + others
    words = [int.from_bytes(text[i : i + _WORD]) for i in range(0, len(text), _WORD)]
    return np.array(words, np.int64).view(np.float64)


def _read_seal(row: NDArray[np.float64]) -> tuple[Digest, Digest] | None:
    """The digests in the row of the world; None where it is no seal."""
    words = row.view(np.int64).tolist()
    if not all(0 <= word < 2 ** (8 * _WORD) for word in words):
        return None
    text = b"".join(word.to_bytes(_WORD) for word in words)
    if not text.startswith(_MARK):
        return None
    digests = text.removeprefix(_MARK)
    return digests[:16], digests[16:]
