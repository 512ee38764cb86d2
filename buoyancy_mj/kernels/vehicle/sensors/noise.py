"""Gaussian noise that is a function of whole numbers, without a state.

Whoever asks for the noise of the same sample gets the same, whatever the thread and the order.
"""

import math

import numpy as np

from buoyancy_mj.kernels.compiling import inner, njit

_GOLDEN = np.uint64(0x9E3779B97F4A7C15)
_FIRST, _SECOND = np.uint64(0xBF58476D1CE4E5B9), np.uint64(0x94D049BB133111EB)
_SHIFTS = np.uint64(30), np.uint64(27), np.uint64(31)
_UNUSED_BITS = np.uint64(11)
_LAST_PLACE = 2.0**-53


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def mix(word):
    """Spread each bit of a word over all 64: the finalizer of SplitMix64.

    Steele, Lea and Flood (2014), "Fast splittable pseudorandom number generators", OOPSLA.
    """
    word = (word ^ (word >> _SHIFTS[0])) * _FIRST
    word = (word ^ (word >> _SHIFTS[1])) * _SECOND
    return word ^ (word >> _SHIFTS[2])


@inner
def hash_words(seed, stream, sensor, sample, number):
    """One word of 64 random bits for five whole numbers, mixed in one after the other."""
    word = mix(np.uint64(seed) + _GOLDEN)
    word = mix((word ^ np.uint64(stream)) + _GOLDEN)
    word = mix((word ^ np.uint64(sensor)) + _GOLDEN)
    word = mix((word ^ np.uint64(sample)) + _GOLDEN)
    return mix((word ^ np.uint64(number)) + _GOLDEN)


@njit(cache=True, error_model="numpy", _nrt=False)
def draw_normal(
    seed,  # whole number of the user's
    stream,  # of the run
    sensor,  # index
    sample,  # number of the sample
    number,  # which of the sensor's numbers
):
    """A number of the standard normal distribution, by Box and Muller (1958)."""
    one = hash_words(seed, stream, sensor, sample, 2 * number)
    other = hash_words(seed, stream, sensor, sample, 2 * number + 1)
    above_0 = (np.float64(one >> _UNUSED_BITS) + 1.0) * _LAST_PLACE
    turn = np.float64(other >> _UNUSED_BITS) * _LAST_PLACE
    return math.sqrt(-2.0 * math.log(above_0)) * math.cos(2.0 * math.pi * turn)


@njit(cache=True, error_model="numpy", _nrt=False)
def draw_normals(seed, stream, sensor, first, number, out):
    """Write the noise of samples from the number `first` on to `out` (n,)."""
    for n in range(out.shape[0]):
        out[n] = draw_normal(seed, stream, sensor, first + n, number)
