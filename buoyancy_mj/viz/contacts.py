"""`ContactDrawing`: where bodies touch in a recording, and how they push."""

import mujoco
import numpy as np
import rerun as rr
from numpy.typing import NDArray

from buoyancy_mj.hulls.bodies import find_moving_bodies
from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.scenes.run import Run
from buoyancy_mj.viz.framing import arrow_scale
from buoyancy_mj.viz.log import Log

POINTS, FORCES = "world/contacts/points", "world/contacts/forces"
COLOUR = (255, 90, 200)


class ContactDrawing:
    """The contacts of a run; nothing is drawn of a run in which nothing touches.

    Args:
        run: the run.
        size: length of the vehicle [m].
    """

    def __init__(self, run: Run, size: float) -> None:
        model = run.model
        self._model, self._size = model, size
        self._moves = find_moving_bodies(model)
        self._scales = [
            arrow_scale(run.vehicles.values(), body) for body in range(int(model.nbody))
        ]
        self._shown = 0
        self._is_styled = False

    def draw(self, log: Log, frame: Frame) -> None:
        """Draw each contact as a point, and its force on what moves as an arrow."""
        data = frame.data
        if not data.ncon and not self._shown:
            return
        if not self._is_styled:
            self._draw_style(log)
        self._shown = data.ncon
        positions = data.contact.pos
        vectors = np.zeros((data.ncon, 3))
        for contact in range(data.ncon):
            force, body = find_force(self._model, data, contact, self._moves)
            vectors[contact] = self._scales[body] * force
        log.draw(POINTS, rr.Points3D, positions=positions)
        log.draw(FORCES, rr.Arrows3D, origins=positions, vectors=vectors)

    def _draw_style(self, log: Log) -> None:
        """Draw what stays the same: colours and radii."""
        self._is_styled = True
        log.keep(POINTS, rr.Points3D.from_fields(colors=[COLOUR], radii=[0.01 * self._size]))
        log.keep(FORCES, rr.Arrows3D.from_fields(colors=[COLOUR], radii=[0.008 * self._size]))


def find_force(
    model: mujoco.MjModel, data: mujoco.MjData, contact: int, moves: NDArray[np.bool_]
) -> tuple[NDArray[np.float64], int]:
    """The force (3,) [N] of a contact in the world frame, and the index of the body it pushes.

    Args:
        model: the model.
        data: its data, as mj_forward left them.
        contact: index of the contact.
        moves: whether each body (nbody,) moves. Of two that move, the second is meant.
    """
    wrench = np.zeros(6)
    mujoco.mj_contactForce(model, data, contact, wrench)
    # the normal leads from the first geom to the second, which it pushes; a flex is no geom
    force = data.contact.frame[contact].reshape(3, 3).T @ wrench[:3]
    one, two = (
        int(model.geom_bodyid[geom]) if geom >= 0 else 0
        for geom in data.contact.geom[contact].tolist()
    )
    return (force, two) if moves[two] or not moves[one] else (-force, one)
