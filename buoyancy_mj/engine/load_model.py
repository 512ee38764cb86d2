"""`LoadModel`: all that acts on the bodies of a model, resolved to arrays."""

import dataclasses
import functools
from collections.abc import Callable, Sequence

import mujoco
import numpy as np

from buoyancy_mj.errors import MethodError
from buoyancy_mj.hulls.geoms import find_hulls
from buoyancy_mj.hulls.hull import Hull
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.hulls.placed_ballasts import PlacedBallast, find_ballasts
from buoyancy_mj.kernels import clip, passes
from buoyancy_mj.kernels.arrays import conform, empty
from buoyancy_mj.kernels.damping import DampingArrays
from buoyancy_mj.kernels.flooding import BLADDER
from buoyancy_mj.kernels.hulls import Hulls
from buoyancy_mj.kernels.passes import IDS, Causes, LoadArrays, Record
from buoyancy_mj.kernels.scratch import Scratch
from buoyancy_mj.kernels.sea import PressureModel
from buoyancy_mj.loads.added_mass import resolve_added_mass
from buoyancy_mj.loads.ballast_arrays import check_ballast, gather_ballast
from buoyancy_mj.loads.damping_arrays import resolve_damping
from buoyancy_mj.loads.foil_arrays import PlacedFoil, find_foils, gather_foils
from buoyancy_mj.settings.settings import Settings
from buoyancy_mj.submersion.exact import PackedHulls, sea_arrays
from buoyancy_mj.submersion.hull_set import HullSet
from buoyancy_mj.submersion.methods import Packed

CAUSES = Causes._fields
"""Names of all loads that there are."""


@dataclasses.dataclass(frozen=True, eq=False)
class LoadModel:
    """What the water does to the bodies of one model, whose geoms have the sizes of now."""

    hulls: tuple[Hull, ...]
    """The hulls, in the order of the model's geoms."""
    sizes: bytes
    """The sizes of the model's geoms, from which the hulls were measured."""
    packed: Packed
    """The hulls, ready to be submerged."""
    arrays: LoadArrays
    """All that acts, as kernels read it."""

    @functools.cached_property
    def causes(self) -> tuple[str, ...]:
        """Names of the loads that act."""
        damping = self.arrays.damping
        acts = {
            "wave_pressure": self.arrays.sea.pressure != PressureModel.archimedes,
            "drag": len(damping.bodies) > 0,
            "radiation": damping.radiates,
            "foil": len(self.arrays.foils.bodies) > 0,
            "added_mass": len(self.arrays.added_mass.bodies) > 0,
            "slamming": self.arrays.added_mass.slamming != 0,
            "ballast": len(self.arrays.ballast.bodies) > 0,
        }
        return tuple(cause for cause in CAUSES if acts.get(cause, True))

    @functools.cached_property
    def acting(self) -> tuple[Callable[..., None], ...]:
        """Those of `kernels.passes.LOADS` that act."""
        acts = {
            passes.press_hulls: self.has_wave_pressure,
            passes.add_wave_pressure: self.has_wave_pressure,
            passes.add_drag: "drag" in self.causes,
            passes.add_panel_drag: len(self.arrays.damping.panels) > 0,
            passes.add_radiation: "radiation" in self.causes,
            passes.add_foils: "foil" in self.causes,
            passes.add_reaction: "added_mass" in self.causes,
            passes.add_ballast: "ballast" in self.causes,
        }
        return tuple(load for load in passes.LOADS if acts.get(load, True))

    @functools.cached_property
    def augments(self) -> bool:
        """Whether the mass matrix gets added mass, or the water of tanks."""
        return "added_mass" in self.causes or bool((self.arrays.ballast.kinds != BLADDER).any())

    @functools.cached_property
    def has_wave_pressure(self) -> bool:
        """Whether the pressure differs from Archimedes': on still water it does not."""
        return "wave_pressure" in self.causes and self.arrays.sea.waves.shape[1] > 0

    @functools.cached_property
    def scratch(self) -> Scratch:
        """Arrays to work in, for Python."""
        return self.new_scratches(1)[0]

    def new_scratches(self, count: int) -> list[Scratch]:
        """Arrays to work in, for so many threads."""
        if isinstance(self.packed, PackedHulls):
            return self.packed.new_scratches(count)
        return [empty(Scratch)] * count

    def record(self, bodies: int, inertias: int) -> Record:
        """Room for what one pass leaves.

        Args:
            bodies: how many the model has.
            inertias: elements of its mass matrix.
        """
        hulls = len(self.packed.volumes)
        return Record(
            wet=np.zeros((hulls, clip.COLUMNS)),
            centres=np.zeros((bodies, 4)),
            heads=np.zeros((hulls, 6)),
            causes=Causes(
                *(np.zeros((bodies if cause in self.causes else 0, 6)) for cause in CAUSES)
            ),
            total=np.zeros((bodies, 6)),
            inertia=np.zeros(inertias if self.augments else 0),
            instant=np.zeros(1),
            xipos=np.zeros((bodies, 3)),
            ids=np.zeros(IDS, np.int64),
        )


