"""What a model measures, commands and actuates, as lines in a recording."""

from collections.abc import Iterable

import rerun as rr

from buoyancy_mj.vehicle.instruments.instruments import ACTIVATION, CONTROL, FORCE, SENSOR, Channel
from buoyancy_mj.viz.palette import hue

TITLES = {
    SENSOR: "sensors",
    CONTROL: "controls",
    FORCE: "actuator forces",
    ACTIVATION: "activations",
}
"""What plots call each kind of channel."""


def entity(channel: Channel) -> str:
    """The entity of a channel in the recording: instruments/sensor/gyro/x."""
    parts = filter(None, ("instruments", channel.kind, channel.owner, channel.part))
    return "/".join(map(rr.escape_entity_path_part, parts))


def list_plots(channels: Iterable[Channel]) -> dict[str, list[str]]:
    """Entities that each plot shows, by its title: one for each kind and unit."""
    plots: dict[str, list[str]] = {}
    for channel in channels:
        # controls are in whatever unit their actuator takes
        unit = channel.unit or ("-" if channel.kind == SENSOR else "own units")
        plots.setdefault(f"{TITLES[channel.kind]} [{unit}]", []).append(entity(channel))
    return plots


def styles(channels: Iterable[Channel]) -> dict[str, rr.SeriesLines]:
    """The style of each line, by its entity; the text of the legend names owner and part."""
    return {
        entity(channel): rr.SeriesLines(
            colors=[hue(i)],
            names=[".".join(filter(None, (channel.owner, channel.part)))],
            widths=[1.5],
        )
        for i, channel in enumerate(channels)
    }
