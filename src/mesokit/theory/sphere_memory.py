"""Memory of a sphere in a viscous fluid: how its velocity and its angular velocity decay."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import positive
from mesokit.theory.velocity_autocorrelation import _after_zero

Array = NDArray[np.float64]
NEARLY_ONE, APART = 1e-6, 1e-9  # slope of a polynomial at two roots; change of its coefficient


def sphere_vacf(
    time: ArrayLike, radius: float, viscosity: float, density: float, mass: float, kT: float = 1.0
) -> Array:
    """Velocity autocorrelation of a sphere, one component, in a wide incompressible fluid.

    The inverse Laplace transform of kT/(M s + 6 pi eta R (1 + a + a^2/9)), a = R sqrt(s/nu): drag
    with the memory of the fluid. It begins at kT/(M + M_f/2), M_f the mass of fluid in its place,
    and ends in `vacf_tail`, from which it differs by a tenth still at 6 R^2/nu.

    Parameters: `time` t above 0, any shape; `radius` R; `viscosity` nu, kinematic; `density` rho of
    mass of the fluid; `mass` M of the sphere; `kT`. Raises ValueError for a value out of range.
    Source: R. Zwanzig and M. Bixon, Phys. Rev. A 2, 2005 (1970), with the correction of 1975; E. J.
    Hinch, J. Fluid Mech. 72, 499 (1975). Valid without slip, after sound has passed R.

    >>> from mesokit.theory import vacf_tail
    >>> early, late = 20.0, 2000.0
    >>> tail = vacf_tail([early, late], viscosity=0.4, diffusion=0, density=10, dimension=3)
    >>> (sphere_vacf([early, late], 2, 0.4, 10, 335.1) / tail).round(3)
    array([0.778, 0.998])
    """
    positive(radius=radius, viscosity=viscosity, density=density, mass=mass, kT=kT)
    heavy = 2 / 9 * mass / (density * 4 / 3 * math.pi * radius**3)
    unit = 6 * math.pi * viscosity * density * radius
    return kT / unit * _decay(time, radius, viscosity, [1], [1 / 9 + heavy, 1, 1])


def sphere_angular_vacf(
    time: ArrayLike,
    radius: float,
    viscosity: float,
    density: float,
    inertia: float,
    kT: float = 1.0,
) -> Array:
    """Angular-velocity autocorrelation of a sphere, about one axis, in a wide fluid.

    The inverse Laplace transform of kT/(I s + 8 pi eta R^3 (1 + a^2/(3 + 3 a))), a = R sqrt(s/nu).
    It begins at kT/I and ends in `angular_vacf_tail`.

    Parameters: as in `sphere_vacf`; `inertia` I of the sphere. Raises ValueError for a value out of
    range. Source: E. H. Hauge and A. Martin-Lof, J. Stat. Phys. 7, 259 (1973). Valid without slip.

    >>> from mesokit.theory import angular_vacf_tail
    >>> late = 2000.0
    >>> tail = angular_vacf_tail(late, viscosity=0.4, diffusion=0, density=10, dimension=3)
    >>> round(float(sphere_angular_vacf(late, 2, 0.4, 10, 536.2) / tail), 3)
    0.998
    """
    positive(radius=radius, viscosity=viscosity, density=density, inertia=inertia, kT=kT)
    unit = 8 * math.pi * viscosity * density * radius**3
    heavy = inertia * viscosity / (unit * radius**2)
    friction = [3 * heavy, 1 + 3 * heavy, 3, 3]  # times 3 (1 + a)
    return kT / unit * _decay(time, radius, viscosity, [3, 3], friction)


def _decay(
    time: ArrayLike,
    radius: float,
    viscosity: float,
    above: Sequence[float],
    below: Sequence[float],
) -> Array:
    """Inverse Laplace transform of a ratio of polynomials in R sqrt(s/nu), highest power first.

    In partial fractions: that of 1/(sqrt(s) - r) is 1/sqrt(pi t) + r exp(r^2 t) erfc(-r sqrt(t)).
    The first terms cancel where the degrees differ by two or more.
    """
    from scipy.special import wofz

    t = np.asarray(_after_zero(time) * viscosity / radius**2)[..., None]
    roots = np.roots(below)
    slopes = np.polyval(np.polyder(below), roots)
    if abs(slopes).min() < NEARLY_ONE:  # two terms are large and cancel: roots slightly apart
        return _decay(time, radius, viscosity, above, [below[0] * (1 + APART), *below[1:]])
    shares = np.polyval(above, roots) / slopes
    found = (shares * roots * wofz(-1j * roots * np.sqrt(t))).sum(axis=-1)
    return np.asarray(viscosity / radius**2 * found.real)
