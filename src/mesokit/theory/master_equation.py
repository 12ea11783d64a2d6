"""The master equation of a walker between states: what is steady, and what relaxes."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import not_negative

DIGITS = 9  # to which steps of time are alike
ROUNDING = 1e-13  # of the largest eigenvalue


def steady_occupation(rates: ArrayLike) -> NDArray[np.float64]:
    """Probability (s,) of each state in the steady state of a walker; nan where that depends on the
    start.

    Parameters: `rates` (s, s) in 1/time, from the state of the row to that of the column; the
    diagonal has no meaning. By elimination without subtractions, exact for rates of any ratio.
    Raises ValueError for negative rates. Source: W. K. Grassmann, M. I. Taksar and D. P. Heyman,
    Oper. Res. 33, 1107 (1985).

    >>> steady_occupation([[0, 3], [1, 0]]).tolist()
    [0.25, 0.75]
    """
    left = _off_diagonal(rates)
    reached = np.eye(len(left), dtype=bool) | (left > 0)
    for _ in range(len(left).bit_length()):
        reached = reached @ reached
    lasting = np.flatnonzero(reached.all(axis=0))  # whatever the start, a walker comes there
    if not len(lasting):
        return np.full(len(left), np.nan)
    left = left[np.ix_(lasting, lasting)]
    for k in range(len(left) - 1, 0, -1):  # leave out state k: ways through it become direct
        left[:k, k] /= left[k, :k].sum()
        left[:k, :k] += np.outer(left[:k, k], left[k, :k])
    found = np.ones(len(left))
    for k in range(1, len(left)):
        found[k] = found[:k] @ left[:k, k]
    occupation = np.zeros(len(reached))
    occupation[lasting] = found / found.sum()
    return occupation


def occupation(rates: ArrayLike, first: ArrayLike, time: ArrayLike) -> NDArray[np.float64]:
    """Probability (t, s) of each state of a walker at some times, by the matrix exponential.

    Parameters: `rates` (s, s) in 1/time as in `steady_occupation`; `first` (s,) probabilities at
    time 0; `time` (t,) growing times. Raises ValueError for negative rates, and for times that do
    not grow. Source: N. G. van Kampen, Stochastic Processes in Physics and Chemistry (2007), V.

    >>> occupation([[0, 3], [1, 0]], [1, 0], [0.0, 0.25]).round(4).tolist()
    [[1.0, 0.0], [0.5259, 0.4741]]
    """
    from scipy.linalg import expm

    flow = _off_diagonal(rates)
    flow -= np.diag(flow.sum(axis=1))
    times, now = np.asarray(time, float), np.asarray(first, float)
    steps = np.diff(times, prepend=0.0)
    not_negative(step=float(steps.min(initial=0.0)))
    after: dict[float, NDArray[np.float64]] = {}
    found = np.zeros((len(times), len(flow)))
    for k, step in enumerate(steps.tolist()):
        alike = float(f"{step:.{DIGITS}g}")
        if alike not in after:
            after[alike] = expm(flow * step)
        now = now @ after[alike]
        found[k] = now
    return found


def slowest_relaxation(rates: ArrayLike) -> float:
    """The longest time in which the probabilities of a walker's states relax, 1/time of the rates.

    Parameters: `rates` (s, s) as in `steady_occupation`. The inverse of the smallest real part of
    the eigenvalues of the master equation but the one that is 0. Raises ValueError for negative
    rates. Source: N. G. van Kampen, Stochastic Processes in Physics and Chemistry (2007), V.

    >>> slowest_relaxation([[0, 3], [1, 0]])
    0.25
    """
    flow = _off_diagonal(rates)
    flow -= np.diag(flow.sum(axis=1))
    decay = np.sort(-np.linalg.eigvals(flow).real)
    return float(1.0 / decay[1]) if decay[1] > ROUNDING * decay[-1] else float("inf")


def _off_diagonal(rates: ArrayLike) -> NDArray[np.float64]:
    """Rates with 0 for what stays."""
    found = np.array(rates, float)
    np.fill_diagonal(found, 0.0)
    not_negative(rate=float(found.min(initial=0.0)))
    return found
