"""Models at an address in the engine's memory: a copy, a fingerprint, a plugin's texts."""

import ctypes
import hashlib
from collections.abc import Sequence
from typing import Any

import mujoco

from buoyancy_mj.engine import layout, library
from buoyancy_mj.errors import ModelError
from buoyancy_mj.settings.config import INSTANCE, KEYS

MODEL_ARRAYS = (
    "geom_type", "geom_contype", "geom_conaffinity", "geom_bodyid", "geom_dataid", "geom_group",
    "geom_size", "geom_pos", "geom_quat",
    "mesh_vertadr", "mesh_vertnum", "mesh_vert", "mesh_faceadr", "mesh_facenum", "mesh_face",
    "body_parentid", "body_weldid", "body_pos", "body_quat", "body_plugin",
    "body_dofnum", "jnt_type", "jnt_bodyid", "M_rownnz",
    "eq_type", "eq_objtype", "eq_obj1id", "eq_obj2id", "eq_active0", "site_bodyid",
    "text_adr", "text_size", "text_data", "numeric_adr", "numeric_size", "numeric_data",
    "names", "plugin", "plugin_attr", "plugin_attradr",
    "actuator_plugin", "actuator_trntype", "actuator_trnid", "actuator_actadr", "actuator_actnum",
)  # fmt: skip
"""Arrays of mjModel from which the hulls, their loads and the room for them are made.

Models that agree in them share a water. Masses, the timestep and all else that matters are read
anew in each pass."""

DEVICE_ARRAYS = (
    "names", "plugin", "plugin_attr", "plugin_attradr", "body_parentid", "body_weldid",
    "body_plugin", "body_pos", "body_quat", "geom_bodyid", "geom_type", "geom_size", "geom_pos",
    "geom_quat", "geom_dataid", "site_bodyid", "site_pos", "site_quat", "site_size",
    "actuator_plugin", "actuator_trntype", "actuator_trnid", "actuator_gear", "actuator_ctrlrange",
    "actuator_ctrllimited", "actuator_actadr", "actuator_actnum", "actuator_ctrladr",
    "actuator_outadr", "actuator_forcelimited", "actuator_delay", "actuator_dyntype",
    "actuator_actearly",
    "mesh_vertadr", "mesh_vertnum", "mesh_vert", "mesh_faceadr", "mesh_facenum", "mesh_face",
    "body_dofnum", "jnt_bodyid",
    "sensor_plugin", "sensor_objtype", "sensor_objid", "sensor_refid", "sensor_adr", "sensor_dim",
    "plugin_stateadr", "plugin_statenum",
    "numeric_adr", "numeric_size", "numeric_data", "text_adr", "text_size", "text_data",
)  # fmt: skip
"""Arrays of mjModel from which thrusters, tanks and sensors are made."""

_DISABLE = mujoco.mjtDisableBit
_FLAGS = {
    "mjModel.opt.disableflags": int(_DISABLE.mjDSBL_SPRING)
    | int(_DISABLE.mjDSBL_DAMPER)
    | int(_DISABLE.mjDSBL_GRAVITY),
    "mjModel.opt.enableflags": int(mujoco.mjtEnableBit.mjENBL_SLEEP),
}
"""Flags in which such models agree too."""
_INT = ctypes.c_int
_WORD = ctypes.c_int64


def read_config(model: int, instance: int) -> dict[str, str]:
    """The configuration of a plugin instance of the model at an address: texts by key."""
    return read_texts(model, instance, KEYS)


def read_texts(model: int, instance: int, keys: Sequence[str]) -> dict[str, str]:
    """The texts of some keys of a plugin instance of the model at an address; '' for none."""
    return {key: _read_key(model, instance, key) for key in keys}


def read_first_name(model: int, instance: int) -> str:
    """The name of a plugin instance where `add_water` put it; '' if somebody else did."""
    return _read_key(model, instance, INSTANCE)


def fingerprint_model(model: int, instance: int) -> bytes:
    """A hash (16 bytes) of all from which the water of an instance of a model is made."""
    texts = read_config(model, instance)
    digest = hashlib.blake2b(f"{instance} {texts}".encode(), digest_size=16)
    _digest_arrays(digest, model, MODEL_ARRAYS)

    # the compiler disables other flags for a while
    for path, mask in _FLAGS.items():
        flags = ctypes.c_int.from_address(model + layout.offset(path)).value & mask
        digest.update(str(flags).encode())
    digest.update(ctypes.string_at(model + layout.offset("mjModel.opt.gravity"), 3 * 8))
    return digest.digest()


def fingerprint_devices(model: int) -> bytes:
    """A hash (16 bytes) of all from which the thrusters, tanks and sensors of a model are made."""
    digest = hashlib.blake2b(digest_size=16)
    _digest_arrays(digest, model, DEVICE_ARRAYS)
    return digest.digest()


def _digest_arrays(digest: Any, model: int, arrays: Sequence[str]) -> None:
    """Let a hash take in arrays of the model at an address."""
    for name in arrays:
        values = layout.content(f"mjModel.{name}", model)
        digest.update(len(values).to_bytes(8))
        digest.update(values)


def copy_model(model: int) -> mujoco.MjModel:
    """A copy of the model at an address, as a Python object.

    Raises:
        ModelError: MuJoCo cannot copy it.
    """
    # a batch's models refer to the meshes of another
    error = ctypes.create_string_buffer(1000)
    embed = library.function("mj_embedAssets", _WORD, _WORD, _WORD, _INT)
    whole = embed(model, ctypes.addressof(error), len(error))
    if not whole:
        raise ModelError(f"MuJoCo cannot copy the model to find its water: {error.value.decode()}")

    # into a buffer as a binary file, and back
    buffer = ctypes.create_string_buffer(library.function("mj_sizeModel", _WORD, _WORD)(whole))
    save = library.function("mj_saveModel", None, *[_WORD] * 4)
    save(whole, 0, ctypes.addressof(buffer), len(buffer))
    library.function("mj_deleteModel", None, _WORD)(whole)
    return mujoco.MjModel.from_binary_path("model.mjb", {"model.mjb": buffer.raw})


def _read_key(model: int, instance: int, key: str) -> str:
    """The text of a key of a plugin instance; '' if it has none."""
    read = library.function("mj_getPluginConfig", ctypes.c_char_p, _WORD, _INT, ctypes.c_char_p)
    return (read(model, instance, key.encode()) or b"").decode()