def build_load_model(
    model: mujoco.MjModel, settings: Settings, bodies: Sequence[int] | None
) -> LoadModel:
    """Measure the hulls of a model as its geoms are now, and find what acts on them.

    Args:
        model: the model.
        settings: the water, and how it acts.
        bodies: indices of the bodies whose geoms may displace; None for all.

    Raises:
        ModelError, MeshError, MethodError: see `Buoyancy`.
    """
    # the hulls
    water, damping = settings.water, settings.damping
    sizes = model.geom_size.tobytes()
    hulls = find_hulls(model, settings.selection, bodies)
    owners = np.array([hull.body for hull in hulls])
    placed = find_ballasts(model, bodies)
    check_ballast(model, placed, hulls)
    rows = _find_rows(placed, hulls)
    bladders = [one for one in placed if rows.get(one.name, -1) >= len(hulls)]
    packed = settings.method.pack(_list_hulls(hulls, bladders), water)
    pressure = PressureModel[settings.pressure.replace("-", "_")]
    if pressure != PressureModel.archimedes and isinstance(packed, PackedHulls):
        packed.find_rules()

    # what acts on them
    foils = find_foils(model, bodies)
    arrays = LoadArrays(
        hulls=packed.hulls if isinstance(packed, PackedHulls) else empty(Hulls),
        owners=owners,
        bodies=np.unique([*owners, *(foil.body for foil in foils), *(one.body for one in placed)]),
        sea=sea_arrays(water, pressure),
        damping=resolve_damping(
            damping,
            model,
            hulls,
            water.density,
            packed.hulls if isinstance(packed, PackedHulls) else None,
            _leave_out_foils(model, settings, bodies, foils),
        )
        if damping
        else empty(DampingArrays),
        foils=gather_foils(foils),
        added_mass=resolve_added_mass(
            model, hulls, water.density, settings.added_mass, foils, slamming=settings.slamming
        ),
        ballast=gather_ballast(placed, rows),
    )
    if arrays.damping.radiates and not isinstance(packed, PackedHulls):
        radiating = arrays.damping.bodies[arrays.damping.radiation.any(axis=1)]
        name = body_name(model, int(radiating[0]))
        raise MethodError(
            f"the radiation damping of body '{name}' needs the method 'exact', not "
            f"'{settings.method.name}', which knows no waterplane; leave it out, "
            "Damping(radiation=False), in a scene damping.radiation = false"
        )
    return LoadModel(hulls, sizes, packed, conform(arrays))


def _find_rows(placed: Sequence[PlacedBallast], hulls: Sequence[Hull]) -> dict[str, int]:
    """The row of each bladder's geom in `Record.wet`, by its name.

    It is that of a hull which is that geom alone, or one behind the hulls.
    """
    alone = {
        hull.geoms[0]: (row, hull.mesh.volume)
        for row, hull in enumerate(hulls)
        if len(hull.geoms) == 1 and hull.fill == 1.0
    }
    rows: dict[str, int] = {}
    end = len(hulls)
    for one in placed:
        if one.holds_water:
            continue
        row, volume = alone.get(one.geom, (-1, 0.0))
        if row >= 0 and volume == one.mesh.volume:
            rows[one.name] = row
        else:
            rows[one.name] = end
            end += 1
    return rows


def _list_hulls(hulls: Sequence[Hull], bladders: Sequence[PlacedBallast]) -> HullSet:
    """The hulls, and behind them the geoms of bladders, which are submerged by themselves."""
    solids: list[Hull | PlacedBallast] = [*hulls, *bladders]
    return HullSet(
        [one.mesh for one in solids],
        frames=[one.geom for one in solids],
        bodies=[one.body for one in solids],
        turns=[one.body_from_geom for one in solids],
        fills=[*(hull.fill for hull in hulls), *(1.0 for _ in bladders)],
    )


def _leave_out_foils(
    model: mujoco.MjModel,
    settings: Settings,
    bodies: Sequence[int] | None,
    foils: Sequence[PlacedFoil],
) -> Sequence[Hull] | None:
    """The hulls without the geoms that are foils; None if there are no such geoms."""
    geoms = {foil.geom for foil in foils if foil.geom is not None}
    return find_hulls(model, settings.selection, bodies, geoms) if geoms else None
