"""The foils of a model, as its files state them, and as the kernels read them."""

import dataclasses
import functools
import math
from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import ModelError, choices
from buoyancy_mj.hulls.bodies import find_moving_bodies
from buoyancy_mj.hulls.custom import FOIL, FoilText, read_foil_texts
from buoyancy_mj.hulls.names import body_name, geom_kind
from buoyancy_mj.hulls.replicas import find_originals
from buoyancy_mj.hulls.scopes import Scope, explain_missing
from buoyancy_mj.kernels.arrays import empty
from buoyancy_mj.kernels.foils import Foils
from buoyancy_mj.kernels.polar import SLOPE, STALL
from buoyancy_mj.loads.foils import Foil, parse_foil

STRIPS = 8
"""Strips along the span of each foil."""
_BOX, _ELLIPSOID = int(mujoco.mjtGeom.mjGEOM_BOX), int(mujoco.mjtGeom.mjGEOM_ELLIPSOID)


@dataclasses.dataclass(frozen=True, eq=False)
class PlacedFoil:
    """A foil on a body of a model."""

    name: str
    """Name of its geom or site."""
    geom: int | None
    """Index of its geom; None for a site."""
    body: int
    """Index of the body it moves with: a body without a joint is part of its parent."""
    middle: NDArray[np.float64]
    """Its middle in the body's frame (3,) [m]."""
    body_from_foil: NDArray[np.float64]
    """Rotation (3, 3): x along the chord to the leading edge, y along the span, z the normal."""
    span: float
    """Span [m]."""
    chord: float
    """Longest chord [m]."""
    thickness: float
    """Thickness [m]."""
    foil: Foil
    """What it is like, as it is stated or as its geom or site has it."""
    elliptic: bool
    """Whether its outline is an ellipse, and not a rectangle."""

    @property
    def area(self) -> float:
        """Area of one side [m^2]."""
        share = 0.25 * math.pi if self.elliptic else 1.0
        return share * self.span * self.chord

    @property
    def aspect_ratio(self) -> float:
        """The aspect ratio that its lift has."""
        return self.foil.aspect_ratio(self.area / self.span)

    @property
    def lift_slope(self) -> float:
        """Lift coefficient per angle of attack [1/rad]."""
        return float(self.section[SLOPE])

    @property
    def stall(self) -> float:
        """Angle of attack at which it stalls [rad]."""
        return float(self.section[STALL])

    @functools.cached_property
    def section(self) -> NDArray[np.float64]:
        """Its row of `kernels.polar`."""
        return self.foil.section(self.area / self.span)

    @functools.cached_property
    def strips(self) -> NDArray[np.float64]:
        """Its strips (n, 3), see `kernels.foils.Foils`."""
        edges = np.linspace(-1.0, 1.0, STRIPS + 1)
        middles = 0.5 * (edges[1:] + edges[:-1])
        chords = np.full(STRIPS, self.chord)
        if self.elliptic:
            # the area under the ellipse, strip by strip
            under = 0.5 * (edges * np.sqrt(1.0 - edges**2) + np.arcsin(edges))
            chords *= np.diff(under) / np.diff(edges)
        widths = np.full(STRIPS, self.span / STRIPS)
        return np.column_stack([0.5 * self.span * middles, chords, widths])


def find_foils(
    model: mujoco.MjModel, bodies: Sequence[int] | None = None
) -> tuple[PlacedFoil, ...]:
    """Find the foils that the texts 'foil:NAME' of a model state, in the order of the texts.

    NAME is a geom or a site, a box or an ellipsoid: x along the chord towards the leading edge, y
    along the span, z along the normal.

    Args:
        model: any model.
        bodies: indices of the bodies on which the water acts; None for all.

    Raises:
        ModelError: a text that is none, or that names no geom or site of a body that moves, or one
            of another type, or one that another text names.
    """
    texts = read_foil_texts(model)
    if not texts:
        return ()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    targets = _list_targets(model)
    copies = find_originals(targets)
    found: dict[str, tuple[FoilText, PlacedFoil]] = {}
    # a text for one copy wins over the one for all copies
    for text in sorted(texts, key=lambda one: one.target in targets):
        names = [name for name in targets if text.target in copies.get(name, ())]
        if text.target in targets:
            names = [text.target]
            _check_single(text, found.get(text.target))
        if not names:
            raise _refuse_missing(model, text, targets)
        foil = parse_foil(text.text, f"the text '{text.name}'")
        for name in names:
            found[name] = (text, _place(model, data, text, name, targets[name], foil))
    placed = (foil for _, foil in found.values())
    return tuple(foil for foil in placed if bodies is None or foil.body in bodies)


