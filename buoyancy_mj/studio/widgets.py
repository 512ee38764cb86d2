"""Pieces of panels: sliders with units, tables, sections, plots."""

from collections.abc import Iterable, Iterator, Sequence

from mujoco.studio.dear_imgui import dear_imgui as imgui
from mujoco.studio.implot import implot

from buoyancy_mj.studio.sea_state import Range

WARNING = (0.85, 0.40, 0.05, 1.0)
"""Colour of what somebody should know."""
PLOT_HEIGHT = 130.0
"""Height of a plot [pixels]."""


class Tab:
    """A tab beside one of Studio's windows, and in front of it when the application begins.

    Args:
        title: its title.
        beside: title of Studio's window.
        frames: number of frames for which it is brought to the front; of several tabs each must
            have its own, since the last one brought there wins.
    """

    def __init__(self, title: str, beside: str, frames: int) -> None:
        self._title, self._beside, self._first = title, beside, frames
        self._frames = 0

    def begin(self) -> None:
        """Begin the tab; `imgui.End` ends it."""
        imgui.Begin(self._beside)
        dock = imgui.GetWindowDockID()
        imgui.End()
        if dock:
            imgui.SetNextWindowDockID(dock, imgui.Cond.FirstUseEver)
            self._frames += 1
            if self._frames < self._first:
                imgui.SetNextWindowFocus()
        imgui.Begin(self._title)


def slide(name: str, limits: Range, value: float) -> float | None:
    """A slider; the value that it was moved to, or None.

    A value beyond its limits widens them.
    """
    least, most = min(limits.least, value), max(limits.most, value)
    digits = "%.0f" if limits.most >= 100.0 else "%.2f"
    unit = f" {limits.unit}" if limits.unit else ""
    imgui.SetNextItemWidth(0.62 * imgui.GetContentRegionAvail().x)
    moved, new = imgui.SliderFloat(f"{limits.label}##{name}", value, least, most, digits + unit)
    return min(max(float(new), least), most) if moved else None


def write_table(name: str, rows: Iterable[Sequence[str]], header: Sequence[str] = ()) -> None:
    """A table of texts, the first column as wide as it can be."""
    rows = list(rows)
    columns = len(header) if header else len(rows[0]) if rows else 0
    flags = int(imgui.TableFlags.RowBg) | int(imgui.TableFlags.SizingFixedFit)
    if not rows or not imgui.BeginTable(f"##{name}", columns, flags):
        return
    imgui.TableSetupColumn(header[0] if header else "", int(imgui.TableColumnFlags.WidthStretch))
    for title in header[1:] if header else [""] * (columns - 1):
        imgui.TableSetupColumn(title, int(imgui.TableColumnFlags.WidthFixed))
    if header:
        imgui.TableHeadersRow()
    for row in rows:
        imgui.TableNextRow()
        for cell in row:
            imgui.TableNextColumn()
            imgui.TextUnformatted(cell)
    imgui.EndTable()


def open_section(title: str, *, is_open: bool = True) -> bool:
    """A section that folds; whether it is open."""
    flags = int(imgui.TreeNodeFlags.DefaultOpen) if is_open else 0
    return bool(imgui.CollapsingHeader(title, flags))


def warn(sentences: Iterable[str]) -> None:
    """Sentences that somebody should read."""
    imgui.PushStyleColor(imgui.Col.Text, imgui.Vec4(*WARNING))
    for sentence in sentences:
        imgui.TextWrapped(sentence)
    imgui.PopStyleColor()


def plot_lines(
    title: str, unit: str, times: list[float], lines: Iterator[tuple[str, list[float]]]
) -> None:
    """A small plot of lines over time."""
    width = imgui.GetContentRegionAvail().x
    flags = int(implot.Flags.NoMouseText) | int(implot.Flags.NoMenus)
    if len(times) < 2 or not implot.BeginPlot(
        f"{title} [{unit}]", imgui.Vec2(width, PLOT_HEIGHT), flags
    ):
        return
    fit = int(implot.AxisFlags.AutoFit) | int(implot.AxisFlags.NoLabel)
    implot.SetupAxes("", "", fit, fit)
    for name, values in lines:
        implot.PlotLine(name, times, values)
    implot.EndPlot()
