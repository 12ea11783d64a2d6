"""Sweeps of an iterative solver over contacts: how far and how fast forces spread (derived here).

In a chain of equal rigid grains a contact takes the mean of the forces of its neighbours.
"""

import math
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import dimension_two_or_three, none_negative, one_of, positive, whole

Order = Literal["random", "coloured", "ordered", "jacobi"]
SPREAD = {"random": 2 * math.sqrt(math.e) - 2.5, "coloured": 1.0, "ordered": 1.0, "jacobi": 0.5}


def sweep_spread(order: Order) -> float:
    """Diffusion coefficient q of forces in a chain, in contacts^2 for each sweep.

    A sweep multiplies a long wave of error by 1 - q k^2. All contacts at once (`jacobi`): 1/2. One
    after the other from an end, or every other one and then the rest (`ordered`, `coloured`): 1. A
    new random order for each sweep: 2 sqrt(e) - 5/2 = 0.797443. Its value takes a walk back over
    contacts that were updated before, of n steps or more with the probability 1/(2^(n - 1) n!).

    Parameters: `order` of the updates. Raises ValueError for another word. Exact.

    >>> [round(sweep_spread(order), 6) for order in ("random", "ordered", "jacobi")]
    [0.797443, 1.0, 0.5]
    """
    one_of(tuple(SPREAD), order=order)
    return SPREAD[order]


def sweep_factor(wave_number: ArrayLike, order: Order) -> NDArray[np.float64]:
    """What one sweep leaves of a wave of error in a chain of contacts.

    cos(k) of `jacobi`, cos(k)^2 of `ordered` and `coloured`, exact for the modes of a chain with
    ends. `random`: the mean over orders, 4 Re(x (1 + (z - 1) e^z) + x^2 (e^z - 1 - z)/2) with z =
    e^(ik)/2 and x = e^(-ik), exact in a long chain. Short waves change sign under `jacobi`.

    Parameters: `wave_number` k, per contact; `order` of the updates. Raises ValueError for another
    word.

    >>> [sweep_factor([0.1, 3.0], order).round(6).tolist() for order in ("random", "ordered")]
    [[0.992056, -0.14692], [0.990033, 0.980085]]
    """
    one_of(tuple(SPREAD), order=order)
    k = np.asarray(wave_number, float)
    if order != "random":
        return np.asarray(np.cos(k) ** (1 if order == "jacobi" else 2))
    z, back = 0.5 * np.exp(1j * k), np.exp(-1j * k)
    grown = np.exp(z)
    return np.asarray(4 * np.real(back * (1 + (z - 1) * grown) + back**2 * (grown - 1 - z) / 2))


def slowest_wave(contacts: int, column: bool = False) -> float:
    """Wave number per contact of the error that lasts longest in a chain of contacts.

    pi/(N + 1) where the forces next to both ends are known, such as a chain that is pushed at its
    ends. pi/(2 N) of a column that stands on a floor under its weight.

    Parameters: `contacts` N whose forces are unknown; `column` whether the last one is that of a
    grain on a floor. Raises ValueError for no contacts. Exact.

    >>> round(slowest_wave(9), 6), round(slowest_wave(10, column=True), 6)
    (0.314159, 0.15708)
    """
    whole(1, contacts=contacts)
    return math.pi / (2 * contacts if column else contacts + 1)


def sweep_error(
    sweeps: ArrayLike, contacts: int, order: Order = "ordered", column: bool = False
) -> NDArray[np.float64]:
    """Share of the slowest error that is left after some sweeps: cos(k)^(2n) if ordered.

    Parameters: `sweeps` n; `contacts`, `column` as `slowest_wave`, which is k; `order` as
    `sweep_factor`, whose n-th power this is. Exact but for `random`, where it is a mean and the
    ends of short chains are left out (below 1 % of the exponent from 30 contacts).

    >>> sweep_error([0, 100], 9).round(6).tolist()
    [1.0, 4.4e-05]
    """
    none_negative(sweeps=sweeps)
    factor = abs(sweep_factor(slowest_wave(contacts, column), order))
    return np.asarray(factor ** np.asarray(sweeps, float))


def sweeps_needed(
    contacts: int, accuracy: float, order: Order = "random", column: bool = False
) -> float:
    """Sweeps after which the slowest error of a chain has decayed to a share.

    log(1/accuracy)/(q k^2) in long chains: some N^2 log(1/accuracy)/(pi^2 q) between two ends,
    four times that of a column. A column without forces at the start has 8/pi^2 of its weight in
    the slowest error: divide the accuracy by that.

    Parameters: `contacts`, `order`, `column` as `sweep_error`; `accuracy` above 0 and below 1.
    Raises ValueError for numbers out of range.

    >>> round(sweeps_needed(64, 1e-6 * math.pi**2 / 8, column=True))  # 28,355 sweeps measured
    28322
    """
    if not 0 < accuracy < 1:
        raise ValueError(f"accuracy = {accuracy!r}: expected a number above 0 and below 1")
    factor = float(abs(sweep_factor(slowest_wave(contacts, column), order)))
    if factor < 1e-15:  # one sweep solves it
        return 1.0
    return math.log(accuracy) / math.log(factor)


def packing_sweeps(
    grains: float, dimension: int, accuracy: float = 1e-4, order: Order = "random"
) -> float:
    """Sweeps that forces take to settle in a packing, of the order of N^(2/d).

    A rough estimate: that of a column as high as the packing, N^(1/d) grains. A warm start from
    the forces of the last step needs far fewer, where these change little.

    Parameters: `grains` N; `dimension` 2 or 3; `accuracy`, `order` as `sweeps_needed`. Raises
    ValueError for numbers out of range.

    >>> [round(packing_sweeps(10_000, d)) for d in (2, 3)]
    [46810, 2265]
    """
    positive(grains=grains)
    dimension_two_or_three(dimension)
    across = max(math.ceil(grains ** (1 / dimension) - 1e-9), 1)
    return sweeps_needed(across, accuracy, order, column=True)