def gather_foils(foils: Sequence[PlacedFoil]) -> Foils:
    """The foils as kernels read them."""
    if not foils:
        return empty(Foils)
    return Foils(
        bodies=np.array([foil.body for foil in foils], np.int64),
        middles=np.stack([foil.middle for foil in foils]),
        turns=np.stack([foil.body_from_foil.ravel() for foil in foils]),
        sizes=np.array([(foil.span, foil.chord, foil.thickness) for foil in foils]),
        sections=np.stack([foil.section for foil in foils]),
        strips=np.vstack([foil.strips for foil in foils]),
        starts=np.cumsum([0, *(len(foil.strips) for foil in foils)]),
    )


def _list_targets(model: mujoco.MjModel) -> dict[str, list[tuple[str, int]]]:
    """The geoms and sites of each name, as ('geom', index) or ('site', index)."""
    targets: dict[str, list[tuple[str, int]]] = {}
    for kind, get, count in (("geom", model.geom, model.ngeom), ("site", model.site, model.nsite)):
        for index in range(count):
            if name := str(get(index).name):
                targets.setdefault(name, []).append((kind, index))
    return targets


def _check_single(text: FoilText, other: tuple[FoilText, PlacedFoil] | None) -> None:
    """Refuse a foil that two texts state; one for all copies may stand beside it."""
    if other is not None and other[0].target == text.target:
        raise ModelError(
            f"'{other[0].name}' and '{text.name}' both make '{text.target}' a foil; "
            "remove one of them"
        )


def _refuse_missing(
    model: mujoco.MjModel, text: FoilText, targets: dict[str, list[tuple[str, int]]]
) -> ModelError:
    """The error of a text that names nothing."""
    moving = find_moving_bodies(model)
    owners = {"geom": model.geom_bodyid, "site": model.site_bodyid}
    types = {"geom": model.geom_type, "site": model.site_type}
    possible = [
        name
        for name, places in targets.items()
        for kind, i in places
        if moving[owners[kind][i]] and types[kind][i] in (_BOX, _ELLIPSOID)
    ]
    scope = Scope(text.name.partition(f"{FOIL}:")[0])
    return ModelError(
        f"'{text.name}' is for the geom or site '{text.target}', which the model does not have; "
        f"{choices(text.target, possible)}{explain_missing(scope)}"
    )


def _place(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    text: FoilText,
    name: str,
    places: Sequence[tuple[str, int]],
    foil: Foil,
) -> PlacedFoil:
    """The foil that a text makes of a geom or a site."""
    if len(places) > 1:
        raise ModelError(
            f"'{text.name}' may be for the geom '{name}' and for the site; rename one of them"
        )
    (what, index) = places[0]
    if what == "geom":
        kind, owner, size = model.geom_type[index], model.geom_bodyid[index], model.geom_size[index]
        position, turn, shape = (
            data.geom_xpos[index],
            data.geom_xmat[index],
            geom_kind(model, index),
        )
    else:
        kind, owner, size = model.site_type[index], model.site_bodyid[index], model.site_size[index]
        position, turn = data.site_xpos[index], data.site_xmat[index]
        shape = str(mujoco.mjtGeom(int(kind)).name).removeprefix("mjGEOM_").lower()
    if kind not in (_BOX, _ELLIPSOID):
        raise ModelError(
            f"'{text.name}' is for the {what} '{name}', a {shape}; make it a box or an ellipsoid, "
            "x along the chord, y along the span, z along the normal, or give the body such a site"
        )
    if not find_moving_bodies(model)[owner]:
        raise ModelError(
            f"'{text.name}' is for the {what} '{name}' of body '{body_name(model, int(owner))}', "
            "which cannot move; give it a joint, or remove the text"
        )

    # its size, where the text does not state it, and its place in the body that moves
    chord = foil.chord or 2.0 * float(size[0])
    thickness = min(float(size[2]) * 2.0 / chord, 0.5) if foil.thickness is None else foil.thickness
    span = foil.span or 2.0 * float(size[1])
    body = int(model.body_weldid[owner])
    body_from_world = data.xmat[body].reshape(3, 3).T
    return PlacedFoil(
        name=name,
        geom=index if what == "geom" else None,
        body=body,
        middle=body_from_world @ (position - data.xpos[body]),
        body_from_foil=body_from_world @ turn.reshape(3, 3),
        span=span,
        chord=chord,
        thickness=thickness * chord,
        foil=dataclasses.replace(foil, chord=chord, span=span, thickness=thickness),
        elliptic=kind == _ELLIPSOID,
    )
