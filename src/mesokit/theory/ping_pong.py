"""A ball that bounces on a floor under gravity, with and without a contact time."""

from __future__ import annotations

import math


def bounce_height(height: float, restitution: float, bounces: int) -> float:
    """How high it flies after some bounces: h e^(2n).

    Parameters
    ----------
    height : float
        From which it falls at rest, in a.
    restitution : float
        Speed after a bounce over that before.
    bounces : int
        How many.

    Examples
    --------
    >>> round(bounce_height(1.0, 0.9, 10), 6)
    0.121577
    """
    return float(height * restitution ** (2 * bounces))


def bounce_time(height: float, gravity: float, restitution: float, bounces: int) -> float:
    """When the n-th bounce is, after the ball has begun to fall.

    The first is after sqrt(2 h/g), each flight after that takes e times the one before. Infinitely
    many bounces take sqrt(2 h/g) (1 + e)/(1 - e).

    Parameters
    ----------
    height : float
        From which it falls at rest, in a.
    gravity : float
        In a/time^2.
    restitution : float
        Below 1.
    bounces : int
        From 1.

    Examples
    --------
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

    Parameters
    ----------
    height : float
        From which it falls at rest, in a.
    gravity : float
        In a/time^2.
    restitution : float
        Above 0 and below 1.
    contact_time : float
        Shorter than the first flight.

    Examples
    --------
    >>> [dissipative_bounces(1.0, 1.0, e, 0.01) for e in (0.5, 0.8, 0.9)]
    [9, 26, 54]
    """
    flights = math.log(contact_time * math.sqrt(gravity / (8 * height))) / math.log(restitution)
    return math.ceil(flights)
