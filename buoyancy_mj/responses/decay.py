"""`decay`: a vehicle is let go out of its rest on still water, and swings until it is still."""

import dataclasses
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import scipy
from numpy.typing import NDArray

from buoyancy_mj.errors import ResponseError, choices
from buoyancy_mj.responses.decay_fits import LEAST, DecayFit, Peaks, find_peaks, fit_decay
from buoyancy_mj.responses.stepping import Stepper
from buoyancy_mj.responses.subject import Subject, prepare, read_subject
from buoyancy_mj.responses.tables import finite_values
from buoyancy_mj.responses.tracks import MOTIONS, Track, join_tracks
from buoyancy_mj.scenes.scene import Scene
from buoyancy_mj.scenes.scene_vehicle import EQUILIBRIUM
from buoyancy_mj.statics.heading_axes import rotate_to_heading
from buoyancy_mj.values import read_number

RESTORED = ("heave", "roll", "pitch")
"""Motions that still water restores."""
HEAVE_PART = 0.2
"""From where heave is let go by default, as a part of the draft."""
HALF = 0.5
"""The most of that, as a part of the freeboard: the top stays out of the water."""
BACK = 0.1
"""How far from its rest a vehicle may come to an end, as a part of the start."""
TURN = math.radians(10.0)
"""From where roll and pitch are let go by default [rad]."""
SAMPLES = 100
"""Samples in a natural period."""
BLOCK = 4
"""Natural periods after each of which is looked whether it swings still."""
MOST_BLOCKS = 25
"""Such blocks at most."""


@dataclasses.dataclass(frozen=True, eq=False)
class Decay:
    """A free decay: the motion, its period, and the damping and the inertia that give it."""

    title: str
    """What was let go."""
    motion: str
    """The motion: 'heave', 'roll' or 'pitch'."""
    start: float
    """From where, out of its rest [m, rad]."""
    times: NDArray[np.float64]
    """Times (n,) [s]."""
    values: NDArray[np.float64]
    """The motion out of rest (n,) [m, rad]: of the centre of gravity, or about it."""
    peaks: Peaks
    """Its turning points."""
    fit: DecayFit
    """Period and damping over inertia."""
    stiffness: float
    """Hydrostatic stiffness C at rest [N/m, N m]."""
    inertia: float
    """Inertia M of the vehicle itself [kg, kg m^2]."""
    given_added_mass: float
    """Added mass that the model or its estimate states, at rest [kg, kg m^2]."""
    natural_period: float
    """Undamped period by statics, 2 pi sqrt((M + A) / C) with that added mass [s]."""
    dry_period: float
    """The same without added mass [s]."""

    @property
    def whole_inertia(self) -> float:
        """Inertia that the period tells, M + A = C / w^2 [kg, kg m^2]."""
        return self.stiffness / self.fit.omega**2

    @property
    def added_mass(self) -> float:
        """Equivalent added mass A, what the period asks for beside the vehicle's own inertia."""
        return self.whole_inertia - self.inertia

    @property
    def linear_damping(self) -> float:
        """B1 = p1 (M + A) [N s/m, N m s]."""
        return self.fit.linear * self.whole_inertia

    @property
    def quadratic_damping(self) -> float:
        """B2 = p2 (M + A) [N s^2/m^2, N m s^2]."""
        return self.fit.quadratic * self.whole_inertia

    def to_values(self) -> dict[str, Any]:
        """All of it as plain values, as JSON has them."""
        half = 0.5 * abs(self.start)
        values = {
            "title": self.title,
            "motion": self.motion,
            "start": self.start,
            "period": self.fit.period,
            "natural_period": self.natural_period,
            "dry_period": self.dry_period,
            "linear_damping": self.linear_damping,
            "quadratic_damping": self.quadratic_damping,
            "linear_over_inertia": self.fit.linear,
            "quadratic_over_inertia": self.fit.quadratic,
            "damping_ratio_at_half": self.fit.damping_ratio(half),
            "stiffness": self.stiffness,
            "inertia": self.inertia,
            "added_mass": self.added_mass,
            "given_added_mass": self.given_added_mass,
            "peak_times": self.peaks.times.tolist(),
            "peaks": self.peaks.values.tolist(),
            "amplitudes": self.fit.amplitudes.tolist(),
            "decrements": self.fit.decrements.tolist(),
        }
        return dict(finite_values(values))


