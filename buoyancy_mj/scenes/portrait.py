"""`portray`: a run in a notebook: its summary, and how its vehicles moved."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from buoyancy_mj.displays.charts import draw_chart
from buoyancy_mj.displays.tables import write_table

if TYPE_CHECKING:
    from buoyancy_mj.scenes.summary import Summary


def portray(summary: "Summary", charts: str = "") -> str:
    """A summary as HTML.

    Args:
        summary: the run in a few numbers.
        charts: HTML that stands under the table.
    """
    several = len(summary.vehicles) > 1
    header = ("", *summary.vehicles) if several else ()
    below = write_table("", [(line,) for line in summary.caption.splitlines()]) if several else ""
    return write_table(summary.scene, summary.rows(), header, below + charts)


def draw_motions(
    times: ArrayLike, heights: Mapping[str, ArrayLike], angles: Mapping[str, ArrayLike]
) -> str:
    """Charts of motions over time, as HTML.

    Args:
        times: times (n,) [s].
        heights: heights (n,) [m], by their names.
        angles: angles (n,) [rad], by their names.
    """
    turned = {name: np.degrees(np.asarray(values, float)) for name, values in angles.items()}
    return draw_chart(times, heights, "time [s]", "height [m]") + draw_chart(
        times, turned, "time [s]", "angle [degrees]"
    )
