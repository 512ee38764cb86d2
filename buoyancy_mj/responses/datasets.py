"""Responses as a dataset of NetCDF, laid out as Capytaine lays out its own."""

import importlib.util
import math
from pathlib import Path
from typing import Any

import numpy as np

from buoyancy_mj.errors import ResponseError
from buoyancy_mj.files import replace_file
from buoyancy_mj.responses.responses import Responses
from buoyancy_mj.responses.tracks import MOTIONS


def to_dataset(responses: Responses) -> Any:
    """An xarray Dataset with the variable `RAO` over omega, wave_direction and radiating_dof.

    It has the names, the units and the sign of time, e^(-i omega t), of `capytaine.post_pro.rao`
    and of Capytaine's datasets; turns are in radians per metre. What was measured beside the six
    motions is `response` over omega, wave_direction and channel.

    Raises:
        ResponseError: xarray is not installed.
    """
    check_datasets()
    import xarray

    order = np.argsort(responses.omegas)
    over = ("omega", "wave_direction")
    count = len(MOTIONS)
    by_omega = responses.transfer.swapaxes(0, 1)[order]
    sure = responses.sure.swapaxes(0, 1)[order]
    k = responses.wavenumbers[order]
    variables: dict[str, Any] = {
        "RAO": (
            (*over, "radiating_dof"),
            by_omega[:, :, :count],
            {"long_name": "motion over elevation, e^(-i omega t)", "units": "m/m, rad/m"},
        ),
        "RAO_is_sure": ((*over, "radiating_dof"), sure[:, :, :count].astype(np.int8)),
        "cycles": (over, responses.cycles.T[order]),
    }
    coordinates: dict[str, Any] = {
        "omega": ("omega", responses.omegas[order], {"units": "rad/s"}),
        "wave_direction": ("wave_direction", responses.headings, {"units": "rad"}),
        "radiating_dof": [name.title() for name in MOTIONS],
        "period": ("omega", responses.periods[order], {"units": "s"}),
        "freq": ("omega", responses.omegas[order] / (2.0 * math.pi), {"units": "Hz"}),
        "wavenumber": ("omega", k, {"units": "rad/m"}),
        "wavelength": ("omega", 2.0 * math.pi / k, {"units": "m"}),
        "amplitude": ("omega", responses.amplitudes[order], {"units": "m"}),
        "rho": responses.density,
        "g": responses.gravity,
        "water_depth": responses.depth,
        "body_name": responses.title,
    }
    if len(responses.names) > count:
        coordinates["channel"] = list(responses.names[count:])
        variables["response"] = ((*over, "channel"), by_omega[:, :, count:])
    if responses.coherence is not None:
        coherence = responses.coherence.swapaxes(0, 1)[order]
        variables["coherence"] = ((*over, "radiating_dof"), coherence[:, :, :count])
    return xarray.Dataset(
        variables, coordinates, {"software": "buoyancy_mj", "notes": " ".join(responses.notes)}
    )


def write_responses_netcdf(responses: Responses, path: Path) -> None:
    """Write the dataset as NetCDF 4, its complex numbers as Capytaine separates them.

    `capytaine.io.xarray.merge_complex_values(xarray.open_dataset(path))` joins them again.

    Raises:
        ResponseError: xarray or h5netcdf is not installed.
        OSError: the file cannot be written.
    """
    check_datasets()
    import xarray

    dataset = to_dataset(responses)

    for name, values in dataset.data_vars.items():
        if values.dtype.kind == "c":
            parts = xarray.concat([values.real, values.imag], dim="complex")
            dataset[name] = parts.assign_attrs(values.attrs)
    dataset = dataset.assign_coords(complex=["re", "im"])
    with replace_file(path) as part:
        dataset.to_netcdf(part, engine="h5netcdf")


def check_datasets() -> None:
    """Refuse to measure for a dataset that cannot be written.

    Raises:
        ResponseError: xarray or h5netcdf is not installed.
    """
    missing = [name for name in ("xarray", "h5netcdf") if importlib.util.find_spec(name) is None]
    if missing:
        raise ResponseError(
            f"a dataset needs {' and '.join(missing)}, not installed here: "
            "pip install 'buoyancy_mj[coefficients]'"
        )
