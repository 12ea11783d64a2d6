"""A sphere that a force draws along the middle of a slit."""

import math
from collections.abc import Mapping

from mesokit.theory._check import one_of, positive

# What other spheres of a periodic square add, in h R/A, by what takes the force
PERIODIC: Mapping[str, float] = {"plates": 9 / 8, "uniform": -3 / 8, "no flux": -9 / 8}


def slit_mobility(
    radius: float, half_width: float, area: float | None = None, taken_by: str = "plates"
) -> float:
    """Mobility along the middle of a slit of half width h over that of Stokes, 1/(6 pi eta R).

    1 - 1.004 R/h + 0.418 (R/h)^3 + 0.21 (R/h)^4 - 0.169 (R/h)^5, and pi h R/A times 9/8 where the
    slit is periodic after a square of area A.

    Parameters: `radius` R and `half_width` h in cells; `area` A of the plates (none: infinite);
    `taken_by` what takes the force: "plates" alone, which the whole fluid then drags along; also a
    "uniform" counter-force on all between them, -3/8; also a pressure that lets "no flux" pass,
    -9/8. Raises ValueError for a value out of range. Source: H. Faxen, Ark. Mat. Astron. Fys. 17,
    27 (1923); J. Happel and H. Brenner, Low Reynolds Number Hydrodynamics (1965); the periodic part
    derived in docs/theory.md. Valid without slip and inertia, for R/h up to about 0.5 and squares
    wider than the slit.

    >>> round(slit_mobility(2.0, 10.0), 3), round(slit_mobility(3.5, 10.0), 3)
    (0.803, 0.669)
    >>> round(slit_mobility(2.0, 10.0, area=1600.0), 3)
    0.847
    """
    positive(radius=radius, half_width=half_width)
    one_of(tuple(PERIODIC), taken_by=taken_by)
    if radius >= half_width:
        raise ValueError(f"radius = {radius!r}: expected below half_width = {half_width!r}")
    x = radius / half_width
    alone = 1 - 1.004 * x + 0.418 * x**3 + 0.21 * x**4 - 0.169 * x**5
    if area is None:
        return alone
    positive(area=area)
    return alone + math.pi * PERIODIC[taken_by] * half_width * radius / area
