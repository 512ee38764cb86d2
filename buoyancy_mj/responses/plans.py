"""`Plan`: the runs of a measurement, each a job that a thread can do."""

import dataclasses
import functools
import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.responses import irregular, regular
from buoyancy_mj.responses.extremes import Sea
from buoyancy_mj.responses.irregular import IrregularResponse
from buoyancy_mj.responses.regular import Channels, RegularResponse
from buoyancy_mj.responses.side_by_side import Job
from buoyancy_mj.responses.subject import prepare
from buoyancy_mj.scenes.scene import Scene
from buoyancy_mj.sea.waves import RegularWave


@dataclasses.dataclass(frozen=True, eq=False)
class Plan:
    """What is to be run."""

    scene: Scene
    """The vehicle, and its water without waves."""
    periods: NDArray[np.float64]
    """Periods of waves (p,) [s]."""
    headings: NDArray[np.float64]
    """Directions that the waves run to, from the vehicle's heading (h,) [rad]."""
    amplitudes: NDArray[np.float64]
    """Amplitudes of regular waves (p,) [m]."""
    depth: float
    """Depth of the water [m]."""
    channels: Channels
    """What is measured beside the six motions."""
    holds: bool
    """Whether a station holds the vehicle."""
    trust: bool
    """Whether to run the Python files that the scene names as controllers."""

    def regular_jobs(self, ahead: float) -> Iterator[Job[RegularResponse]]:
        """A run for each heading and period; `ahead` is the vehicle's own heading [rad]."""
        for heading in self.headings.tolist():
            for period, amplitude in zip(
                self.periods.tolist(), self.amplitudes.tolist(), strict=True
            ):
                # it rises from zero: no speed along the wave at the start, and so no drift
                wave = RegularWave(
                    amplitude,
                    period=period,
                    direction=ahead + heading,
                    phase=0.5 * math.pi,
                    depth=self.depth,
                )
                steps, timestep = regular.choose_steps(period, self.scene.timestep)
                subject = prepare(self.scene, [wave], timestep=timestep, trust=self.trust)
                yield functools.partial(
                    regular.measure_regular, subject, steps, self.channels, hold=self.holds
                )

    def irregular_jobs(self, ahead: float, sea: Sea) -> Iterator[Job[IrregularResponse]]:
        """A run in a sea for each heading; `ahead` is the vehicle's own heading [rad]."""
        for heading in self.headings.tolist():
            own = dataclasses.replace(
                sea,
                direction=ahead + heading,
                depth=self.depth,
                components=max(sea.components, irregular.COMPONENTS),
            )
            steps, timestep = irregular.choose_steps(
                sea.peak_period, float(self.periods.min()), self.scene.timestep
            )
            subject = prepare(self.scene, [own], timestep=timestep, trust=self.trust)
            yield functools.partial(
                irregular.measure_irregular,
                subject,
                steps,
                sea.peak_period,
                self.periods,
                self.channels,
                hold=self.holds,
            )
