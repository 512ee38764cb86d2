"""The picture: time of a submersion against triangles, and where a step goes."""

import textwrap
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import profile, submersion
from benchmarks.peers import PEERS
from benchmarks.rows import describe_time


def draw_speed(path: Path, results: dict[str, Any]) -> None:
    """Draw what was measured of both; nothing where neither was."""
    from buoyancy_mj.plotting.style import new_figure, save_figure, use_style

    draws = {"submersion": _draw_submersion, "profile": _draw_profile}
    names = [name for name in draws if name in results]
    if not names:
        return
    with use_style():
        figure = new_figure(6.5 * len(names), 4.8)
        for axes, name in zip(figure.subplots(1, len(names), squeeze=False)[0], names, strict=True):
            draws[name](axes, results[name])
        save_figure(figure, path)


def _draw_submersion(axes: Any, results: submersion.Results) -> None:
    """Draw time against triangles of the sphere, with the fitted exponents."""
    rows = list(results["sphere"].values())
    names = {"still": "still water", "waves": "in a wave"} | {peer: peer for peer in PEERS}
    for column, name in names.items():
        points = [(row["triangles"], row[column] * 1e6) for row in rows if column in row]
        if points:
            exponent = submersion.exponent(rows, column)
            label = f"{name}, n^{exponent:.2f}" if np.isfinite(exponent) else name
            width = 1.2 if column in PEERS else 2.5
            axes.loglog(*zip(*points, strict=True), marker="o", lw=width, label=label)
    axes.set(
        xlabel="triangles",
        ylabel="time of one submersion [us]",
        title="a sphere in random attitudes",
    )
    axes.legend(ncols=3, loc="upper center", bbox_to_anchor=(0.5, -0.14))


def _draw_profile(axes: Any, results: profile.Results) -> None:
    """Draw the parts of a step side by side, a bar for each scene."""
    scenes = list(reversed(results))
    starts = np.zeros(len(scenes))
    for part in profile.list_columns(results):
        shares = np.array(
            [
                100.0 * results[scene].get(part, 0.0) / results[scene][profile.STEP]
                for scene in scenes
            ]
        )
        axes.barh(range(len(scenes)), shares, left=starts, label=part)
        starts += shares
    labels = [
        f"{textwrap.fill(scene, 28)}\n{describe_time(results[scene][profile.STEP])}"
        for scene in scenes
    ]
    axes.set_yticks(range(len(scenes)), labels)
    axes.set(xlabel="part of a step [%]", title="where a step goes")
    axes.legend(ncols=4, loc="upper center", bbox_to_anchor=(0.4, -0.14))
