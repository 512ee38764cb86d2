"""`Selection`: which geoms of a model displace water, and as what, as the user chooses it."""

import dataclasses
from collections.abc import Mapping, Sequence

CUSTOM_TEXTS: Mapping[str, str] = {
    "geoms": "buoyancy_geoms",
    "hull": "buoyancy_hull",
    "fill": "buoyancy_fill",
}
"""MJCF `<custom><text>` by which a vehicle chooses for itself, by the field of `Selection`."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Selection:
    """Which geoms of a model displace water, and as what.

    A pattern is a name glob such as 'hull*', or 'group:2'. Each field takes one text or several.
    None leaves the choice to the model: to its `<custom>` texts 'buoyancy_geoms', 'buoyancy_hull'
    and 'buoyancy_fill', or to the defaults.

    Example:
        `Selection(geoms=["hull*", "pod"], fill="frame=0.1")`
    """

    geoms: str | Sequence[str] | None = None
    """Which geoms displace water: patterns. By default the collision geoms of each body, or its
    visual ones if it has none."""
    hull: str | Sequence[str] | None = None
    """Which of them displace as their convex hull: 'PATTERN=convex', or 'convex' for all."""
    fill: str | Sequence[str] | None = None
    """Which of them flood, and the part of their volume that displaces: 'PATTERN=0.1'."""

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            if value is not None:
                words = (value,) if isinstance(value, str) else tuple(map(str, value))
                object.__setattr__(self, field.name, words)
