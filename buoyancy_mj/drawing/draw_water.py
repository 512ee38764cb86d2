"""`draw_water`: the water of a model in somebody's own renderer."""

import dataclasses
import weakref
from typing import TYPE_CHECKING, Any

import mujoco
from numpy.typing import ArrayLike

from buoyancy_mj.drawing.classic.sea import Eye, add_sea, find_eye
from buoyancy_mj.drawing.looks import DAYLIGHT, Look
from buoyancy_mj.drawing.subject import Subject
from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.errors import DrawingError, describe
from buoyancy_mj.scenes.run import OwnRun, find_run
from buoyancy_mj.values import read_array

if TYPE_CHECKING:
    from buoyancy_mj.drawing.filament.sea import FilamentSea

FILAMENT_SCENE = "scn"
"""What MuJoCo calls the scene of a model in Filament's renderer."""


@dataclasses.dataclass
class _Drawing:
    """What is drawn into one scene."""

    run: OwnRun
    """The model and its water."""
    subject: Subject
    """What floats."""
    radius: float
    """Distance from it within which the surface is exact [m]."""
    sea: "FilamentSea | None" = None
    """The sea in a scene of Filament, which stays in it."""


_drawings: "weakref.WeakKeyDictionary[Any, _Drawing]" = weakref.WeakKeyDictionary()
"""What is drawn, by scenes."""


def draw_water(
    renderer: Any,
    data: mujoco.MjData,
    *,
    eye: ArrayLike | None = None,
    scene: str = FILAMENT_SCENE,
    buoyancy: Buoyancy | None = None,
    look: Look = DAYLIGHT,
) -> None:
    """Draw the water into the scene of a renderer, beside all that is in it.

    In the classic renderer it adds triangles to the scene, and so is called after each
    `update_scene`, which clears it. In Filament the water stays in the scene, and each call moves
    it; while the camera is under water there is haze.

    Args:
        renderer: a `mujoco.Renderer`, a `mujoco.MjvScene` such as the `user_scn` of a viewer, or a
            `Renderer` of `mujoco.rendering.filament.renderer`.
        data: poses and time, as mj_forward left them.
        eye: where the camera is (3,) [m]. Filament needs it; the classic renderer's scene knows.
        scene: name of the scene in Filament's renderer.
        buoyancy: the water; None for that of the model itself, or else the one that is a callback
            of MuJoCo now.
        look: colours of the water.

    Raises:
        DrawingError: this is no such renderer, its scene has no room, or the eye is missing.
        ModelError: no water acts on the model, or several do and none is named.

    Example:
        >>> mujoco.mj_forward(model, data)
        >>> scene = mujoco.MjvScene(model, maxgeom=10_000)  # that of a renderer is renderer.scene
        >>> draw_water(scene, data, eye=(3.0, 0.0, 1.0), buoyancy=Buoyancy(model, Water()))
        >>> scene.ngeom > 1000
        True
    """
    place = None if eye is None else read_array(DrawingError, "eye", eye, (3,))
    target = _find_scene(renderer, scene)
    drawing = _find_drawing(target, data, buoyancy)
    water, time = drawing.run.buoyancy.water, float(data.time)
    centre = drawing.subject.locate(data)
    if isinstance(target, mujoco.MjvScene):
        seen = find_eye(target) if place is None else Eye(place)
        add_sea(target, water, centre, time, radius=drawing.radius, eye=seen, look=look)
        return
    if place is None:
        raise DrawingError("Filament does not say where its camera is; give eye=, its place [m]")
    if drawing.sea is None:
        from buoyancy_mj.drawing.filament.sea import FilamentSea

        drawing.sea = FilamentSea(renderer.context, target, drawing.radius, water.curvature, look)
    drawing.sea.draw(water, centre, time, place)


def _find_scene(renderer: Any, name: str) -> Any:
    """The scene of a renderer; Filament's has several, by names."""
    if isinstance(renderer, mujoco.MjvScene):
        return renderer
    scene = getattr(renderer, "scene", None)
    if isinstance(scene, mujoco.MjvScene):
        return scene
    if callable(scene) and hasattr(renderer, "context"):
        return scene(name)
    raise DrawingError(
        f"{describe(renderer)} is no renderer; possible are mujoco.Renderer, mujoco.MjvScene and "
        "mujoco.rendering.filament.renderer.Renderer"
    )


def _find_drawing(scene: Any, data: mujoco.MjData, buoyancy: Buoyancy | None) -> _Drawing:
    """What is drawn into a scene, found once for each model and water."""
    drawing = _drawings.get(scene)
    if drawing is None or not _is_same(drawing, data, buoyancy):
        if drawing is not None and drawing.sea is not None:
            drawing.sea.remove()
        run = find_run(data.model, data, buoyancy)
        subject = Subject(run.model, run.vehicles.values(), data)
        drawing = _drawings[scene] = _Drawing(run, subject, max(subject.measure(data)))
    return drawing


def _is_same(drawing: _Drawing, data: mujoco.MjData, buoyancy: Buoyancy | None) -> bool:
    """Whether a drawing is that of a model and a water."""
    known = drawing.run
    return known.model._address == data.model._address and buoyancy in (None, known.buoyancy)
