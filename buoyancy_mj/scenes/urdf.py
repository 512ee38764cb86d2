"""URDF as people have it: links without inertia, and links that are drawn but touch nothing."""

import warnings
from collections.abc import Iterable, Iterator
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import BuoyancyWarning

_KEEP_VISUAL = '<mujoco><compiler discardvisual="false"/></mujoco>'
"""What makes MuJoCo keep the visual geometry of a URDF."""
_LEAST_MASS = 1e-3
"""Mass [kg] of a link that states none."""
_DENSITY = 1000.0
"""Density [kg/m^3] of the ball whose inertia a link gets that states none."""


def is_urdf(path: Path) -> bool:
    """Whether a file is a URDF: XML whose root is <robot>."""
    try:
        with path.open("rb") as stream:
            for _, element in ElementTree.iterparse(stream, events=("start",)):
                return bool(element.tag == "robot")
    except (OSError, ElementTree.ParseError):
        pass
    return False


def read_urdf(path: Path) -> mujoco.MjSpec:
    """Read a URDF, with its visual geometry where no link has collision geometry.

    MuJoCo leaves visual geometry out of a URDF. Links that are left without any are told.

    Raises:
        ValueError: MuJoCo cannot read the file.
    """
    root = ElementTree.parse(path).getroot()
    bare, collides = _find_bare_links(root)
    if not bare or root.find("mujoco/compiler[@discardvisual]") is not None:
        return mujoco.MjSpec.from_file(str(path))
    if collides:
        _warn(
            "links that are drawn and have no collision geometry displace nothing, since MuJoCo "
            f"leaves visual geometry out of a URDF unless it has {_KEEP_VISUAL}: {_join(bare)}"
        )
        return mujoco.MjSpec.from_file(str(path))

    # nothing would be left of the vehicle
    element = root
    for tag in ("mujoco", "compiler"):
        below = element.find(tag)
        element = ElementTree.SubElement(element, tag) if below is None else below
    element.set("discardvisual", "false")
    spec = mujoco.MjSpec.from_string(ElementTree.tostring(root, encoding="unicode"))
    spec.modelfiledir = str(path.parent)
    return spec


def _find_bare_links(root: ElementTree.Element) -> tuple[list[str], bool]:
    """Links that are drawn, on bodies without collision geometry; and whether any body has some.

    A body is what fixed joints hold together.
    """
    import trimesh

    links = root.findall("link[@name]")
    index = {link.get("name"): i for i, link in enumerate(links)}
    ends = [
        [index.get(end.get("link")) for tag in ("parent", "child") for end in joint.findall(tag)]
        for joint in root.findall("joint[@type='fixed']")
    ]
    edges = np.array([pair for pair in ends if len(pair) == 2 and None not in pair], np.int64)
    bodies = trimesh.graph.connected_component_labels(edges.reshape(-1, 2), len(links)).tolist()

    # the bodies that have collision geometry, and the links that are drawn on others
    solid = {
        body
        for body, link in zip(bodies, links, strict=True)
        if link.find("collision/geometry") is not None
    }
    bare = [
        link.get("name", "")
        for body, link in zip(bodies, links, strict=True)
        if body not in solid and link.find("visual/geometry") is not None
    ]
    return bare, bool(solid)


def add_missing_inertia(spec: mujoco.MjSpec) -> None:
    """Give moving links that have no inertia the smallest sound one, with a notice.

    MuJoCo refuses a body that moves and has no mass or inertia. Many links have none in public
    files: frames that other links hang on, thrusters of a gram. Each gets the inertia of a ball of
    water of its mass, 2/5 m r^2, and the mass of a gram if it has none. MuJoCo still refuses a base
    that has geometry and no mass, and negative numbers.
    """
    bases = {body.name for body in spec.worldbody.bodies}
    massless: list[str] = []
    light: list[str] = []
    for body in spec.bodies[1:]:
        carried = list(_list_carried(body))
        if not body.joints or any(_is_sound(spec, part) for part in carried):
            continue
        if body.explicitinertial and body.mass > mujoco.mjMINVAL:
            if np.linalg.eigvalsh(_read_inertia(body))[0] >= -mujoco.mjMINVAL:
                _set_inertia(body, float(body.mass))
                light.append(body.name)
        elif body.mass >= 0.0 and not (body.name in bases and any(part.geoms for part in carried)):
            _set_inertia(body, _LEAST_MASS)
            massless.append(body.name)

    if light:
        _warn(f"links without inertia get that of a ball of water of their mass: {_join(light)}")
    if massless:
        _warn(
            "links without mass get mass and inertia of a ball of water of "
            f"{1e3 * _LEAST_MASS:g} g: {_join(massless)}"
        )


def _list_carried(body: mujoco.MjsBody) -> Iterator[mujoco.MjsBody]:
    """A body, and those that it carries without a joint."""
    yield body
    for child in body.bodies:
        if not child.joints:
            yield from _list_carried(child)


def _is_sound(spec: mujoco.MjSpec, body: mujoco.MjsBody) -> bool:
    """Whether a body has a mass and an inertia of its own that MuJoCo takes for a moving one."""
    if min(spec.compiler.boundmass, spec.compiler.boundinertia) > mujoco.mjMINVAL:
        return True
    if not body.explicitinertial:
        # what its geoms make of their density
        return any(
            geom.mass > 0.0 or (geom.mass != 0.0 and geom.density > 0) for geom in body.geoms
        )
    least = max(float(np.linalg.eigvalsh(_read_inertia(body))[0]), spec.compiler.boundinertia)
    mass = max(float(body.mass), spec.compiler.boundmass)
    return bool(min(mass, least) > mujoco.mjMINVAL)


def _read_inertia(body: mujoco.MjsBody) -> NDArray[np.float64]:
    """The inertia (3, 3) [kg m^2] that a body states, in its inertial frame."""
    xx, yy, zz, xy, xz, yz = np.asarray(body.fullinertia)
    if np.isnan(xx):
        return np.diag(body.inertia)
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def _set_inertia(body: mujoco.MjsBody, mass: float) -> None:
    """Give a body a mass [kg], and raise its moments of inertia to those of a ball of water."""
    radius = float(np.cbrt(3.0 * mass / (4.0 * np.pi * _DENSITY)))
    moments, axes = np.linalg.eigh(_read_inertia(body))
    inertia = axes @ np.diag(np.maximum(moments, 0.4 * mass * radius**2)) @ axes.T
    if not body.explicitinertial:
        body.ipos = [0.0, 0.0, 0.0]
    body.explicitinertial = True
    body.mass = mass
    body.fullinertia = inertia[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]


def _join(names: Iterable[str]) -> str:
    """Names, quoted, with commas between."""
    return ", ".join(f"'{name}'" for name in names)


def _warn(message: str) -> None:
    """Warn from where the file is read."""
    warnings.warn(message, BuoyancyWarning, stacklevel=5)
