"""`respond`: response amplitude operators of a vehicle, by regular waves or in an irregular sea."""

import contextlib
import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import ResponseError, describe
from buoyancy_mj.responses.extremes import Sea
from buoyancy_mj.responses.notes import write_notes
from buoyancy_mj.responses.plans import Plan
from buoyancy_mj.responses.regular import Channels
from buoyancy_mj.responses.responses import Responses, list_names
from buoyancy_mj.responses.sensors import find_columns
from buoyancy_mj.responses.side_by_side import run_side_by_side
from buoyancy_mj.responses.stepping import is_native
from buoyancy_mj.responses.subject import Subject, prepare, read_subject
from buoyancy_mj.scenes.scene import Scene
from buoyancy_mj.sea.dispersion import wavenumber
from buoyancy_mj.sea.ranges import read_depth
from buoyancy_mj.sea.spectra import JonswapSea, PiersonMoskowitzSea
from buoyancy_mj.values import read_array, read_number

PART_OF_DRAFT = 0.05
"""Amplitude of the waves by default, as a part of the vehicle's draft, or of its freeboard where
that is less; see `STEEPNESS`."""
STEEPNESS = 0.01
"""Height over length that such waves do not exceed."""
MOST_RUNS = 100_000
"""Most runs of one measurement."""


def respond(
    subject: str | Path | Scene,
    periods: ArrayLike,
    headings: ArrayLike = math.pi,
    *,
    amplitude: float | None = None,
    sea: Sea | None = None,
    sensors: Sequence[str] = (),
    points: Sequence[Sequence[float]] = (),
    depth: float | None = None,
    settings: Sequence[str] = (),
    threads: int = 0,
    trust: bool = False,
    each: Callable[[], object] = lambda: None,
) -> Responses:
    """Measure what a vehicle answers to waves.

    It runs in regular waves, one for each period and heading, until the transient has died down:
    its response is the first harmonic over whole periods. Or it runs in one irregular sea for each
    heading, and cross-spectra give the same, with the coherence. A soft station keeps the vehicle
    at its place and heading, and has no part in its motions in waves, see `stations.Station`.

    Args:
        subject: a scene, or a model or scene by its file or name. A model is put into fresh water
            at rest, with the pressure of Froude and Krylov and the added mass of its meshes.
        periods: of the waves [s], one or several.
        headings: directions that the waves run to, from the vehicle's heading [rad], one or
            several: 0 for a following sea, pi for a head sea.
        amplitude: of the regular waves [m]; None for a twentieth of the draft or freeboard, and a
            height of at most a hundredth of the length.
        sea: an irregular sea to run in, in the place of regular waves; its direction is the
            heading.
        sensors: names of sensors that are measured too, or NAME.0 and so on for one value.
        points: points fixed to the root body that are measured too, each (3,) [m] in its frame.
        depth: of the water [m]; that of the scene's waves if None, and else deep.
        settings: texts KEY=VALUE laid over the scene, as for `--set`; not for a `Scene`.
        threads: number of threads that step at once; 0 for one per core.
        trust: whether to run the Python files that the scene names as controllers.
        each: called after each run.

    Raises:
        ResponseError: periods, headings, an amplitude, a sensor or a sea that make no sense; a
            scene with several vehicles or a current.
        SceneError, ModelError: what `read_scene` and `Simulation` raise.
        DivergenceError: a run left the finite numbers.

    Example:
        `respond("catamaran", periods=[4.0, 6.0], headings=math.pi).find("heave")`
    """
    scene = subject if isinstance(subject, Scene) else read_subject(subject, settings)
    waves = _read_list("periods", periods, above=0.0)
    angles = _read_list("headings", headings)
    if len(waves) * len(angles) > MOST_RUNS:
        raise ResponseError(
            f"that would be {len(waves) * len(angles)} runs; there may be {MOST_RUNS} at most, so "
            "give fewer periods or headings"
        )
    if amplitude is not None:
        amplitude = read_number(ResponseError, "amplitude", amplitude, above=0.0)
    if sea is not None:
        check_sea(sea)

    # the vehicle in still water tells what there is to measure
    first = prepare(scene, trust=trust)
    columns, sensor_names = find_columns(first.simulation.model, sensors)
    places = [tuple(read_array(ResponseError, "a point", point, (3,)).tolist()) for point in points]
    deep = _find_depth(scene) if depth is None else read_depth(depth)
    omegas = (2.0 * math.pi / waves).tolist()
    k = np.array([wavenumber(omega, deep, first.at_start.gravity) for omega in omegas])
    plan = Plan(
        scene=scene,
        periods=waves,
        headings=angles,
        amplitudes=_choose_amplitudes(k, first, amplitude),
        depth=deep,
        channels=Channels(tuple(places), columns),
        holds=not first.tether and not scene.control,
        trust=trust,
    )

    # the runs
    names, units = list_names(len(places), sensor_names)
    found = _measure(plan, first, sea, len(names), threads if is_native(first) else 1, each)
    return Responses(
        title=scene.title,
        notes=write_notes(plan, first, sea),
        headings=angles,
        periods=waves,
        wavenumbers=k,
        amplitudes=plan.amplitudes if sea is None else np.full(len(waves), math.nan),
        names=names,
        units=units,
        natural_periods=first.natural_periods,
        density=first.at_start.density,
        gravity=first.at_start.gravity,
        depth=deep,
        **found,
    )


