"""The wet part of closed triangle meshes under a surface: exact on triangles, no lid needed.

With the depth d = elevation - z, the field (0, 0, -d) has divergence 1 in the water and vanishes on
the surface, so by Gauss

    V = - int d n_z dA,   int x dV = - int x d n_z dA,   int z dV = - int (z + d/2) d n_z dA

over the wet side of the mesh alone. In waves the elevation is that of the plane that touches the
surface over the middle of the hull, and a rest e(x, y), see `swell`. The field (0, 0, e) has no
divergence, so what e adds on the wet side it adds on the waterplane, and there alone it needs to be
summed:

    V = - int d n_z dA + int e dxdy,   int x dV = - int x d n_z dA + int x e dxdy,
    int z dV = - int (z + d/2) d n_z dA + int (p + e/2) e dxdy

with d the depth under the plane, p its height, and the last integrals over the waterplane, whose
outline is where the triangles are cut. The waterplane's own area is - int n_z dA over the wet side,
and its centroid is summed along the outline, over the triangles from the middle of the hull to each
cut.

Nodes are summed in the frame of the hull, where their moments stand still and the vertical leans.
Triangles at the surface are seen from above, from the middle of the hull, see `leaves` and `cuts`:
there x, y and d say all of a corner, since z is the height of the plane less d.
"""

import math

from numba import int64, uint64

from buoyancy_mj.kernels import swell, tree
from buoyancy_mj.kernels.compiling import inlined, njit
from buoyancy_mj.kernels.cuts import MOST, add, nothing, subtract, sum_cuts
from buoyancy_mj.kernels.halving import split
from buoyancy_mj.kernels.hulls import (
    ALLOWED,
    FILL,
    WHOLE_AREA,
    WHOLE_CENTROID,
    WHOLE_HALF,
    WHOLE_MIDDLE,
    WHOLE_VOLUME,
)
from buoyancy_mj.kernels.leaves import (
    count_wet,
    faces_of,
    let_triangle_wait,
    let_wait,
    set_triangle,
    sort_bent_faces,
    sort_faces,
    sum_faces,
    sum_triangle,
    vertices_of,
)
from buoyancy_mj.kernels.strips import waterplane_moments
from buoyancy_mj.kernels.surface import swing
from buoyancy_mj.kernels.vectors import difference, place, rotate, triple
from buoyancy_mj.kernels.wet_nodes import integrate_node, sum_nodes

VOLUME, CX, CY, CZ, WETTED_AREA, WATERPLANE_AREA, WATERPLANE_X, WATERPLANE_Y, COLUMNS = range(9)
"""Columns of one row of results, and how many: volume, its centroid (3), areas, and the centroid of
the waterplane (2)."""
CENTROID = slice(CX, WETTED_AREA)
"""Columns of the centroid."""


@njit(cache=True, error_model="numpy", _nrt=False)
def submerge_hulls(
    hulls,  # `hulls.Hulls`
    geoms,  # `multibody.Geoms`
    level,  # of the water [m]
    time,  # [s]
    scratch,  # `scratch.CutScratch`
    out,  # (h, 8) volume, centroid (world; NaN when dry), wetted area, waterplane (NaN when none)
    first,  # hull, and one past the last
    last,
):
    """Write the submersion of hulls to their rows of `out`.

    Only hulls that the surface may cut cost more than a few operations.
    """
    wholes, frames = hulls.whole, hulls.frames
    tiles, store = hulls.tiles, scratch.store
    positions, rotations = geoms.geom_xpos, geoms.geom_xmat
    for h in range(first, last):
        origin, r = positions[frames[h]], rotations[frames[h]]

        # how deep the middle of its box lies, and how much shallower or deeper any point of it can
        # be
        c0, c1, c2 = triple(wholes, h, WHOLE_MIDDLE)
        e0, e1, e2 = triple(wholes, h, WHOLE_HALF)
        x, y, z = place(origin, r, c0, c1, c2)
        radius = math.sqrt(e0 * e0 + e1 * e1 + e2 * e2)
        eta, spread, curvature = swing(tiles, store, x, y, time, radius)
        depth = level + eta - z
        spread += abs(r[6]) * e0 + abs(r[7]) * e1 + abs(r[8]) * e2

        # a hull that is lost, under water, dry, or cut
        if not math.isfinite(depth):
            out[h, :] = math.nan
        elif depth >= spread:
            _set_whole(out, h, wholes, origin, r, wholes[h, WHOLE_AREA])
        elif depth <= -spread:
            _set_dry(out, h)
        else:
            wet = _walk(hulls, h, origin, r, level, time, curvature, scratch)
            _set_wet(out, h, wholes, origin, r, wet)


