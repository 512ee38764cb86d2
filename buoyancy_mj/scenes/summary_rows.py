"""A summary in words: its rows, with units and with what each number is to be judged by."""

import math
from typing import TYPE_CHECKING

from buoyancy_mj.scenes.seakeeping import Seakeeping, Spread

if TYPE_CHECKING:
    from buoyancy_mj.scenes.natural_periods import Periods
    from buoyancy_mj.scenes.sea_state import SeaState
    from buoyancy_mj.scenes.summary import Summary, VehicleSummary

Row = tuple[str, ...]
"""A name, and the value of each vehicle."""
_Pairs = list[tuple[str, str]]


def list_rows(summary: "Summary") -> list[Row]:
    """The rows of a summary.

    The only vehicle's values stand beside what they are to be judged by. Several vehicles have a
    narrow column each, and what holds for all of them stands in the caption.
    """
    names = list(summary.vehicles)
    if len(names) > 1:
        return list_numbers(summary)
    ((name, one),) = summary.vehicles.items()
    *numbers, contact = _compare_numbers(one, summary.sea, summary.natural_periods.get(name))
    return [
        ("method", summary.method),
        *numbers,
        *_list_sensors(summary),
        ("simulated time", f"{summary.simulated_time:.2f} s"),
        ("real-time factor", f"{summary.real_time_factor:.1f} x"),
        contact,
    ]


def list_numbers(summary: "Summary") -> list[Row]:
    """The rows of a summary without comparisons, narrow enough for a column for each vehicle."""
    tables = [dict(_list_numbers(one)) for one in summary.vehicles.values()]
    longest = max(tables, key=len)
    return [(name, *(table.get(name, "") for table in tables)) for name in longest]


def write_caption(summary: "Summary") -> str:
    """What holds for all vehicles of a run."""
    window = next(iter(summary.vehicles.values())).seakeeping.window
    sentences = [
        f"method {summary.method}, {summary.simulated_time:.2f} s simulated at "
        f"{summary.real_time_factor:.1f} x real time",
        f"{_describe_sea(summary.sea)}; {window.name}: {window.text}",
        *(f"{name}: {value}" for name, value in _list_sensors(summary)),
    ]
    return ";\n".join(sentences)


def _list_numbers(one: "VehicleSummary") -> _Pairs:
    """The rows of one vehicle among several: a number each."""
    motions = one.seakeeping
    over = motions.window.name
    degrees = 180.0 / math.pi
    rows = [
        ("mass", f"{one.mass:.3f} kg"),
        ("displacement under water", f"{one.displacement:.3f} kg"),
        ("net weight under water", _describe_weight(one)),
        ("peak draft, whole run", f"{one.peak_draft:.3f} m"),
        ("final draft", f"{one.final_draft:.3f} m"),
    ]
    if motions.window.length:
        rows += [
            (f"heave range, {over}", f"{motions.heave.range:.3f} m"),
            (f"surge range, {over}", f"{motions.surge.range:.3f} m"),
            (f"roll range, {over}", f"{degrees * motions.roll.range:.2f} degrees"),
            (f"pitch range, {over}", f"{degrees * motions.pitch.range:.2f} degrees"),
            (f"drift, {over}", f"{motions.drift_speed:.3f} m/s"),
            (f"heave acceleration rms, {over}", f"{motions.vertical_acceleration.rms:.2f} m/s^2"),
            ("peak acceleration, whole run", f"{motions.peak_acceleration:.2f} m/s^2"),
            ("peak load, whole run", f"{motions.peak_load:.4g} N"),
            (f"deck wet, {over}", _describe_share(motions.deck_wetness)),
            ("bow slams, whole run", f"{motions.slams}"),
        ]
    return [*rows, *_list_events(one)]


