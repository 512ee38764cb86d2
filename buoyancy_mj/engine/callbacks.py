"""Water installed as a callback of MuJoCo, beside the callback that is there already.

Callbacks form a chain: MuJoCo calls the newest, and each calls the one that was there before it. A
water that leaves is taken out of the chain wherever it stands in it, so that `with` blocks, threads
and generators may end in any order.
"""

import collections
import contextlib
import warnings
from collections.abc import Callable, Iterator
from typing import Any

import mujoco

from buoyancy_mj.engine import presence
from buoyancy_mj.engine.acting import ActingWater
from buoyancy_mj.engine.checks import check_actuation, skips_passive
from buoyancy_mj.engine.compiled import CompiledWater
from buoyancy_mj.engine.forks import make_lock
from buoyancy_mj.engine.instances import PLUGIN, plugin_instances
from buoyancy_mj.engine.leases import LeasedFunction, lease_function
from buoyancy_mj.errors import BuoyancyWarning, EngineError, ModelError, choices, describe

PASSIVE, APPLIED = "qfrc_passive", "xfrc_applied"
"""Arrays of mjData through which forces enter."""
WAYS = PASSIVE, APPLIED

_LOCK = make_lock()
"""Held while the chain is changed."""
_lent: list["_Installed"] = []
"""All waters that act as callbacks, in the order in which they came."""
_left: collections.deque[CompiledWater] = collections.deque(maxlen=8)
"""Waters that left last: threads may still be in a pass of theirs."""


class _Installed:
    """A water that acts as a callback."""

    copies = False
    """Whether it acts on copies of the water's model too."""

    def __init__(self, water: ActingWater, through: str, slot: str) -> None:
        self.water, self.through, self.slot = water, through, slot
        self.blocks = 1
        """How many `with` blocks it is lent for."""
        self.function: Any = None
        """What MuJoCo calls."""
        self.previous: Any = None
        """The callback that runs first."""

    def follow(self, previous: Any) -> None:
        """Let another callback run first; None for none."""
        self.previous = previous

    def leave(self) -> None:
        """Act no more, whoever still calls it."""


class _Compiled(_Installed):
    """A water that acts as a C function."""

    def __init__(
        self, water: ActingWater, through: str, slot: str, previous: Any, *, copies: bool
    ) -> None:
        super().__init__(water, through, slot)
        # made here, so that an engine it does not know is refused before anything is lent
        self._compiled = water.compiled
        self._leased: LeasedFunction = lease_function()
        self.function = self._leased.function
        self.follow(previous)
        self._leased.lend(water.handle, copies=copies)
        self.copies = copies

    def follow(self, previous: Any) -> None:
        super().follow(previous)
        self._leased.follow(previous)

    def leave(self) -> None:
        self._leased.give_back()
        current = self.water.compiled
        if current not in _left:
            _left.append(current)