def decay(
    subject: str | Path | Scene,
    motion: str = "heave",
    start: float | None = None,
    *,
    settings: Sequence[str] = (),
    trust: bool = False,
) -> Decay:
    """Let a vehicle go out of its rest on still water, and measure how it comes back.

    Args:
        subject: a scene, or a model or scene by its file or name, see `respond`. It is brought to
            rest first, whatever its start; waves are left out, and controllers rest.
        motion: 'heave', 'roll' or 'pitch'.
        start: from where [m, rad]; None for a fifth of the draft (half of the freeboard at
            most), or 10 degrees. It turns about the
            centre of gravity.
        settings: texts KEY=VALUE laid over the scene, as for `--set`; not for a `Scene`.
        trust: whether to run the Python files that the scene names as controllers.

    Raises:
        ResponseError: there is no such motion, nothing restores it, or it does not swing; a scene
            with several vehicles or a current.
        SceneError, ModelError, EquilibriumError: what `Simulation` raises.
        DivergenceError: the run left the finite numbers.

    Example:
        `decay("oes_sphere", "heave", 1.0).fit.period`
    """
    if motion not in RESTORED:
        raise ResponseError(f"there is no decay of '{motion}'; {choices(motion, RESTORED)}")
    scene = subject if isinstance(subject, Scene) else read_subject(subject, settings)
    scene = dataclasses.replace(scene, control=())
    if scene.vehicle is not None and scene.start.at is None:
        scene = dataclasses.replace(scene, start=dataclasses.replace(scene.start, at=EQUILIBRIUM))
    at_rest = prepare(scene, trust=trust)
    at, axis = at_rest.at_start, MOTIONS.index(motion)
    natural = float(at_rest.natural_periods[axis - 2])
    if not math.isfinite(natural):
        raise ResponseError(
            f"nothing restores the {motion} of '{scene.title}' where it rests (its stiffness is "
            f"{at.stiffness[axis, axis]:.4g}), so that it does not swing; choose another motion"
        )
    begin = TURN
    if motion == "heave":
        begin = min(HEAVE_PART * at.draft, HALF * at_rest.freeboard)
    if start is not None:
        begin = read_number(ResponseError, "the start of a decay", start)
    if motion != "heave" and abs(begin) >= math.pi:
        raise ResponseError(
            f"the start of the {motion} is {math.degrees(begin):.4g} degrees; it must be less than "
            "half a turn from rest"
        )
    if begin == 0.0:
        raise ResponseError("the start of a decay is 0, where the vehicle rests; give another")

    # the run
    between = natural / SAMPLES
    steps = max(1, math.ceil(between / scene.timestep - 1e-9))
    released = prepare(scene, timestep=between / steps, trust=trust)
    rest = _displace(released, axis, begin)
    track = _swing(released, steps, axis, rest, begin)
    later = track.times > 0.0
    times = np.append(0.0, track.times[later])
    values = np.append(begin, _read_motion(track, released, axis, rest)[later])
    if motion != "heave":
        values = np.unwrap(values)
    _check_end(motion, times, values, natural)
    peaks = find_peaks(times, values)
    return Decay(
        title=scene.title,
        motion=motion,
        start=begin,
        times=times,
        values=values,
        peaks=peaks,
        fit=fit_decay(peaks),
        stiffness=float(at.stiffness[axis, axis]),
        inertia=float(at.mass_matrix[axis, axis]),
        given_added_mass=float(at_rest.added_mass[axis, axis]),
        natural_period=natural,
        dry_period=float(at.natural_periods()[axis - 2]),
    )


def _check_end(
    motion: str, times: NDArray[np.float64], values: NDArray[np.float64], period: float
) -> None:
    """Check that a motion swings about its rest at its end.

    Raises:
        ResponseError: it swings about another place, as a vehicle that has turned over.
    """
    last = values[times > times[-1] - period]
    middle = 0.5 * float(last.max() + last.min())
    if abs(middle) > max(BACK * abs(values[0]), float(np.ptp(last))):
        scale, unit = (1.0, "m") if motion == "heave" else (math.degrees(1.0), "degrees")
        raise ResponseError(
            f"let go from {scale * values[0]:.4g} {unit}, the {motion} came to an end "
            f"{scale * middle:.4g} {unit} away from its rest; let it go from nearer"
        )


def _displace(
    subject: Subject, axis: int, start: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Bring a vehicle out of its rest; where its root body rests, as position and quaternion."""
    model, data = subject.simulation.model, subject.simulation.data
    mujoco.mj_kinematics(model, data)
    rest = data.xpos[subject.root].copy(), data.xquat[subject.root].copy()
    turn = data.xmat[subject.root].reshape(3, 3)
    centre = rest[0] + turn @ subject.centre
    if subject.tether:
        raise ResponseError(
            f"{subject.tether}, and what is let go must be free; give it a <freejoint/>"
        )

    # about the centre of gravity, along the heading
    q = int(model.jnt_qposadr[model.body_jntadr[subject.root]])
    if axis == MOTIONS.index("heave"):
        data.qpos[q + 2] += start
        return rest
    Rotation = scipy.spatial.transform.Rotation
    lean = Rotation.from_rotvec(start * rotate_to_heading(subject.at_start.heading)[axis - 3])
    attitude = lean * Rotation.from_quat(rest[1], scalar_first=True)
    data.qpos[q : q + 3] = centre - attitude.apply(subject.centre)
    data.qpos[q + 3 : q + 7] = attitude.as_quat(scalar_first=True)
    return rest


def _swing(
    subject: Subject,
    steps: int,
    axis: int,
    rest: tuple[NDArray[np.float64], NDArray[np.float64]],
    start: float,
) -> Track:
    """Step until what is left of the motion is small."""
    stepper = Stepper(subject, steps)
    tracks = []
    for _ in range(MOST_BLOCKS):
        tracks.append(stepper.take(BLOCK * SAMPLES))
        last = _read_motion(tracks[-1], subject, axis, rest)
        if np.ptp(last[-SAMPLES:]) < LEAST * abs(start):
            break
    return join_tracks(tracks)


def _read_motion(
    track: Track,
    subject: Subject,
    axis: int,
    rest: tuple[NDArray[np.float64], NDArray[np.float64]],
) -> NDArray[np.float64]:
    """Heave of the centre of gravity [m], or a turn about an axis along the heading [rad] (n,)."""
    Rotation = scipy.spatial.transform.Rotation
    attitudes = Rotation.from_quat(track.quaternions, scalar_first=True)
    before = Rotation.from_quat(rest[1], scalar_first=True)
    if axis == MOTIONS.index("heave"):
        centre = track.positions + attitudes.apply(subject.centre)
        return np.asarray(centre[:, 2] - (rest[0] + before.apply(subject.centre))[2], float)
    axes = rotate_to_heading(subject.at_start.heading)
    turns = (attitudes * before.inv()).as_rotvec() @ axes.T
    return np.asarray(turns[:, axis - 3], float)
