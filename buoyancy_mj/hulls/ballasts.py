"""`Bladder`, `Tank` and `Compartment`: ballast that changes under way, and its texts in MJCF."""

import dataclasses
import math
from collections.abc import Mapping
from typing import ClassVar

from buoyancy_mj.errors import ModelError, choices, describe
from buoyancy_mj.values import read_text, read_truth, set_number

PLUGIN = "buoyancy_mj.ballast"
"""Name of the engine plugin."""
_MOST = 1e6
"""Greatest volume [m^3] and flow [m^3/s] that are taken for meant."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Bladder:
    """An oil bladder or a piston, which makes a geom displace more water than its own volume.

    The command is the volume that is wanted. Buoyancy grows where the geom is wet, by the volume of
    the bladder over that of the geom. Its oil has no mass of its own here.

    Raises:
        ModelError: a number that is not above 0.
    """

    kind: ClassVar[str] = "bladder"
    """Its word in MJCF."""
    capacity: float
    """Greatest volume [m^3]; the least is 0."""
    rate: float
    """Fastest change of the volume [m^3/s]."""

    def __post_init__(self) -> None:
        _set_volumes(self, "capacity", "rate")


@dataclasses.dataclass(frozen=True, kw_only=True)
class Tank:
    """A tank in the shape of a geom, which pumps fill with water and empty; it is dry at first.

    The command is the volume that is wanted. The water has weight and inertia.

    Raises:
        ModelError: a number that is not above 0.
    """

    kind: ClassVar[str] = "tank"
    """Its word in MJCF."""
    rate: float
    """Fastest change of the volume [m^3/s]."""
    capacity: float | None = None
    """Most that it holds [m^3]; None for the volume of its geom."""
    solid: bool = False
    """Whether a piston holds the water, which then fills the geom along z of the geom and stays
    where it is. Otherwise its surface stays level as the body turns."""

    def __post_init__(self) -> None:
        _set_volumes(self, "rate", *(["capacity"] if self.capacity is not None else []))
        object.__setattr__(self, "solid", read_truth(ModelError, "tank solid", self.solid))


@dataclasses.dataclass(frozen=True, kw_only=True)
class Compartment:
    """A compartment in the shape of a geom, with an opening through which it floods and drains.

    The flow is that of Torricelli, by the heads outside and inside. It needs no command.

    Raises:
        ModelError: an area that is not above 0, or a coefficient that is not above 0 and at most 1.
    """

    kind: ClassVar[str] = "compartment"
    """Its word in MJCF."""
    opening: str
    """Name of the site where the opening is."""
    area: float
    """Area of the opening [m^2]."""
    discharge: float = 0.6
    """Coefficient of discharge: 0.6 for a hole with sharp edges, 0.611 in theory (Kirchhoff 1869;
    Lamb, *Hydrodynamics*, sec. 75)."""
    capacity: float | None = None
    """Most that it holds [m^3]; None for the volume of its geom."""
    vent: bool = True
    """Whether air comes and goes freely elsewhere. Otherwise the air that is in it when it is empty
    stays, at constant temperature, as in a diving bell."""

    def __post_init__(self) -> None:
        read_text(ModelError, "compartment opening", self.opening)
        _set_volumes(self, "area", *(["capacity"] if self.capacity is not None else []))
        set_number(self, ModelError, "discharge", prefix="compartment ", above=0.0, most=1.0)
        object.__setattr__(self, "vent", read_truth(ModelError, "compartment vent", self.vent))


Ballasting = Bladder | Tank | Compartment
"""Ballast of any kind."""
KINDS: Mapping[str, type[Bladder] | type[Tank] | type[Compartment]] = {
    kind.kind: kind for kind in (Bladder, Tank, Compartment)
}
"""All kinds by their words."""
_OPENING = "opening"
"""A field that MJCF states as the site of the actuator."""
KEYS = (
    "kind",
    "geom",
    *dict.fromkeys(
        field.name
        for kind in KINDS.values()
        for field in dataclasses.fields(kind)
        if field.name != _OPENING
    ),
)
"""Keys of the configuration."""


def write_ballast(ballast: Ballasting, geom: str) -> dict[str, str]:
    """The texts of ballast in the shape of a geom, as `parse_ballast` reads them."""
    values = dataclasses.asdict(ballast)
    values.pop(_OPENING, None)
    texts = {
        key: str(value).lower() if isinstance(value, bool) else repr(value)
        for key, value in values.items()
        if value is not None
    }
    return {"kind": ballast.kind, "geom": geom, **texts}


def parse_ballast(texts: Mapping[str, str], site: str, what: str) -> Ballasting:
    """The ballast of texts by key; '' is a key that is not stated.

    Args:
        texts: of `KEYS`.
        site: name of the site of the actuator.
        what: how messages call the ballast.

    Raises:
        ModelError: no kind, a key that its kind does not have, or a value that makes no sense.
    """
    kind = KINDS.get(texts["kind"])
    if kind is None:
        raise ModelError(
            f"{what} is of the kind {describe(texts['kind'])}; {choices(texts['kind'], KINDS)}"
        )
    fields = {field.name: field for field in dataclasses.fields(kind)}
    values: dict[str, object] = {_OPENING: site} if _OPENING in fields else {}
    for key in KEYS[2:]:
        if not texts[key]:
            continue
        if key not in fields:
            possible = [name for name in fields if name != _OPENING]
            raise ModelError(
                f"{what}, a {kind.kind}, has the key '{key}'; {choices(key, possible)}"
            )
        is_truth = fields[key].type is bool
        values[key] = _parse_truth(texts[key]) if is_truth else _parse_number(texts[key])
    missing = [
        name
        for name, field in fields.items()
        if field.default is dataclasses.MISSING and name not in values
    ]
    if missing:
        raise ModelError(f"{what}, a {kind.kind}, has no {missing[0]}; state it, as a <config> key")
    try:
        return kind(**values)  # type: ignore[arg-type]
    except ModelError as error:
        raise ModelError(f"{what}: {error}") from None


def _set_volumes(ballast: Ballasting, *names: str) -> None:
    """Keep volumes, flows and areas as floats."""
    for name in names:
        prefix = f"{ballast.kind} "
        set_number(ballast, ModelError, name, prefix=prefix, above=0.0, most=_MOST)


def _parse_number(text: str) -> object:
    """The number of a text; the text itself if it is none."""
    try:
        number = float(text)
    except ValueError:
        return text
    return number if math.isfinite(number) else text


def _parse_truth(text: str) -> object:
    """The truth of a text; the text itself if it is none."""
    return {"true": True, "false": False}.get(text, text)