@inlined
def _set_dry(out, h):
    """Write the results of a hull that is not in the water."""
    out[h, VOLUME] = out[h, WETTED_AREA] = out[h, WATERPLANE_AREA] = 0.0
    out[h, CX] = out[h, CY] = out[h, CZ] = out[h, WATERPLANE_X] = out[h, WATERPLANE_Y] = math.nan


@inlined
def _set_whole(out, h, wholes, origin, r, area):
    """Write the results of a hull whose whole volume is under water."""
    out[h, VOLUME], out[h, WETTED_AREA] = wholes[h, WHOLE_VOLUME], area
    out[h, WATERPLANE_AREA] = 0.0
    out[h, WATERPLANE_X] = out[h, WATERPLANE_Y] = math.nan
    x, y, z = triple(wholes, h, WHOLE_CENTROID)
    out[h, CX], out[h, CY], out[h, CZ] = place(origin, r, x, y, z)


@njit(cache=True, error_model="numpy", _nrt=False)
def _set_wet(out, h, wholes, origin, r, wet):
    """Write the results of a hull that the surface cuts, by what `_walk` found."""
    v, mx, my, mz, area, waterplane, px, py = wet
    # below the rounding of the sums there is no centroid to speak of, and never more than all of it
    if not v > 1e-14 * wholes[h, WHOLE_VOLUME]:
        _set_dry(out, h)
        return
    _set_whole(out, h, wholes, origin, r, area)
    if v < wholes[h, WHOLE_VOLUME]:
        out[h, VOLUME] = v
        out[h, CX] = origin[0] + mx / v
        out[h, CY] = origin[1] + my / v
        out[h, CZ] = origin[2] + mz / v
    if waterplane != 0.0:
        out[h, WATERPLANE_AREA] = waterplane
        out[h, WATERPLANE_X] = origin[0] + px / waterplane
        out[h, WATERPLANE_Y] = origin[1] + py / waterplane


