"""Charts of an `Inspection`: righting arm, volume and waterplane over draft, waterlines."""

import math
from collections.abc import Iterator
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator
from numpy.typing import NDArray

from buoyancy_mj.files import require_own
from buoyancy_mj.inspection.inspection import Inspection
from buoyancy_mj.inspection.vessels import VesselInspection
from buoyancy_mj.plotting.style import (
    BLUE,
    FAINT,
    SOFTWARE,
    VERMILLION,
    new_figure,
    save_figure,
    use_style,
)
from buoyancy_mj.statics.curves import compute_hydrostatic_curves, compute_waterline
from buoyancy_mj.statics.hydrostatics import Hydrostatics
from buoyancy_mj.statics.righting import RightingArm
from buoyancy_mj.statics.vessel import Vessel


def draw_charts(inspection: Inspection, folder: Path) -> list[tuple[str, Path]]:
    """Draw charts of vessels as PNG files in a folder; return each caption and its file.

    A vessel with a hull whose mesh is refused has none.

    Raises:
        OSError: a file cannot be written, or there is one that was not made here.
    """
    files = []
    with use_style():
        for vessel in inspection.vessels:
            if vessel.refused:
                continue
            name = vessel.total.body
            stem = name.replace("/", "-").replace(" ", "_")
            for kind, caption, figure in _draw_figures(vessel):
                path = folder / f"{stem}_{kind}.png"
                require_own(path, SOFTWARE)
                save_figure(figure, path)
                files.append((f"{caption} of '{name}'", path))
    return files


def _draw_figures(inspection: VesselInspection) -> Iterator[tuple[str, str, Figure]]:
    """Kind, caption and figure of each chart of a vessel."""
    vessel, rotation = inspection.vessel, inspection.at_rest.rotation
    at = None if inspection.rest is None else inspection.rest.hydrostatics
    draft = None if at is None else at.draft

    caption = "Volume and waterplane area against draft"
    yield "curves", caption, _draw_curves(vessel, rotation, draft)
    yield "waterlines", "Waterlines", _draw_waterlines(vessel, rotation, draft)
    if inspection.righting is not None and at is not None:
        yield "gz", "Righting arm", _draw_righting(inspection.righting, at)


def _start_figure() -> tuple[Figure, Axes]:
    """An empty figure with axes."""
    figure = new_figure(7.0, 4.4)
    return figure, figure.subplots()


def _draw_curves(vessel: Vessel, rotation: NDArray[np.float64], draft: float | None) -> Figure:
    """Volume and waterplane area over draft, with the draft at rest and the volume that floats."""
    curves = compute_hydrostatic_curves(vessel, rotation)
    figure, axes = _start_figure()
    axes.plot(1e3 * curves.volume, curves.draft, color=BLUE)
    axes.set_xlabel("volume [l]", color=BLUE)
    axes.set_ylabel("draft [m]")

    beside = axes.twiny()
    beside.spines.top.set_visible(True)
    beside.grid(visible=False)
    beside.plot(curves.waterplane_area, curves.draft, color=VERMILLION)
    beside.set_xlabel("waterplane area [m^2]", color=VERMILLION)

    if draft is not None:
        axes.axhline(draft, color=FAINT, linestyle="--", linewidth=1.0)
    floats = 1e3 * vessel.mass / vessel.water.density
    axes.axvline(floats, color=BLUE, linestyle=":", linewidth=1.0)
    return figure


def _draw_waterlines(vessel: Vessel, rotation: NDArray[np.float64], draft: float | None) -> Figure:
    """Waterlines at nine drafts, and at the draft at rest."""
    low, high = vessel.heights(rotation)
    tall = high - low
    figure, axes = _start_figure()
    colours = matplotlib.colormaps["cividis"]
    for part in np.linspace(0.1, 0.9, 9):
        for segment in compute_waterline(vessel, rotation, part * tall):
            axes.plot(*segment.T, color=colours(part), linewidth=0.8)
    if draft is not None and 0.0 < draft < tall:
        for segment in compute_waterline(vessel, rotation, draft):
            axes.plot(*segment.T, color=VERMILLION, linewidth=1.8)

    axes.set_aspect("equal")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    title = "waterlines at a tenth to nine tenths of the height"
    axes.set_title(title if draft is None else f"{title}; bold at rest")
    return figure


def _draw_righting(arm: RightingArm, at: Hydrostatics) -> Figure:
    """The GZ curve, its slope GM at rest, where it vanishes and where sites go under."""
    figure, axes = _start_figure()
    axes.plot(np.degrees(arm.heel), arm.gz, color=BLUE)
    axes.axhline(0.0, color=FAINT, linewidth=0.8)
    axes.set_ylim(*_pad(arm.gz))

    # the tangent at rest reaches GM at a heel of 1 rad
    label = f"GM {at.GMt:.3g} m"
    axes.plot(
        [0.0, math.degrees(1.0)],
        [0.0, at.GMt],
        color=FAINT,
        linestyle=":",
        linewidth=1.0,
        label=label,
    )

    if math.isfinite(arm.vanishing):
        label = f"vanishing stability, {math.degrees(arm.vanishing):.1f}°"
        _mark_heel(axes, arm.vanishing, label, color=VERMILLION, linestyle="--")
    immersed = {name: heel for name, heel in arm.immersed.items() if math.isfinite(heel)}
    for i, (name, heel) in enumerate(immersed.items()):
        _mark_heel(axes, heel, f"{name} under", color=f"C{2 + i % 4}", linestyle="-.")

    axes.xaxis.set_major_locator(MultipleLocator(30.0))
    axes.set_xlabel("heel [degrees]")
    axes.set_ylabel("righting arm GZ [m]")
    axes.legend()
    return figure


def _mark_heel(axes: Axes, heel: float, label: str, *, color: str, linestyle: str) -> None:
    """Mark a heel [rad] by an upright line."""
    axes.axvline(math.degrees(heel), color=color, linestyle=linestyle, linewidth=1.0, label=label)


def _pad(values: NDArray[np.float64]) -> tuple[float, float]:
    """Limits of an axis that shows values and zero, with a margin."""
    low = min(0.0, float(values.min()))
    high = max(0.0, float(values.max()))
    margin = 0.08 * (high - low) + 1e-9
    return low - margin, high + margin
