"""Columns of the log of an MPCD fluid."""

from collections.abc import Collection
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.trajectory import Kind
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
    mass += sum(kind.number * (kind.mass - case.fluid.mass) for kind in kinds_of_bodies(case))
    return float(mass)


def kinds_of_bodies(case: Case) -> tuple[Kind, ...]:
    """Masses and numbers of bodies; () without any."""
    return case.groups[-1].kinds if case.bodies else ()


def freedoms(case: Case, number: int, free: bool) -> int:
    """Degrees of freedom of so many particles and bodies, of which the mean velocity is none where
    they are `free`."""
    d = case.box.dimension
    turning = sum(kind.number * turns(kind, d) for kind in case.bodies)
    still = sum(kind.number * len({*kind.fixed} - {"orientation"}) for kind in case.bodies)
    return d * (number - free) + turning - still


def turns(kind: Any, dimension: int) -> int:
    """Axes about which a body may turn."""
    if "orientation" in kind.fixed:
        return 0
    return 1 if kind.hinge is not None or dimension == 2 else 3


def holds(case: Case) -> bool:
    """Whether something beside the fluid takes the momentum of bodies, or gives them some."""
    return any(
        {*kind.fixed} - {"orientation"}
        or (kind.trap is not None and kind.trap.k > 0)
        or (kind.force is not None and any(kind.force) and not kind.balanced)
        for kind in case.bodies
    )


def temperature(case: Case, number: int, momentum: Array, energy: float) -> float:
    """Twice the energy per degree of freedom; a free fluid cannot move as a whole."""
    if number == 0:
        return float(np.nan)
    if case.walls or in_random_solvent(case) or holds(case):
        return 2 * energy / freedoms(case, number, free=False)
    about_mean = 2 * energy - float(momentum @ momentum) / total_mass(case, number)
    return about_mean / max(freedoms(case, number, free=True), 1)


def in_random_solvent(case: Case) -> bool:
    """True if the solvent takes momentum and energy, and does not return them."""
    return case.solutes is not None and case.solutes.solvent == "random"
