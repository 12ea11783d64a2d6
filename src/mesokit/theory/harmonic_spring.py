"""Harmonic bonds in equilibrium, in both conventions: U = K r^2 and U = k/2 (r - r0)^2."""

import math
from typing import NamedTuple

from mesokit.theory._check import one_of, positive


class Spring(NamedTuple):
    """One spring in both conventions: `K` of U = K r^2 and `k` = 2 K of U = k/2 r^2."""

    K: float
    k: float


def spring(*, K: float | None = None, k: float | None = None) -> Spring:
    """A spring from its constant in either convention, so that factors of 2 are never guessed.

    Parameters: one of `K`, U = K r^2, and `k`, U = k/2 (r - r0)^2, energy over area. Raises
    ValueError for both, none, or one not above 0.

    >>> spring(K=0.5)
    Spring(K=0.5, k=1.0)
    """
    if K is None and k is not None:
        positive(k=k)
        return Spring(k / 2, k)
    if k is None and K is not None:
        positive(K=K)
        return Spring(K, 2 * K)
    raise ValueError(f"K = {K!r}, k = {k!r}: expected one, of U = K r^2 or of U = k/2 (r - r0)^2")


def spring_of_bond(bond_length: float, dimension: int = 3, kT: float = 1.0) -> Spring:
    """The spring without rest length whose root-mean-square bond length is given.

    Parameters: `bond_length` sqrt<r^2>; `dimension` 1, 2 or 3; `kT`. Raises ValueError for a value
    out of range. Source: equipartition, k = d kT/<r^2>; D. Toneian, diploma thesis, TU Wien (2015),
    eq. (5.1.47), is K of it (the caption of its Fig. 5.3 quotes k).

    >>> K, k = spring_of_bond(3)
    >>> round(K, 6), round(k, 6)
    (0.166667, 0.333333)
    """
    one_of((1, 2, 3), dimension=dimension)
    positive(bond_length=bond_length, kT=kT)
    return spring(k=dimension * kT / bond_length**2)


def mean_square_bond(
    *,
    K: float | None = None,
    k: float | None = None,
    rest_length: float = 0.0,
    dimension: int = 3,
    kT: float = 1.0,
) -> float:
    """Mean square length <r^2> of a harmonic bond: d kT/k = d kT/2K if the rest length is 0.

    Parameters: the spring as in `spring`; `rest_length` r0, 0 or more, with k only; `dimension` 1,
    2 or 3; `kT`. Raises ValueError for a value out of range. Source: Boltzmann weight r^(d-1)
    exp(-U/kT), integrated by parts. Valid without shear, where bonds exclude no volume; in a ring
    of n bonds without rest length each is 1 - 1/n of it.

    >>> round(mean_square_bond(K=1 / 6), 12), round(mean_square_bond(k=1 / 3), 12)
    (9.0, 9.0)
    >>> round(mean_square_bond(k=100, rest_length=1), 6)
    1.049802
    """
    one_of((1, 2, 3), dimension=dimension)
    positive(kT=kT)
    if not (math.isfinite(rest_length) and rest_length >= 0) or (K is not None and rest_length):
        raise ValueError(f"rest_length = {rest_length!r}: expected 0 or more, and k with it, not K")
    width = kT / spring(K=K, k=k).k
    # moments of exp(-(r - r0)^2/2 width) from 0 on, each from the two before
    edge = math.exp(-(rest_length**2) / (2 * width))
    moments = [math.sqrt(math.pi * width / 2) * (1 + math.erf(rest_length / math.sqrt(2 * width)))]
    moments.append(rest_length * moments[0] + width * edge)
    for n in range(1, dimension + 1):
        moments.append(rest_length * moments[n] + n * width * moments[n - 1])
    return moments[dimension + 1] / moments[dimension - 1]
