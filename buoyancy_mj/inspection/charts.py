"""Pictures of an `Inspection`: righting arms, volume and waterplane against draft, and waterlines."""

from collections.abc import Iterator
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from buoyancy_mj.inspection.inspection import Inspection, VesselInspection
from buoyancy_mj.statics.curves import compute_hydrostatic_curves, compute_waterline
from buoyancy_mj.statics.vessel import Vessel


def draw_charts(found: Inspection, folder: Path) -> list[tuple[str, Path]]:
    """Draw all that floats, as PNG files in a folder; what each shows, and where it is."""
    files = []
    with matplotlib.rc_context({"axes.grid": True, "grid.alpha": 0.3, "font.size": 9}):
        for floating in found.vessels:
            name = floating.total.body
            stem = name.replace("/", "-").replace(" ", "_")
            for kind, caption, figure in _figures(floating):
                path = folder / f"{stem}_{kind}.png"
                figure.savefig(path, dpi=150)
                files.append((f"{caption} of '{name}'", path))
    return files


def _figures(floating: VesselInspection) -> Iterator[tuple[str, str, Figure]]:
    """What can be drawn."""
    rotation = floating.at_rest.rotation
    draft = None if floating.rest is None else floating.rest.hydrostatics.draft
    yield (
        "curves",
        "Volume and waterplane area against draft",
        _curves(floating.vessel, rotation, draft),
    )
    yield "waterlines", "Waterlines", _waterlines(floating.vessel, rotation, draft)
    if floating.righting is not None:
        yield "gz", "Righting arm", _gz(floating)


def _curves(vessel: Vessel, rotation: NDArray[np.float64], draft: float | None) -> Figure:
    curves = compute_hydrostatic_curves(vessel, rotation)
    figure = Figure(figsize=(6.0, 4.0), layout="constrained")
    axes = figure.subplots()
    axes.plot(1e3 * curves.volume, curves.draft, color="C0")
    axes.set_xlabel("volume [l]", color="C0")
    axes.set_ylabel("draft [m]")
    beside = axes.twiny()
    beside.grid(visible=False)
    beside.plot(curves.waterplane_area, curves.draft, color="C1")
    beside.set_xlabel("waterplane area [m^2]", color="C1")
    if draft is not None:
        axes.axhline(draft, color="0.3", linestyle="--", linewidth=1.0)
    wanted = 1e3 * vessel.mass / vessel.water.density
    axes.axvline(wanted, color="C0", linestyle=":", linewidth=1.0)
    return figure


def _waterlines(vessel: Vessel, rotation: NDArray[np.float64], draft: float | None) -> Figure:
    heights = vessel.points @ rotation[2]
    tall = float(np.ptp(heights))
    figure = Figure(figsize=(6.0, 4.0), layout="constrained")
    axes = figure.subplots()
    levels = [(part * tall, 0.8) for part in np.linspace(0.1, 0.9, 9)]
    colours = matplotlib.colormaps["viridis"]
    for level, width in levels:
        for segment in compute_waterline(vessel, rotation, level):
            axes.plot(*segment.T, color=colours(level / tall), linewidth=width)
    if draft is not None and 0.0 < draft < tall:
        for segment in compute_waterline(vessel, rotation, draft):
            axes.plot(*segment.T, color="C3", linewidth=1.8)
    axes.set_aspect("equal")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    axes.set_title(
        "waterlines at a tenth to nine tenths of the height"
        + ("" if draft is None else "; at rest in red")
    )
    return figure


def _gz(floating: VesselInspection) -> Figure:
    arm = floating.righting
    assert arm is not None
    figure = Figure(figsize=(6.0, 4.0), layout="constrained")
    axes = figure.subplots()
    degrees = np.degrees(arm.heel)
    axes.plot(degrees, arm.gz, color="C0")
    axes.axhline(0.0, color="0.3", linewidth=0.8)
    assert floating.rest is not None
    slope = floating.rest.hydrostatics.GMt
    axes.plot(
        [0.0, 57.2958],
        [0.0, slope],
        color="0.5",
        linestyle=":",
        linewidth=1.0,
        label=f"GM {slope:.3g} m",
    )
    axes.set_ylim(*_padded(arm.gz))
    if np.isfinite(arm.vanishing):
        axes.axvline(
            np.degrees(arm.vanishing),
            color="C3",
            linestyle="--",
            linewidth=1.0,
            label="vanishing stability",
        )
    for i, (name, at) in enumerate((n, a) for n, a in arm.immersed.items() if np.isfinite(a)):
        axes.axvline(
            np.degrees(at),
            color=f"C{4 + i % 5}",
            linestyle="-.",
            linewidth=1.0,
            label=f"{name} under",
        )
    axes.set_xlabel("heel [degrees]")
    axes.set_ylabel("righting arm GZ [m]")
    axes.legend()
    return figure


def _padded(values: NDArray[np.float64]) -> tuple[float, float]:
    low, high = min(0.0, float(values.min())), max(0.0, float(values.max()))
    margin = 0.08 * (high - low) + 1e-9
    return low - margin, high + margin
