"""Coordination at which forces of rigid grains follow from force balance alone."""

from mesokit.theory._check import dimension_two_or_three, whole


def isostatic_coordination(dimension: int, friction: bool, grains: int | None = None) -> float:
    """Mean number of contacts of a grain at which forces are as many as equations of balance.

    Without friction each contact has one force and each grain d equations: 2 d. With infinite
    friction a contact has d forces and a grain d (d + 1)/2 equations, torques among them: d + 1. A
    finite friction lies between. In a periodic box the d sums of all forces are 0 by themselves,
    and grains under pressure have one state of stress more than equations (Goodrich, Liu and Nagel
    2012): 2 d - 2 (d - 1)/N without friction, and d + 1 - 2 (1 - 1/d)/N with it.

    Parameters: `dimension` 2 or 3; `friction` whether contacts hold along the surface; `grains`
    their number N in a periodic box, without those that carry nothing (rattlers); None for many.

    Raises ValueError for another dimension, or fewer than two grains. Source: S. Alexander, Phys.
    Rep. 296, 65 (1998). Exact for the count of equations; packings without friction have it when
    they just bear a load, those with friction have more contacts.

    >>> [isostatic_coordination(d, friction) for friction in (False, True) for d in (2, 3)]
    [4.0, 6.0, 3.0, 4.0]
    >>> round(isostatic_coordination(2, False, grains=100), 6)
    3.98
    """
    dimension_two_or_three(dimension)
    infinite = dimension + 1.0 if friction else 2.0 * dimension
    if grains is None:
        return infinite
    whole(2, grains=grains)
    return infinite - 2 * (dimension - 1) / grains / (dimension if friction else 1)
