"""A summary in words: its rows, with units and with what each number is to be judged by."""

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from buoyancy_mj.scenes.seakeeping import Seakeeping, Spread

if TYPE_CHECKING:
    from buoyancy_mj.scenes.sea_state import SeaState
    from buoyancy_mj.scenes.summary import Summary, VehicleSummary

Row = tuple[str, ...]
"""A name, and the value of each vehicle."""


def list_rows(summary: "Summary") -> list[Row]:
    """The rows of a summary; of several vehicles each has a column, which is kept narrow."""
    alone = len(summary.vehicles) == 1
    tables: list[dict[str, str]] = [
        dict(_describe_vehicle(one, summary.sea, alone=alone)) for one in summary.vehicles.values()
    ]
    names = max(tables, key=len)
    rows: list[Row] = [(name, *(table.get(name, "") for table in tables)) for name in names]
    sensors: list[Row] = [
        (
            f"{name}",
            f"mean {one.mean:.4g}, {one.least:.4g} to {one.greatest:.4g}, rms {one.rms:.3g}",
        )
        for name, one in summary.sensors.items()
    ]
    if not alone:
        return [*rows, *(row for row in sensors)]
    *numbers, contact = rows
    return [
        ("method", summary.method),
        *numbers,
        *sensors,
        ("simulated time", f"{summary.simulated_time:.2f} s"),
        ("real-time factor", f"{summary.real_time_factor:.1f} x"),
        contact,
    ]


def _describe_vehicle(
    one: "VehicleSummary", sea: "SeaState", *, alone: bool
) -> list[tuple[str, str]]:
    """The rows of one vehicle, with comparisons if it is alone."""

    def tell(value: str, beside: str) -> str:
        return f"{value}, {beside}" if alone and beside else value

    verdict = "sinks" if one.net_weight > 0.0 else "floats"
    share = f"{one.displacement / one.mass:.2f} x its mass"
    rows = [
        ("mass", f"{one.mass:.3f} kg"),
        ("displacement, fully under water", tell(f"{one.displacement:.3f} kg", share)),
        ("net weight, fully under water", f"{one.net_weight:+.2f} N ({verdict})"),
        ("peak draft, whole run", tell(f"{one.peak_draft:.3f} m", _beside(one.peak_draft, one))),
        ("final draft", tell(f"{one.final_draft:.3f} m", _beside(one.final_draft, one))),
    ]
    if one.seakeeping.window.length:
        rows += _describe_motions(one.seakeeping, sea, tell)
    if one.updates_at_limits is not None:
        rows.append(("controls at their limits", f"{one.updates_at_limits} updates"))
    contact = (
        f"{one.contact_steps} steps, first at {one.first_contact:.2f} s"
        if one.contact_steps
        else "none"
    )
    return [*rows, ("contact with the bottom or walls", contact)]


def _beside(draft: float, one: "VehicleSummary") -> str:
    """A draft beside the height of the vehicle."""
    if draft <= 0.0:
        return "out of the water"
    share = draft / one.height
    return f"{share:.2f} of its height" if share < 1.0 else f"under water: {one.height:.3g} m high"


def _describe_motions(
    motions: Seakeeping, sea: "SeaState", tell: Callable[[str, str], str]
) -> list[tuple[str, str]]:
    """The rows of how a vehicle moved."""
    over = motions.window.name
    waves = (
        "still" if sea.is_still else f"{sea.height:.3g} m high, longest period {sea.period:.3g} s"
    )
    x, y = motions.drift
    towards = f"towards {math.degrees(math.atan2(y, x)):.0f} degrees"
    wet = motions.deck_wetness
    return [
        ("waves", waves),
        ("measured over", tell(motions.window.text, over)),
        (f"heave, {over}", tell(_tell(motions.heave, "m"), _compare(motions.heave.range, sea))),
        (f"surge, {over}", tell(_tell(motions.surge, "m"), _compare(motions.surge.range, sea))),
        (f"roll, {over}", _tell(motions.roll, "degrees", 180.0 / math.pi)),
        (f"pitch, {over}", _tell(motions.pitch, "degrees", 180.0 / math.pi)),
        (f"drift, {over}", tell(f"{motions.drift_speed:.3g} m/s", towards)),
        (
            f"acceleration rms, {over}",
            f"{motions.vertical_acceleration.rms:.3g} up, "
            f"{motions.horizontal_acceleration_rms:.3g} m/s^2 level",
        ),
        ("peak acceleration, whole run", f"{motions.peak_acceleration:.3g} m/s^2"),
        (
            "peak load, whole run",
            tell(f"{motions.peak_load:.4g} N", f"{motions.load_factor:.3g} x its weight"),
        ),
        (f"deck under water, {over}", f"{100.0 * wet:.0f} % of the time"),
        ("slams of the bow, whole run", f"{motions.slams}"),
    ]


def _tell(spread: Spread, unit: str, scale: float = 1.0) -> str:
    """A motion, with its unit."""
    width, rms, significant = (
        f"{scale * value:.3g}" for value in (spread.range, spread.rms, spread.significant)
    )
    return f"range {width}, rms {rms}, significant {significant} {unit}"


def _compare(width: float, sea: "SeaState") -> str:
    """A range beside the waves."""
    return "" if sea.is_still else f"{width / sea.height:.2f} x the waves"
