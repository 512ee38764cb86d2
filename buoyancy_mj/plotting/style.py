"""The look of all charts, and their files."""

from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

import matplotlib.style
from matplotlib.figure import Figure

from buoyancy_mj.files import replace_file

STYLE = Path(__file__).with_name("house.mplstyle")
"""The style sheet, which Matplotlib takes by its path."""
BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY = (
    "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9",
)  # fmt: skip
"""Colours of Okabe and Ito (2008), which colour-blind eyes tell apart, as in the sheet."""
INK, FAINT = "#222222", "#888888"
"""Colours of what stands beside the lines: text and marks."""
SOFTWARE = "buoyancy_mj"
"""What pictures say of the software that made them."""
_METADATA = {
    ".png": {"Software": SOFTWARE},
    ".svg": {"Creator": SOFTWARE, "Date": None},
    ".pdf": {"Creator": SOFTWARE, "CreationDate": None},
}
PICTURES = tuple(_METADATA)
"""Ends of names that say what kind of picture a file is."""


def use_style() -> AbstractContextManager[Any]:
    """Give the figures that are drawn in a block the look of the house."""
    style: AbstractContextManager[Any] = matplotlib.style.context(STYLE)
    return style


def new_figure(width: float = 9.0, height: float = 5.0) -> Figure:
    """An empty figure of a size [inches] whose layout leaves room for all text."""
    return Figure(figsize=(width, height), layout="constrained")


def save_figure(figure: Figure, path: Path) -> None:
    """Write a figure as PNG, SVG or PDF; a file that was there is replaced at once or not at all.

    Raises:
        OSError: the file cannot be written.
    """
    with replace_file(path) as part:
        figure.savefig(part, metadata=_METADATA.get(path.suffix))
