"""The BlueROV2 Heavy: terminal speeds and periods."""

from collections.abc import Sequence

import mujoco

from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.specs import read_spec
from buoyancy_mj.sea.water import Water
from buoyancy_mj.statics.hydrostatics import hydrostatics
from buoyancy_mj.validation.case import Case, Row
from buoyancy_mj.validation.runs import follow


def _load_spec() -> mujoco.MjSpec:
    return read_spec(catalog.models()["bluerov2_heavy"])


def _compare() -> Sequence[Row]:
    """Compare speeds in heave and surge, and periods in roll and pitch."""
    rows = [
        Row("sinks in fresh water [m/s]", -0.0259, _terminal_heave(1000.0), 0.01),
        Row("rises in sea water [m/s]", 0.0534, _terminal_heave(1025.0), 0.01),
    ]
    for thrust, published in ((10.0, 0.222), (40.0, 0.486), (100.0, 0.795)):
        quantity = f"surge under {thrust:g} N [m/s]"
        rows.append(Row(quantity, published, _terminal_surge(thrust), 0.01))

    # undamped, each motion by itself
    rest = hydrostatics(_load_spec().compile(), qpos=[0, 0, -3, 1, 0, 0, 0])
    _, roll, pitch = rest.natural_periods([6.36, 7.12, 18.68, 0.189, 0.135, 0.222])
    rows.append(Row("period of roll [s]", 3.672, float(roll), 0.01))
    rows.append(Row("period of pitch [s]", 3.311, float(pitch), 0.01))
    return rows


def _terminal_heave(density: float) -> float:
    """Terminal speed [m/s] upward of the free vehicle in water of a density [kg/m^3]."""
    return _terminal_speed(_load_spec(), density, 0.0, dof=2, duration=40.0)


def _terminal_surge(thrust: float) -> float:
    """Terminal speed [m/s] forward under a thrust [N], upright and straight as by its autopilot."""
    spec = _load_spec()
    for key in spec.keys:
        spec.delete(key)
    spec.delete(spec.joints[0])
    spec.body("bluerov2_heavy").add_joint(type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[1.0, 0.0, 0.0])
    return _terminal_speed(spec, 1000.0, thrust, dof=0, duration=15.0)


def _terminal_speed(
    spec: mujoco.MjSpec, density: float, thrust: float, *, dof: int, duration: float
) -> float:
    """Speed [m/s] at the end of a run, 50 m deep."""
    spec.body("bluerov2_heavy").pos = [0.0, 0.0, -50.0]
    model = spec.compile()
    model.opt.timestep = 0.01
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST

    def start(data: mujoco.MjData) -> None:
        data.xfrc_applied[1, dof] = thrust

    _, speeds = follow(
        model,
        Water(density=density),
        duration,
        read=lambda data: float(data.qvel[dof]),
        start=start,
    )
    return float(speeds[-1])


CASES = (
    Case(
        "bluerov2_heavy",
        "BlueROV2 Heavy: terminal speeds and periods",
        "von Benzon et al. 2022, *An Open-Source Benchmark Simulator: Control of a BlueROV2 "
        "Underwater Robot*, J. Mar. Sci. Eng. 10(12):1898; what follows from its parameters in "
        "closed form",
        "`models/bluerov2_heavy` is stepped until its speed no longer changes. The periods are "
        "those of its hydrostatics, undamped.",
        _compare,
        loads=("buoyancy", "drag: as the model states it", "added_mass"),
    ),
)
"""In the order of the page."""
