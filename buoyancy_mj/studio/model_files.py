"""A model's file as a scene of its own, and what the inspection says of it."""

import contextlib
import dataclasses
import warnings
from collections.abc import Iterator
from pathlib import Path

import mujoco
import numpy as np
import scipy

from buoyancy_mj.engine.instances import plugin_instances
from buoyancy_mj.engine.plugin import water_in
from buoyancy_mj.errors import BuoyancyWarning
from buoyancy_mj.inspection.inspection import Inspection, inspect_model
from buoyancy_mj.scenes.scene import INTEGRATORS, Scene
from buoyancy_mj.scenes.scene_vehicle import Start
from buoyancy_mj.scenes.specs import compile_spec, read_spec
from buoyancy_mj.settings.settings import Settings


def scene_of_file(path: Path) -> tuple[Scene, bool]:
    """A model's file as a scene, where and as it stands, and whether it brings its own water.

    Raises:
        ModelError: MuJoCo refuses the file, or its water.
    """
    model = compile_spec(read_spec(path), path)
    is_wet = len(plugin_instances(model)) == 1
    settings = water_in(model).settings if is_wet else Settings()
    names = {integrator: name for name, integrator in INTEGRATORS.items()}
    scene = Scene(
        title=path.stem,
        stem=path.stem,
        vehicle=str(path.resolve()),
        timestep=float(model.opt.timestep),
        integrator=names[mujoco.mjtIntegrator(model.opt.integrator)],
        start=_read_start(model),
        **{field.name: getattr(settings, field.name) for field in dataclasses.fields(Settings)},
    )
    return scene, is_wet


@contextlib.contextmanager
def keep_own_water() -> Iterator[None]:
    """Leave out the note that the water of a model gives way: that of its scene is the same."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "the water '.*' of the model gives", BuoyancyWarning)
        yield


def inspect_file(path: Path) -> Inspection:
    """What is known of a model's file in fresh water.

    Raises:
        ModelError: MuJoCo refuses the file, or no geom of it displaces water.
    """
    return inspect_model(compile_spec(read_spec(path), path), title=path.stem)


def write_verdict(inspection: Inspection) -> list[str]:
    """The sentences of an inspection: how each vessel floats, and all that is wrong."""
    lines = []
    for vessel in inspection.vessels:
        lines.append(f"{vessel.vessel.name}: {vessel.sentence}")
        lines += vessel.notes
    lines += [
        f"{geom.name}: {diagnosis}"
        for geom in inspection.geoms
        if geom.diagnosis
        for diagnosis in geom.diagnosis.notices
    ]
    lines += inspection.problems
    return list(dict.fromkeys(lines))


def _read_start(model: mujoco.MjModel) -> Start:
    """The pose of the first free body, or of the one that gets a free joint; else none."""
    free = np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_FREE)
    if len(free):
        pose = model.qpos0[model.jnt_qposadr[free[0]] :][:7]
    elif model.njnt or model.nbody < 2:
        return Start()
    else:
        pose = np.concatenate([model.body_pos[1], model.body_quat[1]])
    turn = scipy.spatial.transform.Rotation.from_quat(pose[3:], scalar_first=True)
    yaw, pitch, roll = turn.as_euler("ZYX").tolist()
    x, y, z = pose[:3].tolist()
    return Start(position=(x, y, z), roll=roll, pitch=pitch, yaw=yaw)
