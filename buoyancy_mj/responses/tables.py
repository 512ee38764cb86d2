"""Responses as rows of CSV and as plain values."""

import csv
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from buoyancy_mj.files import replace_file
from buoyancy_mj.responses.extremes import HOURS_3, Sea
from buoyancy_mj.responses.responses import Responses


def write_responses_csv(responses: Responses, path: Path) -> None:
    """Write a row for each heading and period.

    Raises:
        OSError: the file cannot be written.
    """
    rows = list(list_rows(responses))
    with replace_file(path) as part, part.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def list_rows(responses: Responses) -> Iterator[dict[str, float | int | str]]:
    """A row for each heading and period, by columns whose names have units.

    Each response has its size over the wave's amplitude, its phase behind the crest, and whether it
    is sure; turns have their size over the wave's slope too.
    """
    units = responses.units_of()
    degrees = np.degrees(responses.headings)
    for h, heading in enumerate(degrees.tolist()):
        for p, period in enumerate(responses.periods.tolist()):
            row: dict[str, float | int | str] = {
                "heading [deg]": round(heading, 9),
                "period [s]": period,
                "omega [rad/s]": float(responses.omegas[p]),
                "wavenumber [rad/m]": float(responses.wavenumbers[p]),
                "amplitude [m]": float(responses.amplitudes[p]),
                "cycles": int(responses.cycles[h, p]),
            }
            for c, name in enumerate(responses.names):
                row[f"{name} [{units[c]}]"] = float(responses.sizes[h, p, c])
                row[f"{name} phase [deg]"] = math.degrees(float(responses.phases[h, p, c]))
                if responses.units[c] == "rad":
                    row[f"{name} over slope"] = float(responses.normal_sizes[h, p, c])
                if responses.coherence is not None:
                    row[f"{name} coherence"] = float(responses.coherence[h, p, c])
                row[f"{name} sure"] = int(responses.sure[h, p, c])
            yield row


def to_values(
    responses: Responses, sea: Sea | None = None, duration: float = HOURS_3
) -> dict[str, Any]:
    """All that was measured as plain values, as JSON has them; None where nothing is finite."""
    values: dict[str, Any] = {
        "title": responses.title,
        "notes": [*responses.notes, *responses.doubts()],
        "density": responses.density,
        "gravity": responses.gravity,
        "depth": responses.depth,
        "natural_periods": dict(
            zip(("heave", "roll", "pitch"), responses.natural_periods.tolist(), strict=True)
        ),
        "headings": responses.headings.tolist(),
        "periods": responses.periods.tolist(),
        "wavenumbers": responses.wavenumbers.tolist(),
        "amplitudes": responses.amplitudes.tolist(),
        "cycles": responses.cycles.tolist(),
        "responses": {
            name: {
                "unit": responses.units_of()[c],
                "size": responses.sizes[:, :, c].tolist(),
                "phase": responses.phases[:, :, c].tolist(),
                "sure": responses.sure[:, :, c].tolist(),
            }
            | (
                {}
                if responses.coherence is None
                else {"coherence": responses.coherence[:, :, c].tolist()}
            )
            for c, name in enumerate(responses.names)
        },
    }
    if sea is not None:
        found = responses.in_sea(sea, duration)
        values["sea"] = {
            "significant_height": sea.significant_height,
            "peak_period": sea.peak_period,
            "duration": duration,
            "covered": responses.covers(sea),
            "responses": {
                name: [by_name[c]._asdict() for by_name in found]
                for c, name in enumerate(responses.names)
            },
        }
    return dict(finite_values(values))


def finite_values(value: Any) -> Any:
    """The same values, but None for each number that is not finite, which JSON does not know."""
    if isinstance(value, dict):
        return {key: finite_values(item) for key, item in value.items()}
    if isinstance(value, list):
        return [finite_values(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
