"""Where bodies are between plates, by Boltzmann's distribution."""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.geometry.solids.solids import slit_of
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.bodies import Followed

Floats = NDArray[np.float64]
FINE = 400  # places in a cell
ALONE = "approximate: bodies that do not meet one another"
WARMER = "approximate: bodies that fall warm the fluid"


class Heights(NamedTuple):
    """Shares of the bins, the mean place, and what to say of both."""

    shares: Floats
    mean: float
    note: str


def in_balance(case: Case, axis: int) -> bool:
    """Whether bodies and fluid come to equilibrium: only forces along an axis between two plates at
    rest act."""
    plates = slit_of(case)
    closed = plates is not None and setting.closed_axes(case) == {axis}
    if setting.gives_momentum(case) or (case.walls and not closed):
        return False
    for kind in case.bodies:
        across = np.delete(np.array(kind.force or np.zeros(case.box.dimension)), axis)
        falls = np.any(kind.force or 0.0)
        if kind.swim is not None or np.any(kind.torque or 0.0) or across.any():
            return False
        if falls and (not closed or kind.frame == "body"):
            return False
    return True


def heights(of: Followed, axis: int, edges: Floats) -> Heights | None:
    """Of the centres of disks or spheres between plates at 0 and at the end of the box.

    The density is exp(-(U - F z)/kT) with the repulsion U of both plates and the force F along the
    axis: the barometric law but for the places next to a plate. None where it does not hold.
    """
    case, kind = of.case, of.kind
    solid, held = kind.solid(case.box.dimension), kind.trap is not None and kind.trap.k > 0
    known = case.walls and in_balance(case, axis) and solid.ball and axis in of.moving
    if not known or held or kind.interaction.depth == 0 or case.solutes is not None:
        return None
    kT, length = float(case.fluid.kT), float(case.box.size[axis])
    z = (np.arange(math.ceil(length * FINE)) + 0.5) / FINE
    force = float(kind.force[axis]) if kind.force is not None else 0.0
    energy = sum(_repulsion(kind.interaction, gap - solid.radius) for gap in (z, length - z))
    exponent = force * z / kT - energy
    weight = np.exp(exponent - exponent.max())
    counts, _ = np.histogram(z, edges, weights=weight)
    notes = [ALONE] * (sum(one.number for one in case.bodies) > 1)
    notes += [WARMER] * (force != 0 and not setting.isothermal(case) and not notes)
    total = float(weight.sum())
    return Heights(counts / total, float(z @ weight) / total, "; ".join(notes))


def _repulsion(interaction: Any, gap: Floats) -> Floats:
    """Energy of a gap over kT: infinite where a surface is in the wall."""
    with np.errstate(divide="ignore"):
        power = (interaction.range / np.maximum(gap, 0.0)) ** 6
    inside = np.where(gap < interaction.range, (power - 1) ** 2, 0.0)
    return np.asarray(interaction.depth * inside)
