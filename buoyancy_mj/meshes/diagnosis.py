"""`Diagnosis`: the faults of a mesh, what was repaired, and whether a hull came out."""

import dataclasses

from buoyancy_mj.meshes.mesh import TriMesh


@dataclasses.dataclass(frozen=True)
class Hole:
    """A hole in a surface: its rim, and the volume that closing it makes uncertain."""

    edges: int
    """Number of edges of the rim."""
    perimeter: float
    """Length of the rim [m]."""
    uncertain_volume: float
    """Volume of a dome over the hole [m^3]."""


@dataclasses.dataclass(eq=False)
class Diagnosis:
    """The faults of a mesh, what was repaired, and the hull if there is one."""

    name: str
    """What messages call the mesh."""
    mend: str = "or take its convex hull instead"
    """What helps beside a better mesh where no repair is safe: the end of a refusal."""
    triangles: int = 0
    """Number of triangles before the repair."""
    extents: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Sides of the bounding box (3,) [m]."""
    original_volume: float = 0.0
    """Volume before the repair [m^3]; of an open mesh, about its mean vertex."""
    degenerate: int = 0
    """Triangles without area, which were dropped."""
    duplicates: int = 0
    """Repeated triangles, which were dropped."""
    stitched: int = 0
    """Vertices of open edges that rounding had set apart, which were merged."""
    backwards: int = 0
    """Triangles wound against their neighbours, which were turned."""
    holes: tuple[Hole, ...] = ()
    """Holes in the surface."""
    inverted: str = ""
    """The part that was inside out and was turned, as in "2 of its 5 pieces"; '' for none."""
    pieces: int = 0
    """Closed surfaces that do not touch."""
    shells: int = 0
    """Pieces inside others, which bound sealed cavities."""
    sealed_volume: float = 0.0
    """Volume of those cavities [m^3], which displaces water like solid."""
    joined_volume: float = 0.0
    """Volume [m^3] that overlapping pieces counted twice until they were joined."""
    doubled_volume: float = 0.0
    """Volume that the surface encloses more than once [m^3], estimated by rays."""
    inside_out_volume: float = 0.0
    """Volume that the surface encloses inside out [m^3], estimated by rays."""
    notices: list[str] = dataclasses.field(default_factory=list)
    """One sentence for each thing that was repaired or is uncertain."""
    refusal: str = ""
    """Why the mesh cannot be a hull, and what to do about it; '' if it can."""
    mesh: TriMesh | None = None
    """The hull; None if the mesh was refused."""

    @property
    def repaired(self) -> bool:
        """Whether the hull differs from the mesh before the repair."""
        return bool(
            self.degenerate
            or self.duplicates
            or self.stitched
            or self.backwards
            or self.holes
            or self.inverted
            or self.shells
            or self.joined_volume
        )

    @property
    def uncertain_volume(self) -> float:
        """Volume that the holes make uncertain [m^3]."""
        return sum(hole.uncertain_volume for hole in self.holes)
