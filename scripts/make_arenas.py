"""Write the arenas that ship, as MJCF, from what `sauvc_arena` builds.

Run `.venv/bin/python scripts/make_arenas.py` from anywhere; commit the files that it writes.
"""

from pathlib import Path

from buoyancy_mj import sauvc_arena
from buoyancy_mj.environments.sauvc.arena import TASKS

SCENES = Path(__file__).resolve().parent.parent / "scenes"
HEADER = (
    "<!-- SAUVC rulebook 2026, v6.1.0, as its figures have it; scripts/make_arenas.py writes "
    "this file -->\n"
)


def write_arena(task: str) -> str:
    """The MJCF of the arena of a task."""
    spec = sauvc_arena(task)
    spec.compile()
    return HEADER + spec.to_xml()


def main() -> None:
    """Write each arena, and say how large it is."""
    for task in TASKS:
        path = SCENES / f"sauvc_{task}.xml"
        path.write_text(write_arena(task))
        print(f"{path.name}: {len(path.read_text().splitlines())} lines")


if __name__ == "__main__":
    main()
