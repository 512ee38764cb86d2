"""Controllers of a scene, from tables of plain values as TOML has them."""

import dataclasses
from collections.abc import Mapping
from typing import Any

from buoyancy_mj.errors import SceneError, SceneTypeError, choices, describe
from buoyancy_mj.settings.tables import build
from buoyancy_mj.settings.toml import table_of
from buoyancy_mj.vehicle.control.controller import Control
from buoyancy_mj.vehicle.control.course import Waypoint
from buoyancy_mj.vehicle.control.hold import Hold
from buoyancy_mj.vehicle.control.keyframes import Keyframes
from buoyancy_mj.vehicle.control.lqr import Lqr
from buoyancy_mj.vehicle.control.motion import ControlSensors
from buoyancy_mj.vehicle.control.program import Program

CONTROLS: Mapping[str, type[Control]] = {
    "hold": Hold,
    "lqr": Lqr,
    "keyframes": Keyframes,
    "file": Program,
}
"""Controllers by their kind."""


def controls_from_tables(value: Any, where: str) -> tuple[Control, ...]:
    """The controllers that a table describes, or a list of tables.

    Args:
        value: the table or tables.
        where: how messages call the scene.

    Raises:
        SceneError: an unknown key or kind, or a value that makes no sense.
    """
    if isinstance(value, list):
        return tuple(
            _control_from_table(table, f"{where}: control.{i}") for i, table in enumerate(value)
        )
    return (_control_from_table(value, f"{where}: control"),)


def check_controls(controls: tuple[Control, ...]) -> None:
    """Refuse what is no controller, and controllers of which it is not clear what they steer.

    Raises:
        SceneError: there is such a one.
    """
    for control in controls:
        if not isinstance(control, Control):
            raise SceneError(
                f"control is {describe(control)}; it must be a Hold, Lqr, Keyframes or Program"
            )
    steered = [control.vehicle for control in controls]
    if None in steered and len(controls) > 1:
        raise SceneError(
            f"{len(controls)} controls are given, and one does not say which vehicle it steers; "
            "give each a vehicle = NAME"
        )
    for name in steered:
        if steered.count(name) > 1:
            raise SceneError(f"two controls steer vehicle '{name}'; leave one of them out")


def _control_from_table(value: Any, where: str) -> Control:
    """A controller from a table of its `kind` and its fields."""
    table = dict(table_of(value, where))
    kind = table.pop("kind", None)
    if kind is None:
        raise SceneError(f"{where}: 'kind' is missing; needed is one of {', '.join(CONTROLS)}")
    if not isinstance(kind, str) or kind not in CONTROLS:
        raise SceneTypeError(f"{where}: unknown kind {describe(kind)}; {choices(kind, CONTROLS)}")
    fields: dict[str, Any] = {}
    if kind == "hold":
        fields = _read_inner_tables(table, where)
        known = [*(field.name for field in dataclasses.fields(Hold)), "kind"]
        for key in table:
            if key not in known:
                raise SceneTypeError(f"{where}: unknown key {describe(key)}; {choices(key, known)}")
    return build(CONTROLS[kind], table, where, **fields)


def _read_inner_tables(table: dict[str, Any], where: str) -> dict[str, Any]:
    """What the tables inside that of a hold describe, taken out of it."""
    fields: dict[str, Any] = {}
    if "sensors" in table:
        place = f"{where}.sensors"
        fields["sensors"] = build(ControlSensors, table_of(table.pop("sensors"), place), place)
    if "waypoints" in table:
        waypoints = table.pop("waypoints")
        place = f"{where}.waypoints"
        if not isinstance(waypoints, list):
            raise SceneTypeError(
                f"{place} is {describe(waypoints)}; needed is a list of tables "
                "[[control.waypoints]]"
            )
        fields["waypoints"] = tuple(
            _read_waypoint(waypoint, f"{place}.{i}") for i, waypoint in enumerate(waypoints)
        )
    return fields


def _read_waypoint(value: Any, where: str) -> Waypoint:
    """A way-point from its table, with the table of the controls that it changes."""
    table = dict(table_of(value, where))
    controls = table_of(table.pop("controls", {}), f"{where}.controls")
    return build(Waypoint, table, where, controls=controls)
