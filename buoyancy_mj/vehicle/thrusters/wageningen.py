"""Propellers of the Wageningen B-series in open water."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import ModelError
from buoyancy_mj.values import read_number, read_whole_number

_THRUST = (
    (0.00880496, 0, 0, 0, 0),
    (-0.204554, 1, 0, 0, 0),
    (0.166351, 0, 1, 0, 0),
    (0.158114, 0, 2, 0, 0),
    (-0.147581, 2, 0, 1, 0),
    (-0.481497, 1, 1, 1, 0),
    (0.415437, 0, 2, 1, 0),
    (0.0144043, 0, 0, 0, 1),
    (-0.0530054, 2, 0, 0, 1),
    (0.0143481, 0, 1, 0, 1),
    (0.0606826, 1, 1, 0, 1),
    (-0.0125894, 0, 0, 1, 1),
    (0.0109689, 1, 0, 1, 1),
    (-0.133698, 0, 3, 0, 0),
    (0.00638407, 0, 6, 0, 0),
    (-0.00132718, 2, 6, 0, 0),
    (0.168496, 3, 0, 1, 0),
    (-0.0507214, 0, 0, 2, 0),
    (0.0854559, 2, 0, 2, 0),
    (-0.0504475, 3, 0, 2, 0),
    (0.010465, 1, 6, 2, 0),
    (-0.00648272, 2, 6, 2, 0),
    (-0.00841728, 0, 3, 0, 1),
    (0.0168424, 1, 3, 0, 1),
    (-0.00102296, 3, 3, 0, 1),
    (-0.0317791, 0, 3, 1, 1),
    (0.018604, 1, 0, 2, 1),
    (-0.00410798, 0, 2, 2, 1),
    (-0.000606848, 0, 0, 0, 2),
    (-0.0049819, 1, 0, 0, 2),
    (0.0025983, 2, 0, 0, 2),
    (-0.000560528, 3, 0, 0, 2),
    (-0.00163652, 1, 2, 0, 2),
    (-0.000328787, 1, 6, 0, 2),
    (0.000116502, 2, 6, 0, 2),
    (0.000690904, 0, 0, 1, 2),
    (0.00421749, 0, 3, 1, 2),
    (0.0000565229, 3, 6, 1, 2),
    (-0.00146564, 0, 3, 2, 2),
)
"""Terms of K_T: the coefficient, and the powers of J, P/D, AE/A0 and Z."""
_TORQUE = (
    (0.00379368, 0, 0, 0, 0),
    (0.00886523, 2, 0, 0, 0),
    (-0.032241, 1, 1, 0, 0),
    (0.00344778, 0, 2, 0, 0),
    (-0.0408811, 0, 1, 1, 0),
    (-0.108009, 1, 1, 1, 0),
    (-0.0885381, 2, 1, 1, 0),
    (0.188561, 0, 2, 1, 0),
    (-0.00370871, 1, 0, 0, 1),
    (0.00513696, 0, 1, 0, 1),
    (0.0209449, 1, 1, 0, 1),
    (0.00474319, 2, 1, 0, 1),
    (-0.00723408, 2, 0, 1, 1),
    (0.00438388, 1, 1, 1, 1),
    (-0.0269403, 0, 2, 1, 1),
    (0.0558082, 3, 0, 1, 0),
    (0.0161886, 0, 3, 1, 0),
    (0.00318086, 1, 3, 1, 0),
    (0.015896, 0, 0, 2, 0),
    (0.0471729, 1, 0, 2, 0),
    (0.0196283, 3, 0, 2, 0),
    (-0.0502782, 0, 1, 2, 0),
    (-0.030055, 3, 1, 2, 0),
    (0.0417122, 2, 2, 2, 0),
    (-0.0397722, 0, 3, 2, 0),
    (-0.00350024, 0, 6, 2, 0),
    (-0.0106854, 3, 0, 0, 1),
    (0.00110903, 3, 3, 0, 1),
    (-0.000313912, 0, 6, 0, 1),
    (0.0035985, 3, 0, 1, 1),
    (-0.00142121, 0, 6, 1, 1),
    (-0.00383637, 1, 0, 2, 1),
    (0.0126803, 0, 2, 2, 1),
    (-0.00318278, 2, 3, 2, 1),
    (0.00334268, 0, 6, 2, 1),
    (-0.00183491, 1, 1, 0, 2),
    (0.000112451, 3, 2, 0, 2),
    (-0.0000297228, 3, 6, 0, 2),
    (0.000269551, 1, 0, 1, 2),
    (0.00083265, 2, 0, 1, 2),
    (0.00155334, 0, 2, 1, 2),
    (0.000302683, 0, 6, 1, 2),
    (-0.0001843, 0, 0, 2, 2),
    (-0.000425399, 0, 3, 2, 2),
    (0.0000869243, 3, 3, 2, 2),
    (-0.0004659, 0, 6, 2, 2),
    (0.0000554194, 1, 6, 2, 2),
)
"""Terms of K_Q."""


def wageningen(
    blades: int, area_ratio: float, pitch_ratio: float, advance: ArrayLike
) -> NDArray[np.float64]:
    """K_T and K_Q of a propeller of the B-series at a Reynolds number of 2 million, as (n, 2).

    These are the polynomials of Oosterveld and van Oossanen (1975), *Further computer-analyzed data
    of the Wageningen B-screw series*, Int. Shipbuilding Progress 22 (251), 251-262.

    Args:
        blades: Z, from 2 to 7.
        area_ratio: AE/A0, expanded area of the blades over the disc's, from 0.3 to 1.05.
        pitch_ratio: P/D, from 0.5 to 1.4.
        advance: J = V / (n D) (n,).

    Raises:
        ModelError: a number that the series does not have.
    """
    z = read_whole_number(ModelError, "blades", blades, 2, 7)
    area = read_number(ModelError, "area_ratio", area_ratio, least=0.3, most=1.05)
    pitch = read_number(ModelError, "pitch_ratio", pitch_ratio, least=0.5, most=1.4)
    j = np.atleast_1d(np.asarray(advance, float))
    return np.column_stack([_sum_terms(terms, j, pitch, area, z) for terms in (_THRUST, _TORQUE)])


def _sum_terms(
    terms: tuple[tuple[float, int, int, int, int], ...],
    j: NDArray[np.float64],
    pitch: float,
    area: float,
    z: int,
) -> NDArray[np.float64]:
    """A polynomial at J (n,)."""
    rows = np.array(terms)
    constants = rows[:, 0] * pitch ** rows[:, 2] * area ** rows[:, 3] * float(z) ** rows[:, 4]
    total: NDArray[np.float64] = (constants * j[:, None] ** rows[:, 1]).sum(axis=1)
    return total
