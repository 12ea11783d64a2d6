"""A ball that bounces on a floor under gravity, with and without a contact time."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray


def bounce_height(height: float, restitution: float, bounces: int) -> float:
    """How high it flies after some bounces: h e^(2n).

    Parameters: `height` from which it falls at rest, in a; `restitution` speed after a bounce over
    that before; `bounces` their number.

    >>> round(bounce_height(1.0, 0.9, 10), 6)
    0.121577
    """
    return float(height * restitution ** (2 * bounces))


def bounce_time(height: float, gravity: float, restitution: float, bounces: int) -> float:
    """When the n-th bounce is, after the ball has begun to fall.

    The first is after sqrt(2 h/g), each flight after that takes e times the one before. Infinitely
    many bounces take sqrt(2 h/g) (1 + e)/(1 - e).

    Parameters: `height` from which it falls at rest, in a; `gravity` in a/time^2; `restitution`
    below 1; `bounces` from 1.

    >>> round(bounce_time(1.0, 1.0, 0.5, 1), 6), round(bounce_time(1.0, 1.0, 0.5, 60), 6)
    (1.414214, 4.242641)
    """
    e = restitution
    return math.sqrt(2 * height / gravity) * (1 + 2 * e * (1 - e ** (bounces - 1)) / (1 - e))


def dissipative_bounces(
    height: float, gravity: float, restitution: float, contact_time: float
) -> int:
    """How many bounces lose energy where those sooner than a contact time after another do not.

    n = ceil(ln(t_c sqrt(g/(8 h)))/ln e) (the model of Luding and McNamara 1998): the flight after
    the n-th bounce is the first that is shorter than t_c. Then the ball goes on for ever.

    Parameters: `height` from which it falls at rest, in a; `gravity` in a/time^2; `restitution`
    above 0 and below 1; `contact_time` shorter than the first flight.

    >>> [dissipative_bounces(1.0, 1.0, e, 0.01) for e in (0.5, 0.8, 0.9)]
    [9, 26, 54]
    """
    flights = math.log(contact_time * math.sqrt(gravity / (8 * height))) / math.log(restitution)
    return math.ceil(flights)


def lossy_bounces(
    time: ArrayLike, height: float, gravity: float, restitution: float, contact_time: float = 0.0
) -> NDArray[np.int64]:
    """How many bounces have lost energy by some times: all, but for those of a contact time.

    Without a contact time those after some 10^-15 of the first flight are counted no more.

    Parameters: `time` since the ball began to fall; `height`, `gravity`, `restitution`,
    `contact_time` as of `dissipative_bounces`; the contact time may be 0.

    >>> lossy_bounces([1.0, 2.0, 100.0], 1.0, 1.0, 0.5, 0.01).tolist()
    [0, 1, 9]
    """
    starts = _starts(height, gravity, restitution, contact_time)
    return np.asarray(np.searchsorted(starts, np.asarray(time, float), side="right"), np.int64)


def bounce_path(
    time: ArrayLike, height: float, gravity: float, restitution: float, contact_time: float = 0.0
) -> NDArray[np.float64]:
    """How high the ball is at some times.

    Parameters: `time` since it began to fall; `height`, `gravity` from which it falls at rest;
    `restitution` above 0, up to 1; `contact_time` bounces sooner than this after another lose
    nothing; 0 for none: the ball then lies still after infinitely many bounces.

    >>> bounce_path([0.0, 1.0, 2**0.5 + 1.0, 50.0], 1.0, 1.0, 0.5).round(6).tolist()
    [1.0, 0.5, 0.207107, 0.0]
    >>> bool(bounce_path(50.0, 1.0, 1.0, 0.5, 0.1) > 0)
    True
    """
    given = height, gravity, restitution, contact_time
    t = np.asarray(time, float)
    number, starts = lossy_bounces(t, *given), _starts(*given)
    speed = math.sqrt(2 * gravity * height) * restitution**number
    since = t - starts[np.maximum(number, 1) - 1]
    if contact_time > 0 or restitution == 1:  # for ever, one flight like another
        flight = 2 * speed / gravity
        since = np.where(number == len(starts), np.mod(since, flight), since)
    else:
        speed = np.where(number == len(starts), 0.0, speed)
        since = np.where(number == len(starts), 0.0, since)
    flying = speed * since - 0.5 * gravity * since**2
    return np.where(number == 0, height - 0.5 * gravity * t**2, flying)


def _starts(
    height: float, gravity: float, restitution: float, contact_time: float
) -> NDArray[np.float64]:
    """When the bounces are that lose energy; of an elastic ball the first."""
    if restitution == 1:
        return np.array([math.sqrt(2 * height / gravity)])
    if contact_time > 0:
        number = max(dissipative_bounces(height, gravity, restitution, contact_time), 1)
    else:
        number = 1 + math.ceil(math.log(1e-15) / math.log(restitution))
    bounces = range(1, number + 1)
    return np.array([bounce_time(height, gravity, restitution, n) for n in bounces])
