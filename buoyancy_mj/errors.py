"""What can go wrong, said in one sentence.

In: any value that somebody gave.
Out: exceptions with one root, `BuoyancyError`, and the parts of their messages: `describe`, which
shows a value, and `choices`, which lists what was possible.
May import: nothing of this package.
"""

import difflib
import math
import reprlib
from collections.abc import Iterable


class BuoyancyError(Exception):
    """Root of every error this package raises on purpose."""


class MeshError(BuoyancyError):
    """A mesh that bounds no volume: open, empty, crossing itself, degenerate or absurdly scaled."""


class ModelError(BuoyancyError):
    """A MuJoCo model that water cannot act on."""


class SceneError(BuoyancyError):
    """A scene that cannot be read, or a value in it that makes no sense."""


class SceneTypeError(SceneError):
    """A key that a scene does not have, or a value of another type than the key's."""


class WaterError(BuoyancyError):
    """Water or waves that exist neither in nature nor in this package."""


class DivergenceError(BuoyancyError):
    """A simulation that left the finite numbers."""


class MethodError(BuoyancyError):
    """A method of submersion that does not exist, or an option of one that makes no sense."""


class BallastError(BuoyancyError):
    """A draft or attitude that no ballast at the sites can bring."""


class EquilibriumError(BuoyancyError):
    """A vessel that sinks, or a pose that it cannot be brought to."""


class EngineError(BuoyancyError):
    """A MuJoCo that differs inside from what compiled code here relies on."""


class ControlError(BuoyancyError):
    """A controller that cannot act on its vehicle, fails, or gives what is no control."""


class SweepError(BuoyancyError):
    """A sweep that makes no sense, or whose results cannot be kept."""


class ResponseError(BuoyancyError):
    """A response or a decay that cannot be measured, or an option of one that makes no sense."""


class RecordingError(BuoyancyError):
    """A recording that cannot be written to its end."""


class DrawingError(BuoyancyError):
    """A picture that cannot be drawn here: no graphics, no such camera, or a size of none."""


class AutopilotError(BuoyancyError):
    """An autopilot that cannot be served: who it is, what it drives, or what it asks for."""


class BuoyancyWarning(UserWarning):
    """A repair, an omission or a doubt that the user should know of."""


def choices(got: object, possible: Iterable[str]) -> str:
    """The tail of an error message: the nearest match to `got`, and all that is possible."""
    names = sorted(possible)
    near = difflib.get_close_matches(got, names, n=1) if isinstance(got, str) else []
    hint = f"did you mean '{near[0]}'? " if near else ""
    return f"{hint}possible: {', '.join(names) or 'nothing'}"


def describe(value: object) -> str:
    """A value as messages show it: its `repr`, on one line, shortened where that is long."""
    return " ".join(_REPR.repr(value).split())


class _ShortRepr(reprlib.Repr):
    """Short texts of values, whatever they are: lists in lists in lists, numbers without end."""

    def __init__(self) -> None:
        super().__init__()
        self.maxlevel = 3
        self.maxlist = self.maxtuple = self.maxdict = self.maxarray = 6
        self.maxstring = self.maxother = self.maxlong = 100

    def repr_int(self, x: int, _: int) -> str:
        """A whole number; a long one by its digits, which Python refuses to write out."""
        if abs(x) < 10**30:
            return repr(x)
        return f"a whole number of about {math.log10(2.0) * x.bit_length():.0f} digits"


_REPR = _ShortRepr()
