"""`Lookout`: sees what each step of a run leaves, by compiled code."""

import ctypes
from collections.abc import Iterable

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.engine import layout
from buoyancy_mj.engine.compiled import require_known_layout
from buoyancy_mj.kernels.entries import steps
from buoyancy_mj.kernels.entries.views import Table
from buoyancy_mj.scenes.divergence import BAD_VALUES, Limits
from buoyancy_mj.scenes.monitor import Monitor


class Lookout:
    """Looks at the data of a run after each step, for its limits and its monitors.

    Args:
        data: the data, which are stepped.
        limits: what its bodies may not go beyond.
        monitors: keep what the summary tells.

    Raises:
        EngineError: this MuJoCo is not as expected inside.
    """

    def __init__(self, data: mujoco.MjData, limits: Limits, monitors: Iterable[Monitor]) -> None:
        require_known_layout()
        self._data, self._limits, self._monitors = data, limits, list(monitors)
        self._watched = np.zeros(len(self._monitors), np.int64)
        self._table = Table(
            steps.Lookout(
                xpos=data.xpos,
                xmat=data.xmat,
                xipos=data.xipos,
                cvel=data.cvel,
                warnings=_view_warnings(data),
                bad_values=np.array(BAD_VALUES),
                bounds=limits.bounds,
                watched=self._watched,
                contact_count=data._address + layout.offset("mjData.ncon"),
                contacts=data._address + layout.offset("mjData.contact"),
                contact_size=layout.size("mjContact"),
                contact_geoms=layout.offset("mjContact.geom"),
            )
        )

    def reserve(self, count: int) -> None:
        """Make room for as many more steps."""
        self._watched[:] = [monitor.reserve(count) for monitor in self._monitors]

    def look(self, before: float, now: float) -> None:
        """See what a step from one time [s] to another has left.

        Raises:
            DivergenceError: a position, velocity or acceleration left the finite numbers, or all
                reason: see `Limits`.
        """
        if steps.look(self._table.address, before, now):
            self._limits.check_data(self._data, before)
            steps.add_step(self._table.address, before, now)


def _view_warnings(data: mujoco.MjData) -> NDArray[np.int32]:
    """What MuJoCo counts (n, 2): what each warning was about last, and how often it came."""
    address = data._address + layout.offset("mjData.warning")
    numbers = ctypes.cast(address, ctypes.POINTER(ctypes.c_int32))
    return np.ctypeslib.as_array(numbers, (len(data.warning.number), 2))
