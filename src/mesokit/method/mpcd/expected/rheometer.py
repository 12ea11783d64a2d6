"""What theory expects of a fluid whose shear changes in time."""

import math

import numpy as np

from mesokit import theory
from mesokit.case.case import Case
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.molecules import times_in_shear, without_bonds
from mesokit.method.mpcd.expected.selection import molecule_of

FORGOTTEN = 15.0  # relaxation times


def modulus_of(case: Case) -> float:
    """phi kT of a fluid of molecules: their number a volume times kT."""
    return case.fluid.density / molecule_of(case).length * case.fluid.kT


def modes_of_stress(case: Case) -> tuple[float, list[float], float] | None:
    """phi kT, stress times and viscosity (dynamic) without bonds, as theory takes them.

    None for solutes, bonds that are no Hookean springs, and rules without a theory.
    """
    coefficients = without_bonds(case)
    if coefficients is None:
        return None
    viscosity = coefficients.viscosity * setting.mass_density(case)
    if case.fluid.molecule is None:
        return case.fluid.density * case.fluid.kT, [], viscosity
    times = times_in_shear(case)
    if times is None:
        return None
    return modulus_of(case), [float(tau) for tau in times.stress], viscosity


def stress_of_history(case: Case, steps: int, first: int, count: int) -> theory.StressInTime | None:
    """Stress in each of `steps` steps, averaged over `count` repetitions from number `first` on.

    None where there is no theory, and where the run goes on from another one: what that did
    before, its molecules may remember.
    """
    known = modes_of_stress(case)
    if known is None or case.fluid.start.run is not None or case.fluid.force.acts:
        return None
    modulus, times, viscosity = known
    history, timestep = case.box.history, case.fluid.timestep
    # repetitions until the start is forgotten: all later ones are like the last of these
    memory = math.ceil(FORGOTTEN * max(times, default=0.0) / (steps * timestep)) + 1
    number = min(first + count, first + memory)
    time = np.arange(number * steps + 1) * timestep
    strain = np.zeros(len(time))
    if history is not None:  # images keep the speed of the middle of each step
        middles = 0.5 * (time[1:] + time[:-1])
        strain[1:] = timestep * np.cumsum([history.rate_at(t) for t in middles.tolist()])
    found = theory.stress_in_time(time, strain, modulus, times, viscosity)
    weights = np.ones(number - first)
    weights[-1] += count - len(weights)
    parts = (part.reshape(number, steps)[first:] for part in found)
    return theory.StressInTime(*(weights @ part / count for part in parts))


def spreading_time(case: Case) -> float:
    """The time in which momentum spreads over half the height of the box, L^2/(4 pi^2 nu)."""
    coefficients = without_bonds(case)
    assert coefficients is not None
    return case.box.size[1] ** 2 / (4 * math.pi**2 * coefficients.viscosity)
