"""`Shot`: where a camera stands at one instant, and what it sees."""

import dataclasses
import math

import mujoco
import numpy as np
from numpy.typing import NDArray

UP = np.array([0.0, 0.0, 1.0])


@dataclasses.dataclass(frozen=True, eq=False)
class Shot:
    """A camera at one instant."""

    eye: NDArray[np.float64]
    """Where it stands (3,) [m], world frame."""
    forward: NDArray[np.float64]
    """Unit vector (3,) along which it looks."""
    up: NDArray[np.float64]
    """Unit vector (3,) that points up in the picture, at right angles to `forward`."""
    fovy: float
    """Angle that the picture takes from top to bottom [rad]."""
    subject: float
    """Distance of what it looks at [m]."""

    @property
    def right(self) -> NDArray[np.float64]:
        """Unit vector (3,) that points right in the picture."""
        return np.cross(self.forward, self.up)

    def project(self, points: NDArray[np.float64], aspect: float) -> NDArray[np.float64]:
        """Where points (..., 3) [m] are in the picture (..., 2).

        The middle is (0, 0), the right edge x = 1 and the upper edge y = 1; NaN for what lies
        behind the camera.

        Args:
            points: world frame.
            aspect: width of the picture over its height.
        """
        rays = points - self.eye
        depth = rays @ self.forward
        depth = np.where(depth > 0.0, depth, np.nan)
        half = math.tan(0.5 * self.fovy)
        x, y = rays @ self.right / (half * aspect), rays @ self.up / half
        return np.stack([x / depth, y / depth], axis=-1)

    def frustum(self, aspect: float, near: float, far: float) -> dict[str, object]:
        """The camera as MuJoCo's renderers take it: fields of `mjvGLCamera`, by name.

        Args:
            aspect: width of the picture over its height.
            near: distance of the nearest that is drawn [m].
            far: distance of the farthest [m].
        """
        top = near * math.tan(0.5 * self.fovy)
        return {
            "pos": self.eye,
            "forward": self.forward,
            "up": self.up,
            "frustum_center": 0.0,
            "frustum_width": top * aspect,
            "frustum_bottom": -top,
            "frustum_top": top,
            "frustum_near": near,
            "frustum_far": far,
        }


def look_at(
    eye: NDArray[np.float64],
    target: NDArray[np.float64],
    fovy: float,
    place: tuple[float, float] = (0.0, 0.0),
    aspect: float = 1.0,
) -> Shot:
    """A level camera that has a point at a place of its picture.

    Args:
        eye: where it stands (3,) [m].
        target: the point (3,) [m], not straight above or below.
        fovy: angle from top to bottom of the picture [rad].
        place: where the point shall be, as `Shot.project` counts.
        aspect: width of the picture over its height.
    """
    ray = target - eye
    distance = float(np.linalg.norm(ray))
    azimuth, height = math.atan2(ray[1], ray[0]), math.asin(ray[2] / distance)
    half = math.tan(0.5 * fovy)
    # turned by the angles at which the place is seen; the two are nearly independent
    across = math.atan(place[0] * half * aspect * math.cos(height))
    pitch = height - math.atan(place[1] * half * math.cos(across))
    heading = azimuth + across / max(math.cos(pitch), 0.1)
    forward = np.array(
        [
            math.cos(pitch) * math.cos(heading),
            math.cos(pitch) * math.sin(heading),
            math.sin(pitch),
        ]
    )
    right = np.array([math.sin(heading), -math.cos(heading), 0.0])
    return Shot(eye, forward, np.cross(right, forward), fovy, distance)


def shot_of_camera(model: mujoco.MjModel, data: mujoco.MjData, camera: int) -> Shot:
    """What a camera of a model sees.

    Args:
        model: the model.
        data: its data, with poses.
        camera: index of the camera.
    """
    axes = data.cam_xmat[camera].reshape(3, 3)
    forward = -axes[:, 2]
    eye = data.cam_xpos[camera].copy()
    distance = float(np.linalg.norm(data.subtree_com[0] - eye))
    fovy = math.radians(float(model.cam_fovy[camera]))
    return Shot(eye, forward, axes[:, 1].copy(), fovy, distance)
