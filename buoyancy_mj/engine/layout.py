"""Where MuJoCo keeps its numbers: byte offsets in its structs."""

import contextlib
import ctypes
import functools
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import mujoco
import numpy as np
from mujoco.introspect import ast_nodes, structs

from buoyancy_mj.engine.library import MEND
from buoyancy_mj.errors import EngineError

_TYPES: dict[str, Any] = {
    "mjtNum": ctypes.c_double,
    "double": ctypes.c_double,
    "float": ctypes.c_float,
    "int": ctypes.c_int,
    "char": ctypes.c_char,
    "mjtByte": ctypes.c_ubyte,
    "mjtBool": ctypes.c_bool,
    "mjtSize": ctypes.c_int64,
    "uint64_t": ctypes.c_uint64,
    "size_t": ctypes.c_size_t,
    "uintptr_t": ctypes.c_size_t,
}
"""C types by the names that MuJoCo's introspection gives them."""
_PROBE = """
<mujoco>
  <option timestep="0.00390625" gravity="0 0 -7.25"/>
  <worldbody>
    <body name="a">
      <freejoint/><geom type="box" size="1 2 3"/><body><joint/><geom size="1"/></body>
      <site name="b" pos="1 2 3"/>
    </body>
  </worldbody>
  <actuator><general site="b" dyntype="integrator" ctrllimited="true" ctrlrange="-1 2"/></actuator>
  <sensor><framepos objtype="site" objname="b"/></sensor>
  <equality><weld body1="a"/></equality>
</mujoco>
"""
"""A small model in which every array that is looked at has something in it."""


@functools.cache
def offset(path: str) -> int:
    """Byte offset of a field, as 'mjModel.opt.timestep'.

    Raises:
        EngineError: there is no such field.
    """
    name, *parts = path.split(".")
    kind, total = _struct(name), 0
    for part in parts:
        if not hasattr(kind, part):
            raise EngineError(f"MuJoCo {mujoco.__version__} has no {path}; {MEND}")
        total += getattr(kind, part).offset
        kind = dict(kind._fields_).get(part)
    return total


def size(name: str) -> int:
    """Bytes of a struct, as 'mjContact'."""
    return ctypes.sizeof(_struct(name))


def content(path: str, address: int) -> bytes:
    """A copy of the array that a pointer field of a struct points to.

    The path is as 'mjModel.geom_size'; the struct is at an address.
    """
    length, extent = _pointed(path)
    for n in extent:
        length *= (
            n
            if isinstance(n, int)
            else ctypes.c_int64.from_address(address + offset(f"{path.split('.')[0]}.{n}")).value
        )
    return ctypes.string_at(word(address + offset(path)), length) if length else b""


def word(address: int) -> int:
    """The 64-bit word at an address."""
    return ctypes.c_int64.from_address(address).value


def verify(paths: Sequence[str]) -> None:
    """Compare offsets with where a live model and its data really hold their arrays and numbers.

    Raises:
        EngineError: they differ, so that nothing compiled here may touch this MuJoCo.
    """
    # MuJoCo may be compiling a model in this thread, and keeps track of one in each thread only
    with _no_callbacks(), ThreadPoolExecutor(1) as apart:
        model, data = apart.submit(_make_probe).result()
    for path in paths:
        name, *parts = path.split(".")
        owner = model if name == "mjModel" else data
        value, address = functools.reduce(getattr, parts, owner), owner._address + offset(path)
        kind = _field(path)
        if kind is ctypes.c_void_p:
            # of an array without elements there is nothing to find, and texts come as copies
            right = len(value) == 0 or (
                ctypes.string_at(word(address), len(value)) == value
                if isinstance(value, bytes)
                else word(address) == value.ctypes.data
            )
        elif isinstance(value, np.ndarray):
            right = bool((np.ctypeslib.as_array(kind.from_address(address)) == value).all())
        else:
            right = kind.from_address(address).value == value
        if not right:
            raise EngineError(
                f"MuJoCo {mujoco.__version__} does not keep {path} at byte {offset(path)}, "
                f"as it says itself; {MEND}"
            )


def _make_probe() -> tuple[mujoco.MjModel, mujoco.MjData]:
    """The small model and its data, in which numbers differ from one another."""
    model = mujoco.MjModel.from_xml_string(_PROBE)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    data.time = 0.1875
    return model, data


@functools.cache
def _pointed(path: str) -> tuple[int, tuple[Any, ...]]:
    """Bytes of one element, and the shape, of what a pointer field points to."""
    name, field = path.split(".")
    declared = next(declared for declared in structs.STRUCTS[name].fields if declared.name == field)
    return ctypes.sizeof(_TYPES[declared.type.inner_type.name]), tuple(declared.array_extent)


@contextlib.contextmanager
def _no_callbacks() -> Iterator[None]:
    """Keep the probe from those who have a callback installed."""
    slots = {name: getattr(mujoco, f"get_mjcb_{name}")() for name in ("control", "passive")}
    for name in slots:
        getattr(mujoco, f"set_mjcb_{name}")(None)
    try:
        yield
    finally:
        for name, callback in slots.items():
            getattr(mujoco, f"set_mjcb_{name}")(callback)


def _field(path: str) -> Any:
    """C type of a field."""
    name, *parts = path.split(".")
    return functools.reduce(lambda kind, part: dict(kind._fields_)[part], parts, _struct(name))


@functools.cache
def _struct(name: str) -> Any:
    """One of MuJoCo's structs."""
    return _structure(name, structs.STRUCTS[name].fields)


def _structure(name: str, fields: Sequence[Any]) -> Any:
    return type(
        name,
        (ctypes.Structure,),
        {"_fields_": [(field.name, _type(field.type, name)) for field in fields]},
    )


def _type(declared: Any, owner: str) -> Any:
    """The C type that the introspection declares in a struct."""
    if isinstance(declared, ast_nodes.PointerType):
        return ctypes.c_void_p
    if isinstance(declared, ast_nodes.ArrayType):
        return functools.reduce(
            lambda kind, n: kind * n, reversed(declared.extents), _type(declared.inner_type, owner)
        )
    if isinstance(declared, ast_nodes.AnonymousStructDecl) and not isinstance(
        declared, ast_nodes.AnonymousUnionDecl
    ):
        return _structure("struct", declared.fields)
    name = getattr(declared, "name", "union")
    if name in structs.STRUCTS:
        return _struct(name)
    if name not in _TYPES:
        raise EngineError(
            f"MuJoCo {mujoco.__version__} has a field of the unknown type {name} in {owner}; {MEND}"
        )
    return _TYPES[name]
