"""`portray`: loads in a notebook, cause by cause and hull by hull."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.displays.tables import write_table

if TYPE_CHECKING:
    from buoyancy_mj.loads.loads import Loads

_MOST_HULLS = 20
"""Most hulls that are listed."""


def portray(loads: "Loads") -> str:
    """Loads as HTML.

    Args:
        loads: what the water does at one instant.
    """
    forces = {cause: rows[:, :3].sum(axis=0) for cause, rows in loads.by_cause.items()}
    forces["all"] = loads.body.force.sum(axis=0)
    causes = [(cause, *_write_force(force)) for cause, force in forces.items()]
    header = ("force", "x [N]", "y [N]", "z [N]", "size [N]")
    hulls = [
        (name, f"{1e3 * volume:.4g}", f"{area:.4g}", f"{buoyancy:.4g}")
        for name, volume, area, buoyancy in zip(
            loads.names,
            loads.hull.volume.tolist(),
            loads.wetted_area.tolist(),
            loads.hull.force[:, 2].tolist(),
            strict=True,
        )
    ]
    if len(hulls) > _MOST_HULLS:
        rest = len(hulls) - _MOST_HULLS
        hulls = [*hulls[:_MOST_HULLS], (f"and {rest} more", "", "", "")]
    beneath = write_table(
        "Hulls", hulls, ("hull", "under water [l]", "wetted area [m^2]", "buoyancy up [N]")
    )
    return write_table("Loads of the water, world frame", causes, header, beneath)


def _write_force(force: NDArray[np.float64]) -> tuple[str, ...]:
    """The components of a force [N], and its size."""
    return (*(f"{value:.4g}" for value in force + 0.0), f"{np.linalg.norm(force):.4g}")
