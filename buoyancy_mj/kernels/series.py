"""Sine and cosine by series, which the processor evaluates for several angles at once."""

import math

from buoyancy_mj.kernels.compiling import njit

SHORT = 1.6
"""Angle [rad] for which the series of `bend` hold; twice that, and four times that, by doubling."""
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
