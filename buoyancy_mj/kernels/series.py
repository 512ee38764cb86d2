"""Sine and cosine by series, which the processor evaluates for several angles at once."""

import math

import numpy as np

from buoyancy_mj.kernels.compiling import njit

SHORT = 1.6
"""Angle [rad] for which the series of `bend` hold; twice that, and four times that, by doubling."""
_PER_QUARTER = 2.0 / math.pi
_QUARTER_1, _QUARTER_2 = 1.5707963267341256, 6.077100506506192e-11
"""A quarter of a turn, in two parts, of which the first has few enough digits for exact products
with whole numbers below 2^20."""
_PER_DOUBLING = 1.0 / math.log(2.0)
_DOUBLING_1, _DOUBLING_2 = 0.6931471803691238, 1.9082149292705877e-10
"""ln 2, in two parts, of which the first has few enough digits for exact products."""
_TWO_TO = 2.0 ** np.arange(-64.0, 65.0)
_E3, _E4, _E5, _E6, _E7, _E8, _E9, _E10, _E11, _E12, _E13 = (
    1.0 / math.factorial(n) for n in range(3, 14)
)
# one over factorials, of the odd and of the even terms
_S3, _S5, _S7, _S9, _S11, _S13, _S15, _S17, _S19, _S21 = (
    (-1) ** n / math.factorial(2 * n + 1) for n in range(1, 11)
)
_C2, _C4, _C6, _C8, _C10, _C12, _C14, _C16, _C18 = (
    (-1) ** n / math.factorial(2 * n) for n in range(1, 10)
)


@njit(cache=True, error_model="numpy")
def doublings(angle):
    """How often angles up to this one must be halved for `bend`; 3 for angles too large for it."""
    return 0 if angle <= SHORT else 1 if angle <= 2.0 * SHORT else 2 if angle <= 4.0 * SHORT else 3


@njit(cache=True, error_model="numpy", inline="always")
def bend(angle, doubled):
    """Sine less the angle, and cosine less 1, of an angle, to 1e-13."""
    if doubled == 3:
        return math.sin(angle) - angle, math.cos(angle) - 1.0
    angle *= 1.0 if doubled == 0 else 0.5 if doubled == 1 else 0.25
    x = angle * angle
    sine = _S9 + x * (_S11 + x * (_S13 + x * (_S15 + x * _S17)))
    sine = angle * x * (_S3 + x * (_S5 + x * (_S7 + x * sine)))
    cosine = _C10 + x * (_C12 + x * (_C14 + x * (_C16 + x * _C18)))
    cosine = x * (_C2 + x * (_C4 + x * (_C6 + x * (_C8 + x * cosine))))
    if doubled >= 1:
        sine, cosine = _double(sine, cosine, angle)
    if doubled == 2:
        angle *= 2.0
        sine, cosine = _double(sine, cosine, angle)
    return sine, cosine


@njit(cache=True, error_model="numpy", inline="always")
def _double(sine, cosine, angle):
    """Sine less angle, and cosine less 1, of twice an angle, from those of the angle."""
    return (
        2.0 * (sine + angle * cosine + sine * cosine),
        -2.0 * (sine + angle) * (sine + angle),
    )


@njit(cache=True, error_model="numpy", inline="always")
def sine(angle):
    """Sine of an angle up to half a turn, to 1e-13."""
    q = angle * angle
    end = _S13 + q * (_S15 + q * (_S17 + q * (_S19 + q * _S21)))
    middle = _S5 + q * (_S7 + q * (_S9 + q * (_S11 + q * end)))
    return angle * (1.0 + q * (_S3 + q * middle))


@njit(cache=True, error_model="numpy", inline="always")
def turn(angle):
    """Cosine and sine of any angle, to 1e-15 and the rounding of the angle itself."""
    quarters = math.floor(angle * _PER_QUARTER + 0.5)
    x = (angle - quarters * _QUARTER_1) - quarters * _QUARTER_2
    q = x * x
    sine = x + x * q * (
        _S3 + q * (_S5 + q * (_S7 + q * (_S9 + q * (_S11 + q * (_S13 + q * _S15)))))
    )
    cosine = 1.0 + q * (
        _C2 + q * (_C4 + q * (_C6 + q * (_C8 + q * (_C10 + q * (_C12 + q * (_C14 + q * _C16))))))
    )
    # whether it is an odd quarter, and whether each is turned about: 0 or 1
    half = math.floor(0.5 * quarters)
    odd = quarters - 2.0 * half
    even = 1.0 - odd
    back = half + odd - 2.0 * math.floor(0.5 * (half + odd))
    down = half - 2.0 * math.floor(0.5 * half)
    return (
        (1.0 - 2.0 * back) * (even * cosine + odd * sine),
        (1.0 - 2.0 * down) * (even * sine + odd * cosine),
    )


@njit(cache=True, error_model="numpy", inline="always")
def exponential(x):
    """e^x, to 1e-15; of less than -40 it is that of -40, which is lost beside 1."""
    x = min(max(x, -40.0), 40.0)
    doublings = math.floor(x * _PER_DOUBLING + 0.5)
    r = (x - doublings * _DOUBLING_1) - doublings * _DOUBLING_2
    end = _E8 + r * (_E9 + r * (_E10 + r * (_E11 + r * (_E12 + r * _E13))))
    middle = _E3 + r * (_E4 + r * (_E5 + r * (_E6 + r * (_E7 + r * end))))
    return (1.0 + r * (1.0 + r * (0.5 + r * middle))) * _TWO_TO[int(doublings) + 64]
