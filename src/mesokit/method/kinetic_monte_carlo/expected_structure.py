"""Which theory of correlations, islands, surfaces and currents belongs to a case on a lattice."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.case import Case
from mesokit.method.kinetic_monte_carlo.expected import Known, coverages
from mesokit.method.kinetic_monte_carlo.model.ballistic import Ballistic
from mesokit.method.kinetic_monte_carlo.model.exclusion import Exclusion
from mesokit.method.kinetic_monte_carlo.model.family import Family
from mesokit.method.kinetic_monte_carlo.model.ising import Ising
from mesokit.method.kinetic_monte_carlo.model.lattice_gas import LatticeGas
from mesokit.method.kinetic_monte_carlo.model.potts import Potts
from mesokit.method.kinetic_monte_carlo.model.rsos import RestrictedSolidOnSolid
from mesokit.method.kinetic_monte_carlo.model.single_step import SingleStep
from mesokit.method.kinetic_monte_carlo.model.solid_on_solid import SolidOnSolid
from mesokit.method.kinetic_monte_carlo.model.table import TableModel
from mesokit.method.kinetic_monte_carlo.start import RandomStart, SlabStart, UniformStart, sites_of

Array = NDArray[np.floating[Any]]
Curve = tuple[Array | None, str]  # values where theory is known, and a note on it
UNKNOWN: Curve = (None, "")
LONG = 10  # correlation lengths in a lattice whose correlations are as in an infinite one
HIGHEST = 400  # atoms of a step whose probability counts
REACH = 0.9  # of the room on both sides of a step, which news of it crosses at the speed 1
MOST_ROWS = 64  # of determinants, the time of which grows as the fourth power


def langmuir(case: Case) -> float:
    """Part of the sites that have a particle where sites are independent, nan where not."""
    model = case.lattice.model
    if not isinstance(model, LatticeGas):
        return math.nan
    return coverages(case).get(model.species[-1], (math.nan, ""))[0]


def plain_spins(case: Case, kind: str) -> bool:
    """Whether spins that flip in no field are on a periodic lattice of a kind, in equilibrium."""
    return in_no_field(case, kind) and not keeps_states(case.lattice.model)


def in_no_field(case: Case, kind: str) -> bool:
    """The same of spins that flip or exchange."""
    model = case.lattice.model
    return (
        type(model) is Ising
        and case.lattice.kind == kind
        and not case.lattice.ends
        and model.field == 0
        and model.kT > 0
    )


def ring_of_particles(case: Case) -> bool:
    """Whether particles hop on a ring: all states with as many particles are as likely."""
    return isinstance(case.lattice.model, Exclusion) and not case.lattice.ends


def correlation(case: Case, observable: Any, distance: Array) -> Curve:
    """Correlation of two sites at a distance."""
    model, n = case.lattice.model, sites_of(case)
    if plain_spins(case, "chain"):
        return theory.chain_correlation(distance, model.coupling, model.kT, n), "a ring of spins"
    alike = np.where(distance < 0.5, 1.0, 0.0)
    if not math.isnan(langmuir(case)):
        return alike, "independent sites"
    if ring_of_particles(case):
        return np.where(alike > 0, alike, -1 / (n - 1)), "all states alike"
    if plain_spins(case, "square") and observable.direction != "radius" and model.coupling > 0:
        length = theory.spin_correlation_length(model.coupling, model.kT, 2)
        if min(case.box.size) < LONG * length:
            return UNKNOWN
        known = np.full(len(distance), np.nan)
        square = theory.yang_magnetisation(model.coupling, model.kT) ** 2
        for k, r in enumerate(distance[:MOST_ROWS]):
            together = theory.row_correlation(int(r), model.coupling, model.kT)
            known[k] = (together - square) / (1 - square)
        return known, "approximate: " * (square > 0) + "an infinite lattice (Montroll et al. 1963)"
    return UNKNOWN


def structure_factor(case: Case, observable: Any, k: Array) -> Curve:
    """Structure factor at wave numbers that fit into the lattice."""
    n = sites_of(case)
    if not math.isnan(langmuir(case)):
        return np.ones(len(k)), "independent sites"
    if case.lattice.kind == "chain" and (plain_spins(case, "chain") or ring_of_particles(case)):
        known, note = correlation(case, observable, np.minimum(np.arange(n), n - np.arange(n)))
        waves = np.rint(k * n / (2 * math.pi)).astype(int)
        return np.fft.fft(np.asarray(known)).real[waves], note
    return UNKNOWN


def walls_in_equilibrium(case: Case) -> float:
    """Unlike pairs of neighbours per site in equilibrium: 0 where they are not known."""
    model = case.lattice.model
    if not in_no_field(case, "square") or model.coupling <= 0:
        return 0.0
    if not orders(case):
        return 0.0
    return 1 + 0.5 * theory.onsager_energy(model.coupling, model.kT) / model.coupling


def orders(case: Case) -> bool:
    """Whether the spins of a square lattice are below their critical temperature."""
    model = case.lattice.model
    states, alike = (2, 2.0) if isinstance(model, Ising) else (model.q, 1.0)
    critical, _ = theory.potts_critical_energy(alike * model.coupling, states)
    return bool(case.lattice.kind == "square" and model.kT < critical)


def domain_length(case: Case, time: Array) -> Curve:
    """Sites over walls of a chain that is quenched to temperature 0."""
    model, start = case.lattice.model, case.lattice.first()
    quenched = (
        type(model) is Ising
        and case.lattice.kind == "chain"
        and not case.lattice.ends
        and model.kT == model.field == 0
        and not keeps_states(model)
        and model.coupling > 0
        and model.dynamics == "glauber"
    )
    if not quenched or not isinstance(start, RandomStart) or set(start.fractions) - {0.5}:
        return UNKNOWN
    return 1 / theory.glauber_walls(model.attempt_rate * time), "Glauber 1963"


def domain_exponent(case: Case) -> Known:
    """Exponent of the length of domains in time, while that is shorter than the lattice."""
    model = case.lattice.model
    if not isinstance(model, Ising | Potts) or not model.coupling > 0:
        return math.nan, ""
    if getattr(model, "field", 0.0) or (model.kT > 0 and not orders(case)):
        return math.nan, ""
    if keeps_states(model):
        return 1 / 3, "approximate: approaches 1/3 (Lifshitz and Slyozov 1961)"
    return 0.5, "approximate: driven by curvature (Allen and Cahn 1979), at late times"


def keeps_states(model: Any) -> bool:
    """Whether no event changes how many sites are in each state."""
    if getattr(model, "moves", "") == "exchange":
        return True
    return isinstance(model, TableModel) and all(
        one.neighbour is not None
        and all(
            sorted((one.site[0], there)) == sorted((one.site[1], one.neighbour[1]))
            for there in one.neighbour[0]
        )
        for one in model.processes()
    )


def island_density(case: Case, observable: Any, coverage: Array) -> Curve:
    """Islands per site, by the share p of the sites covered: of a chain of independent sites those
    of m sites and more are (1 - p) p^m, whatever p is."""
    alone = isinstance(case.lattice.first(), UniformStart | RandomStart)
    if not alone or case.lattice.kind != "chain" or math.isnan(langmuir(case)):
        return UNKNOWN
    return (1 - coverage) * coverage**observable.smallest, "independent sites, a long chain"


def island_sizes(case: Case, observable: Any, edges: Array) -> Curve:
    """Islands of each size per site, a mean over each bin of sizes, on a chain in equilibrium."""
    n, one = sites_of(case), np.arange(1, int(edges[-1]))
    if case.lattice.kind != "chain" or case.lattice.ends:
        return UNKNOWN
    p = langmuir(case)
    if not math.isnan(p):
        full = p if observable.state in (None, case.lattice.model.states()[1]) else 1 - p
        known, note = (1 - full) ** 2 * full**one, "independent sites, a long chain"
    elif plain_spins(case, "chain"):
        wall = 0.5 * (1 - math.tanh(case.lattice.model.coupling / case.lattice.model.kT))
        known, note = 0.5 * wall**2 * (1 - wall) ** (one - 1), "a long chain of spins"
    else:
        return UNKNOWN
    if known[n // 2 :].sum() > 1e-9:  # islands as long as the ring
        return UNKNOWN
    return np.add.reduceat(known, edges[:-1].astype(int) - 1) / np.diff(edges), note


def square_step(case: Case) -> Known:
    """Mean square step between columns of a ring in its steady state."""
    model, n = case.lattice.model, sites_of(case)
    if case.lattice.kind != "chain" or case.lattice.ends or case.run.warmup == 0:
        return math.nan, ""
    if isinstance(model, SingleStep) and settled(case):
        return 1.0, "all orders of the steps alike"
    if isinstance(model, SolidOnSolid) and not (
        model.flux or model.step_barrier or model.evaporate
    ):
        step = np.arange(-HIGHEST, HIGHEST + 1.0)
        ratio = math.exp(-0.5 * model.bond_energy / model.kT)
        return float(step**2 @ theory.solid_on_solid_steps(step, ratio, n)), "equilibrium of a ring"
    return math.nan, ""


def settled(case: Case) -> bool:
    """Whether the warm-up of a single-step surface is as long as its correlations need to grow."""
    model, warmup = case.lattice.model, case.run.warmup * case.lattice.timestep
    power = 2.0 if model.up == model.down else 1.5
    return bool(warmup * (model.up + model.down) >= sites_of(case) ** power)


def height_differences(case: Case, distance: Array) -> Curve:
    """Mean square difference of heights at distances."""
    square, note = square_step(case)
    if math.isnan(square):
        return UNKNOWN
    return theory.ring_differences(distance, sites_of(case), square), note


def height_steps(case: Case, step: Array) -> tuple[Array | None, float, str]:
    """Probabilities of steps, and their mean square."""
    square, note = square_step(case)
    model = case.lattice.model
    if isinstance(model, SingleStep):
        return np.where(abs(step) == 1, 0.5, 0.0), 1.0, "steps of one atom"
    if math.isnan(square):
        return None, square, note
    ratio = math.exp(-0.5 * model.bond_energy / model.kT)
    return theory.solid_on_solid_steps(step, ratio, sites_of(case)), square, note


def roughness_exponent(case: Case) -> Known:
    """Exponent of the width of a surface in the distance, in its steady state."""
    grows = isinstance(case.lattice.model, Family | RestrictedSolidOnSolid | Ballistic | SingleStep)
    if grows and case.lattice.kind == "chain":
        return 0.5, "approximate: Edwards and Wilkinson, Kardar, Parisi and Zhang"
    return math.nan, ""


def saturated_width(case: Case) -> Known:
    """Mean square width of a ring in its steady state."""
    square, note = square_step(case)
    return theory.ring_width(sites_of(case), square), note


def current(case: Case, particles: int) -> tuple[float, float, str]:
    """Mean current of particles on a chain, the variance of crossings per time, and a note; of a
    ring with so many particles."""
    model, n = case.lattice.model, sites_of(case)
    if not math.isnan(langmuir(case)):
        return 0.0, math.nan, "no direction is preferred"
    if not isinstance(model, Exclusion):
        return math.nan, math.nan, ""
    if ring_of_particles(case):
        mean = (model.forward - model.backward) * theory.ring_current(particles, n)
        if model.backward or not 0 < particles < n:
            return mean, math.nan, "all states alike"
        scatter = model.forward * theory.ring_diffusion(particles, n) * (particles / n) ** 2
        return mean, scatter, "all states alike; Derrida, Evans and Mukamel 1993"
    if model.backward or model.enter_last or model.leave_first:
        return math.nan, math.nan, ""
    if not min(model.forward, model.enter, model.leave) > 0:
        return math.nan, math.nan, ""
    enter, leave = model.enter / model.forward, model.leave / model.forward
    return model.forward * theory.open_current(n, enter, leave), math.nan, "Derrida et al. 1993"


def crossings(case: Case, observable: Any, time: Array) -> tuple[Array | None, float, str]:
    """Particles that crossed the plane at which a full half begins to empty, and the variance at
    the last time, in an infinite chain that hops one way."""
    model, start = case.lattice.model, case.lattice.first()
    if not isinstance(model, Exclusion) or not isinstance(start, SlabStart) or not len(time):
        return None, math.nan, ""
    plain = (
        not (model.backward or model.enter or model.leave or model.enter_last or model.leave_first)
        and model.forward > 0
        and start.state in (None, "particle")
        and start.beyond in (None, "empty")
        and start.part == observable.part
        and observable.state in (None, "particle")
        and case.run.warmup == 0
    )
    room = sites_of(case) * min(start.part, 1 - start.part)
    if not plain or model.forward * time[-1] > REACH * room:
        return None, math.nan, ""
    mean, variance = theory.step_crossings(model.forward * time)
    return mean, float(variance[-1]), "approximate: an infinite chain (Johansson 2000), late times"