def check_sea(sea: object) -> None:
    """Refuse a sea without a spectrum, or with waves from all sides.

    Raises:
        ResponseError: it is one.
    """
    if not isinstance(sea, JonswapSea | PiersonMoskowitzSea):
        raise ResponseError(
            f"the sea is {describe(sea)}; it must be a JonswapSea or a PiersonMoskowitzSea"
        )
    if math.isfinite(sea.spreading):
        raise ResponseError(
            f"the sea has a spreading of {sea.spreading:g}, and responses are told for long crests "
            "from one heading; leave spreading out"
        )


def _measure(
    plan: Plan,
    first: Subject,
    sea: Sea | None,
    count: int,
    threads: int,
    each: Callable[[], object],
) -> dict[str, Any]:
    """Run everything; the fields of `Responses` that come of it."""
    shape = len(plan.headings), len(plan.periods), count
    transfer = np.zeros(shape, complex)
    sure = np.ones(shape, bool)
    cycles, turned = np.zeros(shape[:2], np.int64), np.zeros(shape[:2])
    ahead = first.at_start.heading
    if sea is not None:
        coherence = np.zeros(shape)
        with contextlib.closing(run_side_by_side(plan.irregular_jobs(ahead, sea), threads)) as done:
            for row, in_sea in enumerate(done):
                transfer[row], coherence[row], sure[row], turned[row] = in_sea
                each()
        return {
            "transfer": transfer,
            "sure": sure,
            "coherence": coherence,
            "cycles": cycles,
            "turned": turned,
        }
    with contextlib.closing(run_side_by_side(plan.regular_jobs(ahead), threads)) as done:
        for row, in_wave in enumerate(done):
            at = divmod(row, len(plan.periods))
            transfer[at], sure[at], cycles[at] = in_wave.transfer, in_wave.settled, in_wave.periods
            turned[at] = in_wave.turned
            each()
    return {
        "transfer": transfer,
        "sure": sure,
        "coherence": None,
        "cycles": cycles,
        "turned": turned,
    }


def _read_list(name: str, values: ArrayLike, above: float = -math.inf) -> NDArray[np.float64]:
    """One or several finite numbers as an array."""
    array = np.atleast_1d(np.asarray(values, float))
    if array.ndim != 1 or not array.size or not np.isfinite(array).all() or array.min() <= above:
        wanted = "finite numbers" if math.isinf(above) else f"finite numbers above {above:g}"
        raise ResponseError(f"{name} is {describe(values)}; it must be one or several {wanted}")
    return array


def _choose_amplitudes(
    wavenumbers: NDArray[np.float64], first: Subject, amplitude: float | None
) -> NDArray[np.float64]:
    """Amplitudes of the waves (p,) [m]."""
    if amplitude is not None:
        return np.full(len(wavenumbers), amplitude)
    at = first.at_start
    tall = first.simulation.vehicle.length
    if at.waterplane_area > 0.0:
        tall = min(at.draft, first.freeboard)
    return np.minimum(PART_OF_DRAFT * tall, STEEPNESS * math.pi / wavenumbers)


def _find_depth(scene: Scene) -> float:
    """Depth of the water of a scene's waves [m]; the least where they differ, inf without."""
    depths = [float(getattr(wave, "depth", math.inf)) for wave in scene.water._waves]
    return min(depths, default=math.inf)
