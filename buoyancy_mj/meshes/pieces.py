"""Pieces of a closed surface: turned outward, freed of inner shells, joined where they overlap."""

import manifold3d
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.kernels.rays import misenclosed
from buoyancy_mj.meshes.components import label_components
from buoyancy_mj.meshes.diagnosis import Diagnosis
from buoyancy_mj.meshes.surface import (
    Surface,
    compact,
    directed_edges,
    signed_volume,
    to_manifold,
    winding_number,
)

RAYS = 160
"""Rays along each side of the grid that looks for space enclosed twice."""


def turn_outward(
    report: Diagnosis, v: NDArray[np.float64], f: NDArray[np.int64]
) -> list[NDArray[np.int64]]:
    """Split a closed surface into pieces that wind outward, without the walls of sealed cavities.

    A piece that winds inward bounds a cavity if it lies inside a solid piece; anywhere else it is
    a mistake and is turned.
    """
    if signed_volume(v, f) < 0.0:
        f = f[:, ::-1].copy()
        report.inverted = "it"
    pieces = _split(v, f)
    report.pieces = len(pieces)
    inward = [signed_volume(v, piece) < 0.0 for piece in pieces]
    solid = [piece for piece, hollow in zip(pieces, inward, strict=True) if not hollow]

    # cavities and mistakes
    turned = 0
    for piece, hollow in zip(pieces, inward, strict=True):
        if not hollow:
            continue
        if any(winding_number(v, other, v[piece[0, 0]]) > 0.5 for other in solid):
            report.sealed_volume -= signed_volume(v, piece)
            report.shells += 1
        else:
            solid.append(piece[:, ::-1])
            turned += 1

    # what the user should know
    if turned and not report.inverted:
        report.inverted = f"{turned} of its {len(pieces)} pieces"
    if report.inverted:
        report.notices.append(f"{report.inverted} was inside out; its faces were turned outward")
    if report.sealed_volume:
        report.notices.append(
            f"water cannot reach the {report.sealed_volume:.3g} m^3 sealed inside it, "
            "which displace like solid"
        )
    return solid


def _split(v: NDArray[np.float64], f: NDArray[np.int64]) -> list[NDArray[np.int64]]:
    """Group the faces of a surface by the pieces that they are connected to."""
    labels = label_components(directed_edges(f), len(v))[f[:, 0]]
    order = np.argsort(labels, kind="stable")
    return np.split(f[order], np.flatnonzero(np.diff(labels[order])) + 1)


def find_crossings(report: Diagnosis, v: NDArray[np.float64], f: NDArray[np.int64]) -> None:
    """Estimate by rays the volume that a surface encloses twice, and inside out."""
    report.doubled_volume, report.inside_out_volume = misenclosed(v, f, RAYS)


def join_pieces(
    report: Diagnosis, v: NDArray[np.float64], pieces: list[NDArray[np.int64]]
) -> Surface:
    """Join overlapping pieces by a boolean union, unless one is no manifold or it helps nothing."""
    f = np.vstack(pieces)
    solids = [to_manifold(*compact(v, piece)) for piece in pieces]
    manifolds = [solid for solid in solids if solid is not None]
    if len(manifolds) < len(pieces):
        return v, f

    # the union
    union = manifold3d.Manifold.batch_boolean(manifolds, manifold3d.OpType.Add).to_mesh64()
    vertices = np.asarray(union.vert_properties)[:, :3].copy()
    faces = np.asarray(union.tri_verts).astype(np.int64)

    # whether it is better
    crossing = report.doubled_volume + report.inside_out_volume
    doubled, inside_out = misenclosed(vertices, faces, RAYS)
    if doubled + inside_out >= crossing:
        return v, f
    report.doubled_volume, report.inside_out_volume = doubled, inside_out
    report.joined_volume = signed_volume(v, f) - signed_volume(vertices, faces)
    report.notices.append(
        f"its {len(pieces)} pieces overlap; they were joined, "
        f"and {report.joined_volume:.3g} m^3 no longer count twice"
    )
    return vertices, faces