def _compare_numbers(one: "VehicleSummary", sea: "SeaState", periods: "Periods | None") -> _Pairs:
    """The rows of the only vehicle, beside what they are to be judged by."""
    rows = [
        ("mass", f"{one.mass:.3f} kg"),
        (
            "displacement under water",
            f"{one.displacement:.3f} kg, {one.displacement / one.mass:.2f} x its mass",
        ),
        ("net weight under water", _describe_weight(one)),
        ("peak draft, whole run", _describe_draft(one.peak_draft, one.height)),
        ("final draft", _describe_draft(one.final_draft, one.height)),
        ("waves", _describe_sea(sea)),
    ]
    if periods is not None:
        heave, roll, pitch = (f"{period:.3g}" for period in periods[:3])
        how = "with" if periods.with_added_mass else "without"
        told = f"heave {heave}, roll {roll}, pitch {pitch} s ({how} added mass)"
        rows.append(("natural periods", told))
    if one.seakeeping.window.length:
        rows += _compare_motions(one.seakeeping, sea)
    return [*rows, *_list_events(one)]


def _compare_motions(motions: Seakeeping, sea: "SeaState") -> _Pairs:
    """The rows of how the only vehicle moved."""
    over = motions.window.name
    x, y = motions.drift
    towards = f", towards {math.degrees(math.atan2(y, x)):.0f} degrees"
    if motions.drift_speed < 0.0005:
        towards = ""
    up, level = motions.vertical_acceleration.rms, motions.horizontal_acceleration_rms
    load = f"{motions.peak_load:.4g} N, {motions.load_factor:.2f} x its weight"
    return [
        (over, motions.window.text),
        (f"heave, {over}", _describe_motion(motions.heave, "m", sea=sea)),
        (f"surge, {over}", _describe_motion(motions.surge, "m", sea=sea)),
        (f"roll, {over}", _describe_motion(motions.roll, "deg")),
        (f"pitch, {over}", _describe_motion(motions.pitch, "deg")),
        (f"drift, {over}", f"{motions.drift_speed:.3f} m/s{towards}"),
        (f"acceleration rms, {over}", f"{up:.2f} up, {level:.2f} m/s^2 level"),
        ("peak acceleration, whole run", f"{motions.peak_acceleration:.2f} m/s^2"),
        ("peak load, whole run", load),
        (f"deck wet, {over}", _describe_share(motions.deck_wetness)),
        ("bow slams, whole run", f"{motions.slams}"),
    ]


def _list_events(one: "VehicleSummary") -> _Pairs:
    """What happened to a vehicle on its way."""
    contact = "none"
    if one.contact_steps:
        contact = f"{one.contact_steps} steps, first at {one.first_contact:.2f} s"
    limits = one.updates_at_limits
    steered = [] if limits is None else [("controls at their limits", f"{limits} updates")]
    return [*steered, ("contact with bottom or walls", contact)]


def _list_sensors(summary: "Summary") -> _Pairs:
    """What sensors measured."""
    return [
        (name, f"mean {one.mean:.4g}, {one.least:.4g} to {one.greatest:.4g}, rms {one.rms:.3g}")
        for name, one in summary.sensors.items()
    ]


def _describe_weight(one: "VehicleSummary") -> str:
    """Weight less greatest buoyancy, and what comes of it."""
    return f"{one.net_weight:+.2f} N ({'sinks' if one.net_weight > 0.0 else 'floats'})"


def _describe_draft(draft: float, height: float) -> str:
    """A draft beside the height of the vehicle."""
    if draft <= 0.0:
        return f"{draft:.3f} m, out of the water"
    if draft < height:
        return f"{draft:.3f} m, {draft / height:.2f} of its height"
    return f"{draft:.3f} m, more than its height of {height:.3g} m"


def _describe_sea(sea: "SeaState") -> str:
    """How high and long the waves are."""
    if sea.is_still:
        return "still water"
    return f"{sea.height:.3g} m high, longest period {sea.period:.3g} s"


def _describe_motion(spread: Spread, unit: str, sea: "SeaState | None" = None) -> str:
    """A motion; lengths beside the height of the waves."""
    scale, digits = (180.0 / math.pi, 2) if unit == "deg" else (1.0, 3)
    width, rms, significant = (
        f"{scale * value:.{digits}f}" for value in (spread.range, spread.rms, spread.significant)
    )
    told = f"range {width} {unit}, rms {rms}, significant {significant}"
    if sea is None or sea.is_still:
        return told
    return f"{told}, range {spread.range / sea.height:.2f} x the waves"


def _describe_share(share: float) -> str:
    """A share of the time."""
    return f"{100.0 * share:.0f} % of the time"
