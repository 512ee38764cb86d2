"""`Run`: what is asked of a run to record it, be it a scene's or somebody's own loop."""

import dataclasses
import json
from collections.abc import Mapping
from typing import Protocol

import mujoco

from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.engine.finding import find_callback_water
from buoyancy_mj.engine.instances import plugin_instances
from buoyancy_mj.engine.plugin import water_in
from buoyancy_mj.errors import ModelError, describe
from buoyancy_mj.scenes.fleet import Vehicle, find_vehicles
from buoyancy_mj.settings.config import has_texts, write_plugin_config


class Run(Protocol):
    """A model that moves in water."""

    @property
    def title(self) -> str:
        """What it is called."""

    @property
    def text(self) -> str:
        """What it consists of, as TOML."""

    @property
    def model(self) -> mujoco.MjModel:
        """The model."""

    @property
    def data(self) -> mujoco.MjData:
        """Its state at present."""

    @property
    def buoyancy(self) -> Buoyancy:
        """The water that acts."""

    @property
    def vehicles(self) -> Mapping[str, Vehicle]:
        """What floats, by name."""


@dataclasses.dataclass(frozen=True, eq=False)
class OwnRun:
    """A loop of somebody's own over a model and its data, as `Run` says."""

    model: mujoco.MjModel
    """The model."""
    data: mujoco.MjData
    """Its data, which the loop steps."""
    buoyancy: Buoyancy
    """The water that acts."""
    vehicles: Mapping[str, Vehicle]
    """What floats, by the names of root bodies."""

    @property
    def title(self) -> str:
        """The names of what floats."""
        return ", ".join(self.vehicles)

    @property
    def text(self) -> str:
        """The water as the keys of the plugin; where these cannot hold it, in a line."""
        settings = self.buoyancy.settings
        if not has_texts(settings):
            return f"# {self.buoyancy!r}"
        texts = write_plugin_config(settings)
        lines = {key: json.dumps(text, ensure_ascii=False) for key, text in texts.items() if text}
        return "\n".join(f"{key} = {text}" for key, text in lines.items())


def find_run(
    model: mujoco.MjModel, data: mujoco.MjData, buoyancy: Buoyancy | None = None
) -> OwnRun:
    """A model and its data as a run, with the water that acts.

    Args:
        model: the model.
        data: its data.
        buoyancy: the water; None for that of the model itself, or else the one that is a callback
            of MuJoCo now.

    Raises:
        ModelError: these are no model and data of it, no water acts on the model, or several do and
            none is named.
    """
    if not isinstance(model, mujoco.MjModel):
        raise ModelError(f"model is {describe(model)}; it must be a mujoco.MjModel")
    if not isinstance(data, mujoco.MjData):
        raise ModelError(f"data is {describe(data)}; it must be the mujoco.MjData of the model")
    if data.model._address != model._address:
        raise ModelError("data is of another model; make it of this one, mujoco.MjData(model)")
    if buoyancy is None:
        has_own = bool(plugin_instances(model))
        buoyancy = water_in(model) if has_own else find_callback_water(model)
    elif not isinstance(buoyancy, Buoyancy):
        raise ModelError(f"buoyancy is {describe(buoyancy)}; it must be a Buoyancy")
    elif not plugin_instances(model) and buoyancy.model._address != model._address:
        raise ModelError("buoyancy is of another model; make it of this one, Buoyancy(model, ...)")
    return OwnRun(model, data, buoyancy, find_vehicles(model, buoyancy))


def place_at_start(run: Run) -> mujoco.MjData:
    """Data with the poses of a run as it stands, without a step of its own."""
    data = mujoco.MjData(run.model)
    data.qpos[:] = run.data.qpos
    mujoco.mj_kinematics(run.model, data)
    return data
