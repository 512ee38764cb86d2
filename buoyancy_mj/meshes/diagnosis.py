"""`Diagnosis`: the faults of a mesh, what was repaired, and whether a hull came out."""

import dataclasses
import json
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.meshes.mesh import TriMesh

MEND = "{mend}"
"""What stands in the refusal of a mesh without a name for what helps beside a better mesh."""


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

    name: str = ""
    """What messages call the mesh; '' if they do not name it yet."""
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

    def told_of(self, name: str, mend: str = mend) -> "Diagnosis":
        """The same diagnosis with messages that name the mesh.

        Args:
            name: what they call it.
            mend: what helps beside a better mesh where no repair is safe.
        """
        refusal = f"{name}: {self.refusal.replace(MEND, mend)}" if self.refusal else ""
        notices = [f"{name}: {notice}" for notice in self.notices]
        return dataclasses.replace(self, name=name, mend=mend, refusal=refusal, notices=notices)

    def to_arrays(self) -> dict[str, NDArray[Any]]:
        """All of it as arrays, its numbers and texts as JSON."""
        facts = {
            field.name: getattr(self, field.name)
            for field in dataclasses.fields(self)
            if field.name not in ("holes", "mesh")
        }
        facts["holes"] = [dataclasses.astuple(hole) for hole in self.holes]
        texts = np.frombuffer(json.dumps(facts).encode(), np.uint8)
        return {"facts": texts} | (self.mesh.to_arrays() if self.mesh else {})

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, NDArray[Any]]) -> "Diagnosis":
        """The diagnosis that `to_arrays` gave the arrays of."""
        facts = json.loads(arrays["facts"].tobytes())
        facts["holes"] = tuple(Hole(*hole) for hole in facts["holes"])
        facts["extents"] = tuple(facts["extents"])
        return cls(**facts, mesh=TriMesh.from_arrays(arrays) if "faces" in arrays else None)

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
