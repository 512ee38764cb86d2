"""`Stepper`: steps a vehicle from sample to sample, natively where nobody else steers it."""

import threading
from collections.abc import Sequence

import mujoco

from buoyancy_mj.engine.c_functions import raise_causes
from buoyancy_mj.engine.instances import plugin_instances
from buoyancy_mj.responses.stations import Station
from buoyancy_mj.responses.subject import Subject
from buoyancy_mj.responses.tracks import Reader, Track
from buoyancy_mj.scenes.divergence import check_finite


def is_native(subject: Subject) -> bool:
    """Whether MuJoCo steps a subject by itself, so that threads can step several at once.

    Controllers are Python, and water that is no part of the model is a callback of the process.
    """
    simulation = subject.simulation
    return bool(plugin_instances(simulation.model)) and not simulation.scene.control


class Stepper:
    """Steps a subject, and keeps a sample after every so many steps.

    Args:
        subject: what is stepped.
        steps: number of steps from one sample to the next.
        station: what holds it; None for nothing.
        columns: indices of the sensor values that are kept.
        stop: set by another thread where stepping shall end.
    """

    def __init__(
        self,
        subject: Subject,
        steps: int,
        station: Station | None = None,
        columns: Sequence[int] = (),
        stop: threading.Event | None = None,
    ) -> None:
        self._stop = stop
        self._simulation = subject.simulation
        self._is_native = is_native(subject)
        self._steps, self._station = steps, station
        self._reader = Reader(subject.simulation.model, subject.root, columns)

    def take(self, count: int) -> Track:
        """Take samples.

        Raises:
            DivergenceError: the simulation left the finite numbers.
            ControlError: a controller failed.
            KeyboardInterrupt: another thread has set `stop`.
        """
        simulation = self._simulation
        model, data = simulation.model, simulation.data
        track = self._reader.start(count)
        for row in range(count):
            if self._is_native:
                with raise_causes():
                    mujoco.mj_step(model, data, nstep=self._steps)
                check_finite(simulation.scene, model, data)
            else:
                simulation.advance(self._steps)
            self._reader.read(data, track, row)
            if self._station is not None:
                self._station.hold(data)
            if self._stop is not None and self._stop.is_set():
                raise KeyboardInterrupt
        return track
