"""`kernels.ballast.Ballast`: bladders, tanks and compartments as kernels read them."""

from collections.abc import Mapping, Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import ModelError
from buoyancy_mj.hulls.ballasts import Bladder, Compartment
from buoyancy_mj.hulls.hull import Hull
from buoyancy_mj.hulls.names import body_name, geom_name
from buoyancy_mj.hulls.placed_ballasts import PlacedBallast
from buoyancy_mj.kernels.arrays import empty
from buoyancy_mj.kernels.ballast import Ballast
from buoyancy_mj.kernels.flooding import BLADDER, COMPARTMENT, TANK
from buoyancy_mj.meshes.fills import FillCurve, pack_fills


def gather_ballast(placed: Sequence[PlacedBallast], rows: Mapping[str, int] = {}) -> Ballast:
    """Ballast as kernels read it.

    Args:
        placed: all of it.
        rows: the rows of bladders in `Record.wet`, by name.
    """
    if not placed:
        return empty(Ballast)
    compartments = [one.ballast if isinstance(one.ballast, Compartment) else None for one in placed]
    return Ballast(
        kinds=np.array([_number_kind(one) for one in placed]),
        bodies=np.array([one.body for one in placed]),
        frames=np.array([one.geom for one in placed]),
        sites=np.array([one.site for one in placed]),
        addresses=np.array([one.address for one in placed]),
        outputs=np.array([one.output for one in placed]),
        acts=np.array([one.state for one in placed]),
        rows=np.array([rows.get(one.name, -1) for one in placed]),
        capacities=np.array([one.capacity for one in placed]),
        rates=np.array([getattr(one.ballast, "rate", 0.0) for one in placed]),
        openings=np.array([c.discharge * c.area if c else 0.0 for c in compartments]),
        sealed=np.array([int(c is not None and not c.vent) for c in compartments]),
        levels=np.array([int(one.has_level) for one in placed]),
        fills=pack_fills(
            [one.mesh for one in placed],
            [one.holds_water for one in placed],
            [one.curve.knots if one.holds_water else np.zeros(0) for one in placed],
            [_list_pieces(one) for one in placed],
        ),
    )


def check_ballast(
    model: mujoco.MjModel, placed: Sequence[PlacedBallast], hulls: Sequence[Hull]
) -> None:
    """Refuse bladders of geoms that displace nothing, and tanks whose inertia has no room.

    Raises:
        ModelError: there is one.
    """
    displacing = {geom for hull in hulls for geom in hull.geoms}
    for one in placed:
        if not one.holds_water and one.geom not in displacing:
            raise ModelError(
                f"bladder '{one.name}' names the geom '{geom_name(model, one.geom)}', which "
                "displaces no water; name a geom that does, or choose this one to displace"
            )
        first, count = int(model.body_dofadr[one.body]), int(model.body_dofnum[one.body])
        simple = count > 1 and (model.M_rownnz[first : first + count] <= 1).all()
        if one.holds_water and simple:
            raise ModelError(
                f"MuJoCo keeps the inertia of body '{body_name(model, one.body)}' as a diagonal, "
                f"since its centre of mass is its origin, and the water of '{one.name}' does not "
                "fit there; write <body simple='false'>, as add_ballast does"
            )


def _number_kind(one: PlacedBallast) -> int:
    """The kind as kernels know it."""
    if isinstance(one.ballast, Bladder):
        return BLADDER
    return COMPARTMENT if isinstance(one.ballast, Compartment) else TANK


def _list_pieces(one: PlacedBallast) -> NDArray[np.float64]:
    """The pieces of a tank's moments in the frame of its body (k, 36), the last row empty."""
    if not one.holds_water:
        return np.zeros((0, 36))
    rows = [_turn_piece(one, one.curve, i) for i in range(len(one.curve.pieces))]
    return np.array([*rows, np.zeros(36)])


def _turn_piece(one: PlacedBallast, curve: FillCurve, i: int) -> NDArray[np.float64]:
    """One piece (36,): coefficients of each moment in turn, moved from the geom to the body."""
    r, shift = one.body_from_geom, one.position
    # the volume itself as a cubic, beside its moments
    volume = np.array([0.0, 0.0, 1.0, curve.knots[i]])
    first = r @ curve.pieces[i, :3]
    xx, yy, zz, xy, xz, yz = curve.pieces[i, 3:]
    second = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    turned = np.einsum("ia,jb,abk->ijk", r, r, second)
    cross = np.einsum("ik,j->ijk", first, shift)
    turned += cross + cross.transpose(1, 0, 2) + np.einsum("i,j,k->ijk", shift, shift, volume)
    moved = first + np.outer(shift, volume)
    pairs = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
    return np.concatenate([*moved, *(turned[pair] for pair in pairs)])
