"""Columns of the log of an MPCD fluid."""

from collections.abc import Collection
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.seam.engine import RunningFluid
from mesokit.seam.method import Columns

Array = NDArray[np.floating[Any]]


def columns(case: Case) -> Columns:
    """Temperature, energies, momentum and mean velocity of all particles, beads included."""
    bonded = case.fluid.molecule is not None or case.solutes is not None
    energies = ("kinetic energy", *("potential energy", "total energy") * bonded)
    momenta = tuple(f"momentum {axis}" for axis in case.box.axes)
    velocities = tuple(f"velocity {axis}" for axis in case.box.axes)

    def read(engine: RunningFluid, wanted: Collection[str]) -> dict[str, float]:
        number, momentum, kinetic = engine.totals()
        values = [temperature(case, number, momentum, kinetic), kinetic]
        if bonded:
            needed = {"potential energy", "total energy"} & set(wanted)
            potential = engine.potential_energy() if needed else np.nan
            values += [potential, kinetic + potential]
        values += [*momentum, *(momentum / (total_mass(case, number) or np.nan))]
        found = dict(zip(names, values, strict=True))
        return {name: float(found[name]) for name in wanted}

    names = ("temperature", *energies, *momenta, *velocities)
    return Columns(names, ("temperature", *energies[:2], *velocities), read)


def total_mass(case: Case, number: int) -> float:
    """Of so many particles, all there are."""
    mass = number * case.fluid.mass
    if case.solutes is not None:
        mass += case.solutes.sum_over_mass(lambda own: own - case.fluid.mass)
    return float(mass)


def temperature(case: Case, number: int, momentum: Array, energy: float) -> float:
    """Twice the energy per degree of freedom; a free fluid cannot move as a whole."""
    d = case.box.dimension
    if number == 0:
        return float(np.nan)
    if case.walls or in_random_solvent(case):
        return 2 * energy / (d * number)
    about_mean = 2 * energy - float(momentum @ momentum) / total_mass(case, number)
    return about_mean / (d * max(number - 1, 1))


def in_random_solvent(case: Case) -> bool:
    """True if the solvent takes momentum and energy, and does not return them."""
    return case.solutes is not None and case.solutes.solvent == "random"
