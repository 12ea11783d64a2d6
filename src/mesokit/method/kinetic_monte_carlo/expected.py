"""Which theory belongs to a case on a lattice."""

from __future__ import annotations

import functools
import math

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.case import Case
from mesokit.method.kinetic_monte_carlo.lattice.grid import by_number, grid_of, neighbour
from mesokit.method.kinetic_monte_carlo.model.ballistic import Ballistic
from mesokit.method.kinetic_monte_carlo.model.exclusion import Exclusion
from mesokit.method.kinetic_monte_carlo.model.family import Family
from mesokit.method.kinetic_monte_carlo.model.ising import Ising
from mesokit.method.kinetic_monte_carlo.model.lattice_gas import LatticeGas
from mesokit.method.kinetic_monte_carlo.model.potts import Potts
from mesokit.method.kinetic_monte_carlo.model.random_deposition import RandomDeposition
from mesokit.method.kinetic_monte_carlo.model.rsos import RestrictedSolidOnSolid
from mesokit.method.kinetic_monte_carlo.model.single_step import SingleStep
from mesokit.method.kinetic_monte_carlo.start import sites_of

Known = tuple[float, str]  # a number and a note on its theory
UNKNOWN: Known = (math.nan, "")
FEW = 16  # spins, of which all states are counted
CRITICAL = 1e-4  # relative distance from the critical temperature that is none


def ising(case: Case, name: str) -> Known:
    """A mean of the Ising model in equilibrium, by the names of `theory.counted_spins`."""
    model = case.lattice.model
    if not isinstance(model, Ising) or model.kT <= 0:
        return UNKNOWN
    if sites_of(case) <= FEW:
        return _counted(case)[name], "all states counted"
    plain = model.field == 0 and not case.lattice.ends and model.coupling > 0
    if plain and case.lattice.kind == "chain" and name == "energy":
        return theory.chain_energy(model.coupling, model.kT, sites_of(case)), "a ring of spins"
    if plain and case.lattice.kind == "square":
        note = "an infinite lattice (Onsager 1944, Yang 1952)"
        if name == "energy":
            return theory.onsager_energy(model.coupling, model.kT), note
        ordered = theory.yang_magnetisation(model.coupling, model.kT)
        if name in ("size", "square") and ordered > 0:
            return (ordered if name == "size" else ordered**2), f"approximate: {note}"
    return UNKNOWN


def energy(case: Case) -> Known:
    """Mean energy of a site."""
    model = case.lattice.model
    if not isinstance(model, Potts):
        return ising(case, "energy")
    plain = not case.lattice.ends and model.coupling > 0 and model.kT > 0
    if not plain or case.lattice.kind != "square":
        return UNKNOWN
    critical, there = theory.potts_critical_energy(model.coupling, model.q)
    if model.q == 2:  # spins with half the coupling
        known = theory.onsager_energy(0.5 * model.coupling, model.kT) - model.coupling
        return known, "an infinite lattice (Onsager 1944)"
    if abs(model.kT / critical - 1) < CRITICAL:
        return there, "approximate: an infinite lattice at its critical temperature"
    return UNKNOWN


@functools.lru_cache(maxsize=8)
def _counted(case: Case) -> dict[str, float]:
    model, kind = case.lattice.model, case.lattice.lattice
    closed = tuple(axis in case.lattice.ends for axis in case.box.axes)
    grid = grid_of(kind, tuple(map(int, case.box.size)), closed)
    places = by_number(grid)
    number = {int(place): k for k, place in enumerate(places)}
    pairs = [
        (k, number[int(found)])
        for k, place in enumerate(places)
        for direction in range(kind.neighbours)
        if (found := neighbour(grid, int(place), direction)) >= 0
    ]
    bonds = np.array(sorted(pairs)).reshape(-1, 2)
    # each bond is there from both ends: half of them each
    return theory.counted_spins(bonds, len(places), 0.5 * model.coupling, model.field, model.kT)


def langmuir(case: Case) -> float:
    """Coverage of a lattice gas of one species that adsorbs, desorbs and hops, whatever is near:
    all states with as many particles are as likely (Langmuir 1918). nan of any other."""
    model = case.lattice.model
    if not isinstance(model, LatticeGas) or len(model.species) != 2 or case.lattice.ends:
        return math.nan
    adsorb = desorb = 0.0
    for one in model.processes():
        if one.counted:
            return math.nan
        rate = one.rate(()) if callable(one.rate) else one.rate
        if one.neighbour is None:
            adsorb += rate if one.site == (0, 1) else 0.0
            desorb += rate if one.site == (1, 0) else 0.0
        elif {one.site, (one.neighbour[0][0], one.neighbour[1])} != {(0, 1), (1, 0)}:
            return math.nan
    return adsorb / (adsorb + desorb) if adsorb + desorb > 0 else math.nan


def coverages(case: Case) -> dict[str, Known]:
    """Part of the sites in each state, by its name."""
    part = langmuir(case)
    if math.isnan(part):
        return {}
    empty, full = case.lattice.model.species
    return {empty: (1 - part, "Langmuir"), full: (part, "Langmuir")}


def event_rates(case: Case) -> dict[str, Known]:
    """Events of each process per site and unit of time, by its name."""
    model, part = case.lattice.model, langmuir(case)
    z = case.lattice.lattice.neighbours
    if not math.isnan(part):
        found = {}
        for one in model.processes():
            rate = one.rate(()) if callable(one.rate) else one.rate
            before = part if one.site[0] == 1 else 1 - part
            there = z * (1 - before) if one.neighbour is not None else 1.0
            found[one.name] = rate * before * there, "Langmuir"
        return found
    if not isinstance(model, Exclusion) or model.backward or not model.forward:
        return {}
    sites = sites_of(case)
    if case.lattice.ends and not (model.enter_last or model.leave_first):
        enter, leave = model.enter / model.forward, model.leave / model.forward
        if enter > 0 and leave > 0:
            current = model.forward * theory.open_current(sites, enter, leave)
            note = "Derrida et al. 1993"
            return {
                "enter": (current / sites, note),
                "leave": (current / sites, note),
                "forward": (current * (sites - 1) / sites, note),
            }
    return {}


def width(case: Case, time: NDArray, first: float) -> tuple[NDArray | None, str]:
    """Width of a surface at times, None without theory; `first` is its square at the first."""
    model = case.lattice.model
    if isinstance(model, RandomDeposition) and len(time):
        grown = model.flux * (time - time[0]) * (1 - 1 / sites_of(case))
        return np.sqrt(first + grown), "independent columns, exact"
    return None, ""


def growth_exponent(case: Case) -> Known:
    """Exponent of the width in time, while correlations are shorter than the lattice."""
    model, chain = case.lattice.model, case.lattice.kind == "chain"
    if isinstance(model, RandomDeposition):
        return 0.5, "independent columns"
    if isinstance(model, Family) and chain:
        return 0.25, "approximate: Edwards and Wilkinson, at late times"
    driven = isinstance(model, RestrictedSolidOnSolid | Ballistic) or (
        isinstance(model, SingleStep) and model.up != model.down
    )
    if driven and chain:
        return 1 / 3, "approximate: Kardar, Parisi and Zhang, at late times"
    return UNKNOWN
