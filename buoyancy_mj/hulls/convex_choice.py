"""What a user types so that some geoms, and no others, displace water as their convex hull."""

import fnmatch
import re
import shlex
from collections.abc import Collection, Sequence
from xml.sax.saxutils import quoteattr

import mujoco

from buoyancy_mj.hulls.names import geom_name
from buoyancy_mj.hulls.selection import CUSTOM_TEXTS


def describe_convex_choice(
    model: mujoco.MjModel, convex: Collection[int], geoms: Sequence[int]
) -> str:
    """The choice of convex hulls as a flag, in Python and in MJCF, for the mend of a message.

    Args:
        model: any model.
        convex: indices of all geoms that are to displace as their convex hull.
        geoms: indices of the geoms that displace water.
    """
    patterns = [f"{pattern}=convex" for pattern in write_patterns(model, convex, geoms)]
    words = " ".join(patterns)
    flags = " ".join(f"--hull {_quote(pattern)}" for pattern in patterns)
    return (
        f"{flags}, in Python Selection(hull={words!r}), "
        f'in MJCF <text name="{CUSTOM_TEXTS["hull"]}" data={quoteattr(words)}/>'
    )


def write_patterns(
    model: mujoco.MjModel, wanted: Collection[int], geoms: Sequence[int]
) -> list[str]:
    """Patterns that match the wanted ones of `geoms` and no others, in the order of the model.

    A number in a name becomes '*' where that matches several wanted geoms at once.
    """
    names = {geom: geom_name(model, geom) for geom in geoms}
    patterns: list[str] = []
    for geom in sorted(wanted):
        if any(fnmatch.fnmatchcase(names[geom], pattern) for pattern in patterns):
            continue
        pattern = _escape(names[geom])
        wider = re.sub(r"\d+", "*", pattern)
        matches = {g for g, name in names.items() if fnmatch.fnmatchcase(name, wider)}
        patterns.append(wider if len(matches) > 1 and matches <= set(wanted) else pattern)
    return patterns


def _quote(text: str) -> str:
    """A text for the shell, always between quotes."""
    return shlex.quote(text) if shlex.quote(text) != text else f"'{text}'"


def _escape(name: str) -> str:
    """A name as a pattern that matches it: '?' for what parts or quotes words, or is a wildcard."""
    return re.sub(r"[\s,*?\['\"]", "?", name)
