"""Cylinders in the middle of a channel: reference values of simulations and experiments, as data.

There are no formulas: each value has its source and error, and says how sure it is. D is the
diameter (side, for a square), H the height of the channel, L_r the length of the wake in which the
fluid flows back, from the rear of the cylinder. Drag coefficients are 2F/(rho U^2 D).
"""

import itertools
from typing import NamedTuple

LATTICE = "lattice Boltzmann simulation made for mesokit"
TUREK = "M. Schafer and S. Turek, Notes Numer. Fluid Mech. 52, 547 (1996)"
SAHIN = "M. Sahin and R. G. Owens, Phys. Fluids 16, 1305 (2004)"
PUBLISHED = "published range"
RECALLED = "quoted from memory: check before relying on it"


class Reference(NamedTuple):
    """A number to compare with: what, at which Reynolds number, its error, source, how sure."""

    what: str
    reynolds: float
    value: float
    error: float
    source: str
    sure: str


TWICE = "two resolutions agree to 0.2 %"
# Slit driven by g, periodic after 2H, D = H/4, Reynolds number well below 1.
CREEPING = (
    Reference("mean velocity of the fluid, in g H^2/nu", 0, 0.0284, 0.0001, LATTICE, TWICE),
    Reference("share of the force on the cylinder", 0, 0.439, 0.0005, LATTICE, TWICE),
)

CHECKED = "the same code gives the published values of test 2D-1 to 2 %"
# D/H = 1/8, parabolic inflow, Re = u_max D/nu, U = u_max.
INERTIAL = tuple(
    Reference(what, reynolds, value, 0.02 * value, LATTICE, CHECKED)
    for what, values in (
        ("L_r/D", {10: 0.145, 20: 0.768, 30: 1.356, 40: 1.916}),
        ("drag coefficient", {10: 3.29, 20: 2.23, 30: 1.83, 40: 1.60}),
    )
    for reynolds, value in values.items()
)

# D/H = 0.1/0.41, 0.005/0.41 H off the middle, parabolic inflow, U = mean velocity.
OFF_CENTRE = (
    Reference("L_r/D", 20, 0.847, 0.005, TUREK, PUBLISHED),
    Reference("drag coefficient", 20, 5.58, 0.01, TUREK, PUBLISHED),
    Reference("Strouhal number", 100, 0.300, 0.005, TUREK, PUBLISHED),
    Reference("largest drag coefficient", 100, 3.23, 0.01, TUREK, PUBLISHED),
    Reference("largest lift coefficient", 100, 1.00, 0.01, TUREK, PUBLISHED),
)

# Where vortices begin to be shed: D/H, Re = u_max D/nu, and the Strouhal number with u_max.
ONSET = {
    blockage: Reference("Strouhal number", reynolds, strouhal, 0.01 * strouhal, SAHIN, RECALLED)
    for blockage, reynolds, strouhal in (
        (0.1, 50.8, 0.121), (0.2, 69.4, 0.157), (0.3, 94.6, 0.209), (0.5, 124.1, 0.339),
    )
}  # fmt: skip


def square_wake_length(reynolds: float) -> float:
    """L_r/D = -0.065 + 0.0554 Re of a square in a channel with D/H = 1/8, Re = u_max D/nu.

    Parameters: `reynolds`, above 5 and below 60. Raises ValueError for others. Source: Breuer et
    al. (2000), quoted from memory: check before relying on it.

    >>> round(square_wake_length(20), 3)
    1.043
    """
    if not 5 < reynolds < 60:
        raise ValueError(f"reynolds = {reynolds!r}: expected more than 5 and less than 60")
    return -0.065 + 0.0554 * reynolds


def channel_cylinder(what: str, reynolds: float) -> Reference:
    """One of INERTIAL, the cylinder of D/H = 1/8: "L_r/D" or "drag coefficient" at Re.

    Between the tabulated 10, 20, 30 and 40 it is interpolated, linearly. Raises ValueError for
    others.

    >>> round(channel_cylinder("L_r/D", 15).value, 4)
    0.4565
    """
    known = [r for r in INERTIAL if r.what == what]
    if not known:
        raise ValueError(f"what = {what!r}: expected one of {sorted({r.what for r in INERTIAL})}")
    for low, high in itertools.pairwise(known):
        if low.reynolds <= reynolds <= high.reynolds:
            part = (reynolds - low.reynolds) / (high.reynolds - low.reynolds)
            value = low.value + part * (high.value - low.value)
            return low._replace(reynolds=reynolds, value=value, error=0.02 * value)
    raise ValueError(f"reynolds = {reynolds!r}: expected 10 to 40")
