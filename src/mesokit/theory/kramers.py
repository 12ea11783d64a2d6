"""Escape over a barrier."""

import math

from mesokit.theory._check import positive


def kramers_rate(well: float, top: float, friction: float, barrier: float, kT: float) -> float:
    """Rate at which an overdamped particle leaves a well over one barrier that is high against kT.

    Parameters: `well` and `top`, the size of the curvature U'' there in energy/length^2; `friction`
    zeta = kT/D; `barrier` energy; `kT`. sqrt(U''_well |U''_top|)/(2 pi zeta) exp(-barrier/kT).
    Raises ValueError for numbers not above 0. Source: H. A. Kramers, Physica 7, 284 (1940).

    >>> round(kramers_rate(48.0, 24.0, 1.0, 6.0, 1.0), 6)
    0.01339
    """
    positive(well=well, top=top, friction=friction, barrier=barrier, kT=kT)
    return math.sqrt(well * top) / (2 * math.pi * friction) * math.exp(-barrier / kT)
