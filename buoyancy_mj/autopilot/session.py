"""`Session`: a run that an autopilot drives, frame by frame, in lock-step."""

import dataclasses
import math
import time
from collections.abc import Callable, Sequence

from buoyancy_mj.autopilot.channels import Channel
from buoyancy_mj.autopilot.link import Link
from buoyancy_mj.autopilot.lockstep import Lockstep, Turn
from buoyancy_mj.autopilot.packets import Servos, write_answer
from buoyancy_mj.autopilot.pulses import PulseMap
from buoyancy_mj.autopilot.readings import Readings
from buoyancy_mj.errors import AutopilotError
from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.scenes.simulation import Simulation
from buoyancy_mj.scenes.summary import Summary


class Session:
    """A simulation with an autopilot that drives one of its vehicles.

    Args:
        simulation: the run, at its start.
        vehicle: the vehicle that is driven.
        channels: which output drives which actuator, see `connect`.
        rate: number of steps in a second [Hz], whatever rate the autopilot asks for; None for its.

    Raises:
        AutopilotError: an actuator without a range, or a timestep that does not divide a step.

    Example:
        `with Link() as link: Session(simulation, vehicle, channels).fly(link, patience=60.0)`
    """

    def __init__(
        self,
        simulation: Simulation,
        vehicle: Vehicle,
        channels: Sequence[Channel],
        rate: float | None = None,
    ) -> None:
        self.simulation = simulation
        """The run."""
        self.frames = 0
        """Frames of the autopilot so far."""
        self.asked_rate: int | None = None
        """Rate [Hz] that the last packet asked for."""
        self.lockstep = Lockstep(simulation.model.opt.timestep, rate)
        """The count of the frames."""
        self._pulses = PulseMap(simulation.model, channels)
        self._readings = Readings(simulation, vehicle)
        self._line = b""
        self._recorded = 0.0
        self._wall_time = 0.0

    def fly(
        self,
        link: Link,
        *,
        patience: float | None,
        first: Servos | None = None,
        duration: float = math.inf,
        add: Callable[[Frame], None] | None = None,
    ) -> Servos | None:
        """Run until the autopilot is silent, starts anew, or a time is over.

        Each packet with the next count of frames takes the run one step further. A packet that
        comes again gets the last answer again. Packets that were lost are counted.

        Args:
            link: where the autopilot is heard.
            patience: how long it may be silent [s]; None for ever.
            first: a packet that was received already.
            duration: simulated time after which to end [s].
            add: is called with a frame at time 0, then at the scene's record rate.

        Returns:
            The first packet of the autopilot's next start, if it started anew.

        Raises:
            AutopilotError: the timestep does not divide a frame, or channels are missing.
            DivergenceError: see `Simulation.step`.
        """
        if add is not None:
            add(self.simulation.frame())
        servos = self._follow(link, patience, first, duration, add)
        if add is not None and self._recorded < self._due():
            add(self.simulation.frame())
        return servos

    def is_over(self, duration: float) -> bool:
        """Whether a simulated time has passed [s]."""
        return float(self.simulation.data.time) >= duration - 1e-9

    def summary(self) -> Summary:
        """Sum up the run so far; its time lasts from the first packet to the last answer."""
        summary = self.simulation.summary()
        wall_time = self._wall_time
        return dataclasses.replace(
            summary,
            wall_time=wall_time,
            real_time_factor=summary.simulated_time / wall_time if wall_time else math.nan,
        )

    def _follow(
        self,
        link: Link,
        patience: float | None,
        first: Servos | None,
        duration: float,
        add: Callable[[Frame], None] | None,
    ) -> Servos | None:
        """Answer packet after packet, as `fly` says."""
        servos = first or link.receive(patience)
        began = time.perf_counter()
        while servos is not None:
            turn = self.lockstep.take(servos.frame)
            if turn is Turn.RESTARTED:
                return servos
            if turn is Turn.NEXT:
                self._advance(servos, add)
                self._line = write_answer(self._readings.read())
            link.answer(self._line)
            self._wall_time = time.perf_counter() - began
            if self.is_over(duration):
                return None
            servos = link.receive(patience)
        return None

    def _advance(self, servos: Servos, add: Callable[[Frame], None] | None) -> None:
        """Take the run one frame of the autopilot further."""
        if self._pulses.highest > len(servos.pulses):
            raise AutopilotError(
                f"output {self._pulses.highest} drives an actuator, and the autopilot sends "
                f"{len(servos.pulses)}; set its parameter SERVO_32_ENABLE to 1"
            )
        substeps = self.lockstep.substeps(servos.rate)
        self.frames += 1
        self.asked_rate = servos.rate

        # its pulses hold for the whole frame
        simulation = self.simulation
        self._pulses.apply(servos.pulses, simulation.data.ctrl)
        for _ in range(substeps):
            simulation.step()
            self._readings.feel()

        # frames for recordings
        if add is not None and self._due() - self._recorded >= 1.0:
            self._recorded = math.floor(self._due())
            add(simulation.frame())

    def _due(self) -> float:
        """How many frames are due for a recording; the small part forgives rounding."""
        return float(self.simulation.data.time) * self.simulation.scene.record_rate + 1e-9