class _InPython(_Installed):
    """A water that acts as a Python function."""

    def __init__(self, water: ActingWater, through: str, slot: str, previous: Any) -> None:
        super().__init__(water, through, slot)
        self._act: Callable[[mujoco.MjData], None] | None
        self._act = water.act_on_bodies if through == APPLIED else water.act
        self.function = self._call
        self.follow(previous)

    def _call(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        previous, act = self.previous, self._act
        if hasattr(previous, "argtypes"):
            previous(model._address, data._address)
        elif previous is not None:
            previous(model, data)
        if act is not None and model._address == self.water.model._address:
            act(data)

    def leave(self) -> None:
        # a bound method would keep the water alive
        self._act = self.function = None
        if self.through == APPLIED:
            self.water.leave_bodies()


@contextlib.contextmanager
def install(
    water: ActingWater, native: bool | None, *, through: str, copies: bool
) -> Iterator[None]:
    """Install a water as a callback of MuJoCo, and take it out of the chain at the end.

    Args:
        water: the water; installed already, it stays until the last block ends.
        native: whether as a compiled C function; None where it can be.
        through: one of `WAYS`.
        copies: whether to act on copies of its model too.

    Raises:
        ModelError: the model disables actuation, or brings its own water; or `xfrc_applied` cannot
            carry the water.
        EngineError: `native`, `copies` or `through` is asked for and cannot be.
    """
    if native is not None and not isinstance(native, bool):
        raise EngineError(
            f"native is {describe(native)}; possible: True, False, None; the array is through=..."
        )
    if through not in WAYS:
        raise EngineError(f"through is '{through}'; {choices(str(through), WAYS)}")

    # the model must call it, and call it once
    check_actuation(water.model)
    check_single(water.model)
    with _LOCK:
        installed = _find(water)
        if installed is None:
            installed = _enter(water, native, through, copies=copies)
        else:
            _check_alike(installed, native, through, copies=copies)
            installed.blocks += 1
    try:
        yield
    finally:
        with _LOCK:
            installed.blocks -= 1
            if not installed.blocks:
                _leave(installed)


def check_single(model: mujoco.MjModel) -> None:
    """Refuse a second water in a model.

    Raises:
        ModelError: it brings its own.
    """
    if plugin_instances(model):
        raise ModelError(
            f"this model brings its own water, as the plugin '{PLUGIN}', and a callback would "
            "double it: leave out the one or the other"
        )


def is_installed(water: ActingWater) -> bool:
    """Whether MuJoCo has a callback of this water now."""
    with _LOCK:
        return _find(water) is not None


def act_in_control(water: ActingWater, data: mujoco.MjData) -> None:
    """Let a water act on data that a pass has brought to where MuJoCo calls mjcb_control.

    That is for who goes through the stages of a pass without that callback. A water that acts among
    the passive forces has acted in that pass already.
    """
    with _LOCK:
        link = _find(water)
    if link is not None and link.slot == "control" and link.through == APPLIED:
        water.act_on_bodies(data)
    elif link is None or link.slot == "control":
        water.act(data)


def _find(water: ActingWater) -> _Installed | None:
    """The link of a water in one of the chains that start at MuJoCo's callbacks; None without."""
    for slot in ("passive", "control"):
        function = _get(slot)
        while (link := _link(function)) is not None:
            if link.water is water:
                return link
            function = link.previous
    return None


def _check_alike(installed: _Installed, native: bool | None, through: str, *, copies: bool) -> None:
    """Refuse to install a water in another way than it is installed already."""
    has_code = isinstance(installed, _Compiled)
    if installed.through != through:
        now, then = f"through {installed.through}", f"through {through}"
    elif native is not None and native != has_code:
        now, then = ("compiled", "in Python") if has_code else ("in Python", "compiled")
    elif copies and not installed.copies:
        now, then = "on its own model alone", "on copies"
    else:
        return
    raise EngineError(
        f"this water is installed already and acts {now}, which a block inside cannot change: "
        f"ask for it to act {then} in the outer `installed`"
    )


def _enter(water: ActingWater, native: bool | None, through: str, *, copies: bool) -> _Installed:
    """Put a water at the head of a chain."""
    late = through == APPLIED or skips_passive(water.model.opt.disableflags)
    slot = "control" if late else "passive"
    waters = [other.water for other in _lent if other.through == APPLIED]
    if through == APPLIED and any(other.model is water.model for other in waters):
        raise ModelError(
            "another water acts through xfrc_applied on this model already, and the two could "
            "not tell their rows apart: let one of them act through qfrc_passive"
        )
    previous = _get(slot)
    link = _try_compiled(water, native, through, slot, previous, copies=copies) or _InPython(
        water, through, slot, previous
    )
    _lent.append(link)
    _set(slot, link.function)
    presence.note_lent(water, copies=copies)
    return link


def _leave(link: _Installed) -> None:
    """Take a water out of its chain."""
    _lent.remove(link)
    presence.note_left(link.water)
    now = _get(link.slot)
    follower = next((other for other in _lent if other.previous is link.function), None)
    try:
        if now is link.function:
            _set(link.slot, link.previous)
        elif follower is not None:
            follower.follow(link.previous)
        else:
            warnings.warn(
                f"mjcb_{link.slot} was set to {_describe(now)} while the water was installed "
                "there, which keeps the water from acting; it stays as it was set: set a callback "
                "before `installed`, and the water calls it first",
                BuoyancyWarning,
                stacklevel=6,
            )
    finally:
        link.leave()


def _try_compiled(
    water: ActingWater, native: bool | None, through: str, slot: str, previous: Any, *, copies: bool
) -> _Compiled | None:
    """The water as a C function; None where Python serves, or must."""
    try:
        if native is False:
            raise EngineError("native=False asks for a callback in Python")
        if through == APPLIED:
            raise EngineError("through='xfrc_applied' is a callback in Python")
        if slot == "control":
            raise EngineError(
                "the model disables springs and dampers, and MuJoCo then skips its passive forces"
            )
        if previous is not None and not hasattr(previous, "argtypes"):
            raise EngineError("a callback in Python is installed as mjcb_passive; remove it first")
        return _Compiled(water, through, slot, previous, copies=copies)
    except EngineError as error:
        if native:
            raise EngineError(f"the water cannot act as compiled code: {error}") from error
        if copies:
            raise EngineError(
                f"copies of a model are known to compiled code alone: {error}"
            ) from error
        if water.threads > 1:
            raise EngineError(
                f"threads is {water.threads}, and threads share the hulls in compiled code alone: "
                f"{error}; or leave threads out"
            ) from error
        return None


def _link(function: Any) -> _Installed | None:
    """The water that acts in a callback; None if none of ours does."""
    # a copy: the end of a generator may change the list at any time
    return next((link for link in tuple(_lent) if link.function is function), None)


def _get(slot: str) -> Any:
    return getattr(mujoco, f"get_mjcb_{slot}")()


def _set(slot: str, function: Any) -> None:
    getattr(mujoco, f"set_mjcb_{slot}")(function)


def _describe(function: Any) -> str:
    """A callback, for a message."""
    return "None" if function is None else getattr(function, "__qualname__", "another callback")
