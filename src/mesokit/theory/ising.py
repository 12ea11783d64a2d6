"""The Ising model in equilibrium: exact results, and its relaxation in one dimension."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import not_negative, positive, whole

MOST_SPINS = 20  # of which all states are counted
ANGLES = 8192  # at which elements of determinants are integrated


def onsager_energy(coupling: float, kT: float) -> float:
    """Energy of a spin in an infinite square lattice without a field.

    Parameters: `coupling` J, above 0; `kT`, in its unit. -J coth(2K) (1 + 2/pi (2 tanh^2(2K) - 1)
    K_1(k)) with K = J/kT, k = 2 sinh(2K)/cosh^2(2K) and the complete elliptic integral of the first
    kind K_1. Raises ValueError unless both are above 0. Source: L. Onsager, Phys. Rev. 65, 117
    (1944).

    >>> round(onsager_energy(1.0, 2.0), 5), round(onsager_energy(1.0, 3.0), 5)
    (-1.74556, -0.81731)
    """
    positive(coupling=coupling, kT=kT)
    from scipy.special import ellipkm1

    doubled = 2.0 * coupling / kT
    factor = 2.0 * math.tanh(doubled) ** 2 - 1.0
    # 1 - k^2 is factor^2, exactly: near the critical point k is 1 up to rounding
    integral = float(ellipkm1(factor**2)) if factor else 0.0
    return -coupling / math.tanh(doubled) * (1.0 + 2.0 / math.pi * factor * integral)


def yang_magnetisation(coupling: float, kT: float) -> float:
    """Mean spin of an infinite square lattice without a field, 0 from the critical point on.

    Parameters: `coupling` J, above 0; `kT`, in its unit. (1 - sinh(2 J/kT)^-4)^(1/8). Raises
    ValueError unless both are above 0. Source: C. N. Yang, Phys. Rev. 85, 808 (1952), eq. 96.

    >>> round(yang_magnetisation(1.0, 2.0), 5), yang_magnetisation(1.0, 2.5)
    (0.91132, 0.0)
    """
    positive(coupling=coupling, kT=kT)
    ordered = math.sinh(min(2.0 * coupling / kT, 300.0))
    return (1.0 - ordered**-4) ** 0.125 if ordered > 1 else 0.0


def spin_correlation_length(coupling: float, kT: float, dimension: int) -> float:
    """Distance over which correlations of spins fall to 1/e, along an axis, in sites; no field.

    Parameters: `coupling` J, above 0; `kT`, in its unit; `dimension` 1 of an infinite chain, 2 of
    an infinite square lattice. With K = J/kT the inverse is ln coth K on a chain; on a square
    lattice ln coth K - 2K above the critical temperature, twice its negative below, 0 there. Raises
    ValueError for another dimension, or unless J and kT are above 0. Source: E. Ising, Z. Phys. 31,
    253 (1925); B. M. McCoy and T. T. Wu, The Two-Dimensional Ising Model (1973), chapter XI.

    >>> round(spin_correlation_length(1.0, 3.0, 2), 4), spin_correlation_length(1.0, 2.0, 2) < 4
    (2.1365, True)
    """
    positive(coupling=coupling, kT=kT)
    if dimension not in (1, 2):
        raise ValueError(f"dimension = {dimension!r}: expected 1 or 2")
    # ln coth K = 2 artanh exp(-2K) = ln((1 + x)/(1 - x)), without a loss of digits for large K
    chain = 2.0 * math.atanh(math.exp(-2.0 * coupling / kT))
    inverse = chain if dimension == 1 else chain - 2.0 * coupling / kT
    inverse = inverse if inverse >= 0 else -2.0 * inverse
    return 1.0 / inverse if inverse > 1e-12 else math.inf


def potts_critical_energy(coupling: float, states: int) -> tuple[float, float]:
    """Temperature at which an infinite square lattice of Potts spins orders, and its energy there.

    Parameters: `coupling` J of alike neighbours, above 0; `states` q of a spin, 2 to 4, where the
    energy is continuous. kT = J / ln(1 + sqrt(q)), by duality, and the energy of a site -J (1 +
    1/sqrt(q)). Raises ValueError for another number of states. Source: R. B. Potts, Math. Proc.
    Camb. Phil. Soc. 48, 106 (1952); F. Y. Wu, Rev. Mod. Phys. 54, 235 (1982).

    >>> [round(number, 5) for number in potts_critical_energy(1.0, 3)]
    [0.99497, -1.57735]
    """
    positive(coupling=coupling)
    if states not in (2, 3, 4):
        raise ValueError(f"states = {states!r}: expected 2, 3 or 4")
    root = math.sqrt(states)
    return coupling / math.log(1.0 + root), -coupling * (1.0 + 1.0 / root)


def chain_energy(coupling: float, kT: float, spins: int) -> float:
    """Energy of a spin in a ring of spins without a field.

    Parameters: `coupling` J; `kT`; `spins`, at least 2. From the eigenvalues of the transfer
    matrix: -J (t + t^(n-1)) / (1 + t^n) with t = tanh(J/kT). Raises ValueError for another number
    or temperature. Source: E. Ising, Z. Phys. 31, 253 (1925); H. A. Kramers and G. H. Wannier,
    Phys. Rev. 60, 252 (1941).

    >>> round(chain_energy(1.0, 1.0, 1000), 5)
    -0.76159
    """
    positive(kT=kT)
    whole(2, spins=spins)
    t = math.tanh(coupling / kT)
    return -coupling * (t + t ** (spins - 1)) / (1.0 + t**spins)


def chain_correlation(
    distance: ArrayLike, coupling: float, kT: float, spins: int
) -> NDArray[np.float64]:
    """Mean product of two spins in a ring without a field.

    Parameters: `distance` r in sites; `coupling` J; `kT`; `spins` n, at least 2. From the
    eigenvalues of the transfer matrix: (t^r + t^(n-r)) / (1 + t^n) with t = tanh(J/kT), in a long
    ring exp(-r/length) with the length -1/ln(t). Raises ValueError for another number or
    temperature. Source: H. A. Kramers and G. H. Wannier, Phys. Rev. 60, 252 (1941).

    >>> chain_correlation([0, 1, 2], 1.0, 1.0, 1000).round(5).tolist()
    [1.0, 0.76159, 0.58003]
    """
    positive(kT=kT)
    whole(2, spins=spins)
    r, t = np.asarray(distance, float), math.tanh(coupling / kT)
    return np.asarray((t**r + t ** (spins - r)) / (1.0 + t**spins))


def row_correlation(distance: int, coupling: float, kT: float) -> float:
    """Mean product of two spins in a row of an infinite square lattice without a field.

    Parameters: `distance` r in sites; `coupling` J, above 0; `kT`. A Toeplitz determinant of r rows
    whose elements are the Fourier coefficients of sqrt((1 - a e^(iq)) (1 - b e^(-iq)) / ((1 - a
    e^(-iq)) (1 - b e^(iq)))), with a = z (1 - z)/(1 + z), b = (1 - z)/(z (1 + z)) and z =
    tanh(J/kT). Raises ValueError unless both are above 0, and at the critical point. Source: E. W.
    Montroll, R. B. Potts and J. C. Ward, J. Math. Phys. 4, 308 (1963).

    >>> round(row_correlation(1, 1.0, 3.0), 5) == round(-onsager_energy(1.0, 3.0) / 2, 5)
    True
    >>> round(row_correlation(40, 1.0, 2.0) ** 0.5, 4), round(yang_magnetisation(1.0, 2.0), 4)
    (0.9113, 0.9113)
    """
    positive(coupling=coupling, kT=kT)
    whole(0, distance=distance)
    if distance == 0:
        return 1.0
    z = math.tanh(coupling / kT)
    a, b = z * (1 - z) / (1 + z), (1 - z) / (z * (1 + z))
    if b == 1:
        raise ValueError(f"kT = {kT!r}: expected another temperature than the critical one")
    from scipy.linalg import toeplitz

    q = 2 * math.pi * np.arange(ANGLES) / ANGLES
    turn = np.exp(1j * q)
    # a product of roots of numbers around 1, or of 1 - b e^(iq) = -b e^(iq) (1 - e^(-iq)/b)
    one = np.sqrt(1 - a * turn) / np.sqrt(1 - a / turn)
    if b < 1:
        other = np.sqrt(1 - b / turn) / np.sqrt(1 - b * turn)
    else:
        other = -np.sqrt(1 - turn / b) / np.sqrt(1 - 1 / (turn * b)) / turn
    elements = np.fft.fft(one * other).real / ANGLES  # of e^(iq n) at n
    rows = np.arange(distance)
    return float(np.linalg.det(toeplitz(elements[rows], elements[-rows])))


def glauber_walls(time: ArrayLike) -> NDArray[np.float64]:
    """Part of the bonds of a chain that join unlike spins, after a quench to temperature 0.

    Parameters: `time` in inverse rates of a flip in no field, from spins at random. With Glauber's
    rate (1 - s (s_left + s_right)/2)/2 it is exp(-2t) (I_0(2t) + I_1(2t))/2. Raises ValueError for
    negative times. Source: R. J. Glauber, J. Math. Phys. 4, 294 (1963).

    >>> glauber_walls([0.5, 1.0, 2.0, 5.0]).round(4).tolist()
    [0.3368, 0.2619, 0.1929, 0.1245]
    """
    found = np.asarray(time, float)
    not_negative(time=float(found.min(initial=0.0)))
    from scipy.special import ive

    return np.asarray(0.5 * (ive(0, 2 * found) + ive(1, 2 * found)))


def counted_spins(
    bonds: NDArray[np.integer], spins: int, coupling: float, field: float, kT: float
) -> dict[str, float]:
    """Exact means of a few spins, by a sum over all their states.

    Parameters: `bonds` (n, 2) numbers of the spins that are coupled, one row for each bond;
    `spins`, at most 20; `coupling` J, `field` h and `kT`. The means of the energy of a spin, of its
    square, of the mean spin m, its size, its square and its fourth power. Raises ValueError for
    more spins. Source: Boltzmann's distribution.

    >>> rows = [(i, i // 4 * 4 + (i + 1) % 4) for i in range(16)]
    >>> bonds = np.array(rows + [(i, (i + 4) % 16) for i in range(16)])
    >>> found = counted_spins(bonds, 16, 1.0, 0.0, 2 / np.log(1 + 2**0.5))
    >>> round(found["energy"], 5), round(found["size"], 5)
    (-1.56562, 0.84386)
    """
    positive(kT=kT)
    if not 1 <= spins <= MOST_SPINS:
        raise ValueError(f"spins = {spins!r}: expected 1 to {MOST_SPINS}")
    states = (np.arange(2**spins)[:, None] >> np.arange(spins)) & 1
    s = (2 * states - 1).astype(np.int8)
    energy = -field * s.sum(axis=1, dtype=float)
    for i, j in np.asarray(bonds):
        energy -= coupling * (s[:, i] * s[:, j])
    weight = np.exp(-(energy - energy.min()) / kT)
    weight /= weight.sum()
    m, e = s.mean(axis=1), energy / spins
    return {
        "energy": float(weight @ e),
        "square energy": float(weight @ e**2),
        "mean": float(weight @ m) if field else 0.0,  # by symmetry, without rounding
        "size": float(weight @ abs(m)),
        "square": float(weight @ m**2),
        "fourth": float(weight @ m**4),
    }
