"""What each tab of a recording plots: lines of one unit together, small forces apart from large."""

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple, TypeVar

from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.vehicle.instruments.instruments import Channel
from buoyancy_mj.viz import instruments, plots

MOTION, VOLUME, INSTRUMENTS = "Motion and forces", "Volume and energy", "Sensors and controls"
"""Names of the tabs."""
MOST_LINES = 8
"""Most lines of one plot, so that its legend has room for all names."""
MOST_PLOTS = 8
"""Most plots of instruments in one tab."""
SMALLER = 0.1
"""Size of a line over the largest of its plot, below which it has another plot."""
FORCES = ("forces [N]", "smaller forces [N]", "smallest forces [N]")
ANGLES = ("attitude [degrees]", "smaller angles [degrees]")
"""Titles of the plots of forces and of angles, by size."""

T = TypeVar("T")
Extents = Mapping[str, tuple[float, float]]
"""Least and greatest value of each line, by its entity; empty before the end of a run."""


class Plot(NamedTuple):
    """Lines that share an axis."""

    title: str
    """What it shows, with the unit."""
    entities: tuple[str, ...]
    """The lines."""


class Tab(NamedTuple):
    """Plots that are seen together."""

    name: str
    """What the tab is called."""
    plots: tuple[Plot, ...]
    """The plots, from top to bottom."""


def list_vehicle_tabs(
    vehicle: Vehicle, name: str, causes: Sequence[str], extents: Extents
) -> Iterator[Tab]:
    """The tabs of a vehicle.

    Args:
        vehicle: the vehicle.
        name: what tells it from others; '' for the only one.
        causes: names of the loads that act.
        extents: what the lines reach, where that is known.
    """

    def plot(title: str, *lines: plots.Line) -> Plot:
        """A plot of lines of the vehicle."""
        return Plot(title, tuple(plots.entity(line, name) for line in lines))

    angles = [plots.entity(("attitude", axis), name) for axis in ("roll", "pitch", "yaw")]
    forces = [plots.entity(("force", cause), name) for cause in ("weight", *causes)]
    yield Tab(
        MOTION,
        (
            plot("height [m]", ("height", "centre_of_gravity"), ("height", "surface")),
            *_group_by_size(ANGLES, [angles], extents),
            *_group_by_size(FORCES, [forces[:2], forces[2:]], extents),
        ),
    )

    # the largest hulls
    hulls = sorted(vehicle.hulls, key=lambda hull: -hull.mesh.volume)[: MOST_LINES - 1]
    few = (
        "" if len(hulls) == len(vehicle.hulls) else f", {len(hulls)} of {len(vehicle.hulls)} hulls"
    )
    yield Tab(
        VOLUME,
        (
            plot(
                f"submerged volume{few} [l]",
                ("volume", "total"),
                *(("volume", "hulls", hull.name) for hull in hulls),
            ),
            plot(
                "energy [J]",
                *(("energy", kind) for kind in ("kinetic", "potential", "buoyancy", "total")),
            ),
        ),
    )


def list_instrument_tabs(channels: Sequence[Channel]) -> Iterator[Tab]:
    """The tabs of sensors and controls: a plot for each kind and unit; none without channels."""
    several = [
        Plot(f"{title} ({part} of {len(parts)})" if len(parts) > 1 else title, lines)
        for title, entities in instruments.list_plots(channels).items()
        for parts in [_split(entities, MOST_LINES)]
        for part, lines in enumerate(parts, 1)
    ]
    for number, some in enumerate(_split(several, MOST_PLOTS), 1):
        yield Tab(INSTRUMENTS if number == 1 else f"{INSTRUMENTS} {number}", some)


def _group_by_size(
    titles: Sequence[str], groups: Sequence[Sequence[str]], extents: Extents
) -> Iterator[Plot]:
    """Plots of lines of one unit by the size of their values, the largest first.

    Args:
        titles: titles of the plots, of which there are no more.
        groups: the lines, as they are grouped before their sizes are known.
        extents: what the lines reach, where that is known.
    """
    lines = [line for group in groups for line in group]
    sizes = {line: max(map(abs, extents[line])) for line in lines if line in extents}
    parts = [list(group) for group in groups]
    if sizes:
        parts, top = [], 0.0
        for line in sorted(lines, key=lambda one: -sizes.get(one, 0.0)):
            size = sizes.get(line, 0.0)
            if not parts or (size < SMALLER * top and len(parts) < len(titles)):
                parts.append([])
                top = size
            parts[-1].append(line)
    for title, group in zip(titles, filter(None, parts), strict=False):
        yield Plot(title, tuple(group))


def _split(items: Sequence[T], most: int) -> list[tuple[T, ...]]:
    """Split a sequence into parts as equal as can be, of at most so many items."""
    count = -(-len(items) // most)
    return [
        tuple(items[len(items) * i // count : len(items) * (i + 1) // count]) for i in range(count)
    ]
