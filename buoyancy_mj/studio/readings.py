"""What the panel writes of a readout: rows of text, and traces for its plots."""

import collections
import math
from collections.abc import Iterator

from buoyancy_mj.studio.readouts import Readout, VehicleReadout

SPAN = 30.0
"""Time that a plot shows [s]."""
MOST = 1200
"""Most readouts that a plot keeps."""
PLOTS = ("draft", "heel and trim", "energy")
"""What is plotted over time."""
UNITS = {"draft": "m", "heel and trim": "deg", "energy": "J"}
"""Units of the plots."""


def list_rows(readout: VehicleReadout) -> list[tuple[str, str]]:
    """What a vehicle does, as rows of a name and a number with its unit."""
    return [
        ("draft", f"{readout.draft:.4f} m"),
        ("heel", _write_degrees(readout.heel)),
        ("trim", _write_degrees(readout.trim)),
        ("volume", f"{1e3 * readout.volume:.4g} l"),
        ("displacement", f"{readout.displacement:.4g} kg"),
        ("mass", f"{readout.mass:.4g} kg"),
    ]


def list_forces(readout: VehicleReadout) -> list[tuple[str, ...]]:
    """The force of the water by cause: a name, and the components along x, y and z [N]."""
    return [
        (cause.replace("_", " "), *(f"{round(component, 1) + 0.0:+.1f}" for component in force))
        for cause, force in readout.forces.items()
    ]


def list_channels(readout: Readout) -> list[tuple[str, str]]:
    """What sensors measure and actuators give, as rows of a name and a number with its unit."""
    return [
        (channel.name, "-" if math.isnan(number) else f"{number:+.4g} {channel.unit}".rstrip())
        for channel, number in readout.channels
    ]


def _write_degrees(angle: float) -> str:
    """An angle [rad] in degrees, and no zero with a minus."""
    return f"{round(math.degrees(angle), 2) + 0.0:+.2f} deg"


class Traces:
    """The course of each vehicle over the last half minute."""

    def __init__(self) -> None:
        self._readouts: collections.deque[Readout] = collections.deque(maxlen=MOST)

    def add(self, readout: Readout) -> None:
        """Add a readout; one of an earlier time, or of other vehicles, begins anew."""
        if self._readouts:
            last = self._readouts[-1]
            if readout.time < last.time or readout.vehicles.keys() != last.vehicles.keys():
                self._readouts.clear()
            elif readout.time == last.time:
                return
        self._readouts.append(readout)
        while self._readouts[0].time < readout.time - SPAN:
            self._readouts.popleft()

    def times(self) -> list[float]:
        """The times of what is kept [s]."""
        return [readout.time for readout in self._readouts]

    def lines(self, plot: str, vehicle: str) -> Iterator[tuple[str, list[float]]]:
        """The lines of a plot of `PLOTS`, in its unit, each with a name."""
        seen = [readout.vehicles[vehicle] for readout in self._readouts]
        if plot == "draft":
            yield "draft", [one.draft for one in seen]
        elif plot == "heel and trim":
            yield "heel", [math.degrees(one.heel) for one in seen]
            yield "trim", [math.degrees(one.trim) for one in seen]
        else:
            for name in ("kinetic", "potential", "buoyancy", "total"):
                values = [float(getattr(one.energy, name)) for one in seen]
                # what matters is how it changes
                yield name, [value - values[0] for value in values]