@njit(cache=True, error_model="numpy", _nrt=False)
def _walk(  # noqa: C901 (a call for each node would cost more than what it does)
    hulls, h, origin, r, level, time, curvature, scratch
):
    """Volume of a hull, its first moments, wetted area, waterplane and its moments, by its tree.

    All moments are about the origin of the hull's frame, in the world's axes.

    Triangles are visited at the surface alone: nodes that are wholly wet are answered by their
    moments. `curvature` is a bound of the surface's over the hull.
    """
    tiles, store, near = hulls.tiles, scratch.store, scratch.swell
    vertices, faces, sizes = hulls.vertices, hulls.faces, hulls.sizes
    spans, boxes, node_moments = hulls.spans, hulls.boxes, hulls.moments
    plane, rest = swell.approach(level, tiles, store, origin, r, hulls.whole, h, time, near)
    wavy = rest.near > 0 or rest.smooth

    # what is seen of the vertices of a leaf; without waves the plane is the surface
    x, y, d = scratch.seen[0], scratch.seen[1], scratch.seen[2]
    w = scratch.seen[3] if wavy else d
    most, others, crossed = scratch.sorted[0], scratch.sorted[1], scratch.sorted[2]
    bent, stack, allowed = scratch.sorted[3], scratch.stack, hulls.whole[h, ALLOWED]
    edges, most_bent = hulls.edges, 0.125 * curvature if wavy else 0.0
    # int64: a literal 0 would have all that it is given to compiled twice
    cuts, waiting, none = scratch.cuts, int64(0), int64(0)

    # integrals over wet nodes, over triangles, and of e over the waterplane
    total, sums, extra = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), nothing(), (0.0, 0.0, 0.0, 0.0)
    i = hulls.nodes[h]
    end = spans[i, tree.BEHIND]
    while i < end:
        middle, half = triple(boxes, i, tree.MIDDLE), triple(boxes, i, tree.HALF)
        away = difference(middle, plane.middle)
        under = swell.depth_away(plane, away)
        depth, slope = under, plane.gradient
        if wavy:
            e, lean = swell.over_node(rest, r, tiles, store, near, away)
            depth += e
            slope = slope[0] + lean[0], slope[1] + lean[1], slope[2] + lean[2]
        spread = tree.spread_in_box(half, slope, curvature)
        dry, wet = depth <= -spread, depth >= spread
        mostly = wet and not dry
        if not dry and not wet and tree.is_leaf(spans, i):
            # see its vertices, sort its triangles
            base, count = vertices_of(spans, i)
            swell.see(vertices, base, count, plane, r, x, y, d)
            if wavy:
                for n in range(count):
                    w[n] = d[n]
                swell.add_rest(x, y, int64(count), rest, tiles, store, near, w)
            first, behind = faces_of(spans, i)
            if most_bent * edges[i] * edges[i] > allowed:
                many, few, cut, halved = sort_bent_faces(
                    faces, first, behind, base, x, y, w, curvature, allowed,
                    most, others, crossed, bent,
                )  # fmt: skip
            else:
                many, few, cut = sort_faces(faces, first, behind, base, w, most, others, crossed)
                halved = uint64(0)

            # those that are mostly wet, or all of them less the others
            mostly = many > few
            if mostly:
                sums = subtract(sums, sum_faces(faces, sizes, base, others, few, x, y, d))
            else:
                sums = add(sums, sum_faces(faces, sizes, base, most, many, x, y, d))

            # those that the surface cuts
            for n in range(cut):
                let_wait(cuts, waiting, crossed[n], faces, sizes, base, x, y, d, w)
                waiting += 1
                if waiting == MOST:
                    sums, extra = _take(
                        cuts, waiting, sums, extra, wavy, plane, rest, tiles, store, near
                    )  # fmt: skip
                    waiting = none

            # those that are to be halved, until what is left of them is wet, dry or cut
            for n in range(halved):
                set_triangle(stack, bent[n], faces, base, x, y, d, w)
                size, top = sizes[bent[n]], none
                while top >= 0:
                    more = split(
                        stack, top, curvature, allowed, (tiles, store),
                        rest.place, rest.touch_all, time,
                    )  # fmt: skip
                    if more > top:
                        top = more
                        continue
                    wet_corners = count_wet(stack, top)
                    if wet_corners > 1:
                        sums = add(sums, sum_triangle(stack, top, size))
                    if wet_corners == 1 or wet_corners == 2:
                        let_triangle_wait(cuts, waiting, stack, top, size)
                        waiting += 1
                        if waiting == MOST:
                            sums, extra = _take(
                                cuts, waiting, sums, extra, wavy, plane, rest,
                                tiles, store, near,
                            )  # fmt: skip
                            waiting = none
                    top -= 1
        if mostly:
            part = integrate_node(node_moments[i], middle, r, under, plane.gradient)
            total = sum_nodes(total, part)
        i = tree.node_after(spans, i, dry or wet)

    # the cuts that still wait
    sums, extra = _take(cuts, waiting, sums, extra, wavy, plane, rest, tiles, store, near)
    return _join(total, sums, extra, plane, r, hulls.whole[h, FILL])


@njit(cache=True, error_model="numpy", _nrt=False)
def _take(cuts, waiting, sums, extra, wavy, plane, rest, tiles, store, near):
    """Take the cuts that wait, into integrals over triangles, and of e over the waterplane."""
    sums = add(sums, sum_cuts(cuts, waiting))
    if wavy:
        more = waterplane_moments(cuts, waiting, plane, rest, tiles, store, near)
        extra = extra[0] + more[0], extra[1] + more[1], extra[2] + more[2], extra[3] + more[3]
    return sums, extra


@inlined
def _join(total, sums, extra, plane, r, fill):
    """What `_walk` returns, from what it has summed over nodes, triangles and waterplane.

    Over nodes the sums are in the frame of the hull; all others are seen from above, from the
    middle of the hull.
    """
    # of triangles, as those of nodes
    v = fill * sums.volume
    (gx, gy), half = plane.slope, 0.5 * fill * sums.square
    mx, my, q = fill * sums.x, fill * sums.y, plane.height * v - half
    mz = q + fill * (gx * sums.x + gy * sums.y)
    p = fill * sums.above

    # from the middle of the hull to its origin
    c0, c1, c2 = plane.middle
    cx, cy, _ = rotate(r, c0, c1, c2)
    nx, ny, nz = rotate(r, total[1], total[2], total[3])
    i0, ix, iy, iz = fill * extra[0], fill * extra[1], fill * extra[2], fill * extra[3]
    whole, above = total[0] + v, total[5] + p
    return (
        i0 - whole,
        ix - mx - nx + cx * (i0 - v),
        iy - my - ny + cy * (i0 - v),
        iz - mz - nz - 0.5 * total[4],
        total[6] + sums.area,
        -above,
        fill * sums.outline_x - cx * above,
        fill * sums.outline_y - cy * above,
    )
