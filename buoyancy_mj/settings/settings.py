"""`Settings`: all options of the water, with their defaults."""

import dataclasses
from collections.abc import Mapping
from typing import Any, TypedDict

from numpy.typing import ArrayLike

from buoyancy_mj.errors import MethodError, ModelError, WaterError, choices, describe
from buoyancy_mj.hulls.selection import Selection
from buoyancy_mj.loads.added_mass import check_source
from buoyancy_mj.loads.damping import Damping, Panels
from buoyancy_mj.sea.water import Water
from buoyancy_mj.submersion.exact import Exact
from buoyancy_mj.submersion.methods import Method, parse_method
from buoyancy_mj.values import read_truth, read_whole_number

PRESSURES = ("archimedes", "hydrostatic", "froude-krylov")
"""Models of the pressure in waves."""
MOST_THREADS = 64
"""Threads that share one pass at most: the caller and `kernels.entries.crews.MOST` helpers."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Settings:
    """The water of a model, and every option of how it acts.

    `Buoyancy` and `add_water` take these fields as keyword arguments, or a `Settings` in the place
    of the water. A scene has them beside its vehicle, and the plugin keeps them as texts.

    Raises:
        WaterError, ModelError: a water, a damping, an added mass or a selection of another kind.
        MethodError: an unknown method or pressure; or a pressure, or damping, that needs another
            method.

    Example:
        `Settings(water=Water(density=1025.0), pressure="froude-krylov")`
    """

    water: Water = Water()
    """The sea."""
    method: Method = Exact()
    """The method that finds the submerged part of hulls: `Exact`, or the source paper's
    `ConvexHull` or `Sections`; or the name 'exact', 'convex_hull' or 'sections'."""
    pressure: str = "archimedes"
    """The model of wave pressure. 'archimedes' is rho g V upward, as in the source paper.
    'hydrostatic' is the pressure of the depth under the surface, which pushes along the slope too.
    'froude-krylov' is the pressure of linear waves, which fades with depth, see
    `kernels.waves.head`."""
    damping: Damping | None = Damping()
    """How the water slows bodies down; None for no damping."""
    added_mass: str | Mapping[str, ArrayLike] | None = "model"
    """Where added mass comes from. 'model' takes the numerics 'added_mass:BODY' of 6 or 36 numbers
    from the model's `<custom>`. For bodies without, 'mesh' adds that of potential flow around their
    meshes, 'ellipsoid' that of an ellipsoid like them, and 'estimate' takes 'mesh' where that can
    be trusted and 'ellipsoid' elsewhere. 'none' leaves it out. Matrices (6, 6) or diagonals (6,)
    by the name of the body replace all these."""
    slamming: bool = False
    """Whether the water keeps the momentum that added mass takes as a body enters. Without it half
    of that is given back at once, and energy is kept."""
    selection: Selection = Selection()
    """Which geoms displace water, and as what."""
    threads: int = 1
    """How many threads share the hulls and bodies of one pass, where the water acts as compiled
    code: for one model of many vessels. The results have the same bits for any number. The process
    has one crew of helpers: while they help one of several data, the others do without."""

    def __post_init__(self) -> None:
        # kinds of values
        if not isinstance(self.water, Water):
            raise WaterError(
                f"water is {describe(self.water)}; it must be a Water, as Water(waves=...)"
            )
        if not isinstance(self.damping, Damping | None):
            raise ModelError(
                f"damping is {describe(self.damping)}; "
                "it must be Damping(viscous=..., radiation=...) or None"
            )
        if not isinstance(self.selection, Selection):
            raise ModelError(
                f"selection is {describe(self.selection)}; "
                "it must be Selection(geoms=..., hull=..., fill=...)"
            )
        check_source(self.added_mass)
        self._check_slamming()
        threads = read_whole_number(ModelError, "threads", self.threads, least=1, most=MOST_THREADS)
        object.__setattr__(self, "threads", threads)

        # names
        object.__setattr__(self, "method", parse_method(self.method))
        if self.pressure not in PRESSURES:
            raise MethodError(
                f"pressure is {describe(self.pressure)}; {choices(self.pressure, PRESSURES)}"
            )

        # the other methods know neither pressure nor waterplane nor triangles
        if isinstance(self.method, Exact):
            return
        if self.pressure != "archimedes":
            raise MethodError(
                f"pressure '{self.pressure}' needs the method 'exact', not '{self.method.name}', "
                "which knows volumes alone"
            )
        if self.threads > 1:
            raise MethodError(
                f"threads is {self.threads}, and hulls are shared by the method 'exact' alone, not "
                f"by '{self.method.name}'; leave threads out"
            )
        if self.slamming:
            raise MethodError(
                f"slamming needs the method 'exact', not '{self.method.name}', "
                "which knows no waterplane"
            )
        if self.damping is not None and isinstance(self.damping.viscous, Panels):
            raise MethodError(
                f"drag by panels needs the method 'exact', not '{self.method.name}', "
                "which knows no triangles"
            )

    def _check_slamming(self) -> None:
        """Refuse slamming that is no truth value, or that no added mass could bring."""
        object.__setattr__(self, "slamming", read_truth(ModelError, "slamming", self.slamming))
        if self.slamming and (self.added_mass is None or self.added_mass == "none"):
            raise ModelError(
                f"slamming is true and added_mass is {describe(self.added_mass)}; slamming is what "
                "added mass does in an entry: state or estimate it, or leave slamming out"
            )


class Options(TypedDict, total=False):
    """The fields of `Settings` but for the water, as the types of keyword arguments."""

    method: str | Method
    pressure: str
    damping: Damping | None
    added_mass: str | Mapping[str, ArrayLike] | None
    slamming: bool
    selection: Selection
    threads: int


def combine_settings(water: Water | Settings | None, options: Options) -> Settings:
    """The settings of a water, fresh and still if None; or settings with options laid over them.

    Raises:
        TypeError: there is no such option.
        ModelError, MethodError: see `Settings`.
    """
    known = Options.__annotations__
    for name in options:
        if name not in known:
            raise TypeError(f"there is no option '{name}'; {choices(name, known)}")
    values: dict[str, Any] = dict(options)
    if isinstance(water, Settings):
        return dataclasses.replace(water, **values)
    return Settings(water=Water() if water is None else water, **values)
