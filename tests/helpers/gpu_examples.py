"""What is compiled for a GPU: parameters of all that is registered, and what it is asked about."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from mesokit import (
    SRD,
    MaxwellBoltzmann,
    NoForce,
    OscillatingShear,
    Plates,
    Sinusoidal,
    SteadyShear,
    StepStrain,
    Uniform,
)
from mesokit.case import box as boxes
from mesokit.case.box import Box
from mesokit.case.shear import protocol as histories
from mesokit.devices import records
from mesokit.devices.records import AtOnce, WordByWord
from mesokit.geometry import protocol
from mesokit.geometry import protocol as solids
from mesokit.geometry.protocol import Nothing
from mesokit.geometry.solids import contact  # noqa: F401  registers the forms of solids in tables
from mesokit.geometry.solids.bodies import Bodies
from mesokit.geometry.solids.cut_cube import share_and_depth, share_beyond
from mesokit.loops.neighbours import nearest_image
from mesokit.method.flock.engine.move import flown
from mesokit.method.flock.noise import RULES as NOISES
from mesokit.method.flock.noise import protocol as birds
from mesokit.method.kinetic_monte_carlo.lattice.grid import Sites, grid_of, length_of
from mesokit.method.kinetic_monte_carlo.lattice.kinds import KINDS
from mesokit.method.kinetic_monte_carlo.model import protocol as lattices
from mesokit.method.kinetic_monte_carlo.model.ising import Ising
from mesokit.method.kinetic_monte_carlo.model.solid_on_solid import SolidOnSolid
from mesokit.method.mpcd import collision, thermostat
from mesokit.method.mpcd.collision import protocol as rules
from mesokit.method.mpcd.engine.beads import interactions
from mesokit.method.mpcd.engine.cpu.bounce import bounce
from mesokit.method.mpcd.engine.cpu.grid import Grid, cell_index, in_cell
from mesokit.method.mpcd.engine.cpu.physics import Physics
from mesokit.method.mpcd.engine.cpu.strips import cell_energy
from mesokit.method.mpcd.engine.cpu.strips.terms import read_sums, terms_of
from mesokit.method.mpcd.field import protocol as fields
from mesokit.method.mpcd.field import varying
from mesokit.method.mpcd.field.oscillating import Cosine
from mesokit.method.mpcd.field.sampled import Nodes
from mesokit.method.mpcd.field.scheduled import Points
from mesokit.method.mpcd.streaming import fall, halfway, vector
from mesokit.method.mpcd.thermostat import protocol as thermostats
from mesokit.method.spheres.common.contacts import geometry as distances
from mesokit.method.spheres.common.contacts import groups as touching
from mesokit.method.spheres.common.contacts import listed, lists
from mesokit.method.spheres.hard.collision import RULES
from mesokit.method.spheres.hard.collision import protocol as spheres
from mesokit.method.spheres.rigid.engine import sliding
from mesokit.method.spheres.soft.pair import protocol as contacts
from mesokit.method.spheres.soft.pair.hertz import Hertz as HertzContact
from mesokit.method.spheres.soft.pair.spring_dashpot import Linear
from mesokit.potential import ANGLES, BONDS, PAIRS
from mesokit.potential import protocol as potentials
from mesokit.potential.angle import bend
from mesokit.potential.bending import Bending
from mesokit.potential.harmonic import Harmonic, Spring
from mesokit.potential.table import Table
from mesokit.potential.wca import WCA
from mesokit.scalar import elementary, gamma, poisson, random
from mesokit.scalar.jit import scalar

Calls = list[tuple[Callable, tuple[Any, ...]]]
DIMENSIONS = (2, 3)
WHOLE, WORD = np.int64(1), np.uint64(1)
COUNTER = random.Counter(WORD, WORD)
HIT = solids.Chance(WORD, WORD, WHOLE, WHOLE, 1.0)
MOST_SUMS, MOST_COEFFICIENTS = 18, 12
ENERGIES = (cell_energy.NotNeeded(), cell_energy.Column(), cell_energy.WithCount(1.0))


TABLE = tempfile.NamedTemporaryFile("w", suffix=".txt")  # noqa: SIM115  as long as the tests
TABLE.write("1 9\n2 4\n3 1\n4 0\n")
TABLE.flush()
NEEDED = {
    Harmonic: {"K": 1.0},
    Spring: {"k": 1.0},
    Bending: {"kappa": 1.0},
    Table: {"file": TABLE.name},
}


def vec(d: int) -> tuple[float, ...]:
    return (1.0,) * d


def hit(solid: Any) -> Any:
    """What is hit, of that kind of solid."""
    return (WHOLE, WHOLE) if isinstance(solid, Bodies) else WHOLE


def bodies(d: int) -> Bodies:
    return Bodies(vec(d), vec(d), 1, 1.0, vec(d), vec(d), 1, 1, 1, 1.0, 1.0, vec(d), vec(d))


CELLS = listed.Grid((WHOLE,) * 3, vec(3), (WHOLE,) * 3, 1.0)
SLIDING = sliding.Sliding(SteadyShear(0.1).kernel(1.0))
SPRING, STIFF, REPELS = Harmonic(K=1.0).kernel(), Bending(1.0).kernel(), WCA().kernel()


def slit(d: int) -> Any:
    return Plates("x").kernel((8,) * d)


def total(asked: Any, d: int) -> tuple[float, ...]:
    """What a traversal adds up."""
    return {interactions.BeadForce: vec(d), interactions.Energy: (0.0,)}.get(type(asked), ())


LATTICES = {2: KINDS["square"], 3: KINDS["cubic"]}


def sites(d: int) -> Sites:
    """A small lattice."""
    grid = grid_of(LATTICES[d], (4,) * d, (False,) * d)
    return Sites(
        grid, np.zeros(length_of(grid), np.uint8), np.zeros(length_of(grid), np.uint16), ()
    )


# Of each generic function: the arguments after the first, which is p, in d dimensions.
ASKED: dict[Callable, Callable[[Any, int], tuple[Any, ...]]] = {
    histories.speed: lambda p, d: (1.0,),
    histories.slid: lambda p, d: (1.0,),
    boxes.at_time: lambda p, d: (1.0,),
    boxes.fold: lambda p, d: (vec(d), vec(d), vec(d)),
    boxes.unfold: lambda p, d: (vec(d), vec(d), vec(d)),
    boxes.slide: lambda p, d: (vec(d), vec(d), vec(d)),
    boxes.peculiar: lambda p, d: (vec(d), vec(d)),
    records.add_record: lambda p, d: (WHOLE, WHOLE, (WHOLE,) * 4),
    cell_energy.energy_term: lambda p, d: (1.0, vec(d)),
    cell_energy.tally: lambda p, d: (1.0, vec(d)),
    cell_energy.untangled: lambda p, d: (WHOLE,),
    cell_energy.needs_energy: lambda p, d: (),
    cell_energy.many_energy_term: lambda p, d: (1.0,),
    cell_energy.many_tally: lambda p, d: (WHOLE, 1.0),
    rules.contribute: lambda p, d: (COUNTER, (WHOLE, WHOLE), 1.0, vec(d), vec(d)),
    rules.freedom: lambda p, d: (1.0,),
    rules.coefficients: lambda p, d: (
        MaxwellBoltzmann().kernel(1.0, 0.0),
        1.0,
        (WORD, WORD),
        rules.Cell(1.0, 1.0, vec(d), 1.0, vec(MOST_SUMS)),
    ),
    rules.collide: lambda p, d: (vec(MOST_COEFFICIENTS), vec(d), vec(d)),
    thermostats.guess: lambda p, d: ((WORD, WORD), 1.0),
    thermostats.draw: lambda p, d: (COUNTER, WHOLE, 1.0, WHOLE),
    thermostats.target: lambda p, d: (1.0, 1.0, 1.0),
    thermostats.stretch: lambda p, d: (1.0, 1.0, 1.0),
    fields.acceleration: lambda p, d: (vec(d),),
    fields.field_at: lambda p, d: (1.0,),
    varying.factor: lambda p, d: (1.0,),
    potentials.central: lambda p, d: (1.0,),
    potentials.breaks: lambda p, d: (1.0,),
    potentials.angular: lambda p, d: (1.0,),
    solids.exposed: lambda p, d: (),
    solids.touches: lambda p, d: ((), vec(d), vec(d), vec(d), 1.0),
    solids.leaps: lambda p, d: (vec(d),),
    solids.free: lambda p, d: (vec(d), vec(d), vec(d), 1.0),
    solids.homed: lambda p, d: (vec(d),),
    solids.unmet: lambda p, d: (),
    solids.first_hit: lambda p, d: (vec(d), vec(d), vec(d), 1.0, hit(p)),
    solids.happens: lambda p, d: (hit(p),),
    solids.surface_of: lambda p, d: (hit(p),),
    solids.lever: lambda p, d: (hit(p), vec(d)),
    solids.rebound: lambda p, d: (hit(p), vec(d), vec(d), HIT),
    solids.settled: lambda p, d: (vec(d),),
    solids.facing: lambda p, d: (1.0, vec(d)),
    protocol.nearest_surface: lambda p, d: (vec(d),),
    protocol.surface_flow: lambda p, d: (WHOLE, vec(d)),
    protocol.distance_above: lambda p, d: (WHOLE, vec(d)),
    protocol.is_clear_cell: lambda p, d: (vec(d),),
    protocol.unit_cell: lambda p, d: (vec(d),),
    protocol.surface_and_lever: lambda p, d: (WHOLE, vec(d)),
    contacts.normal_force: lambda p, d: (1.0, contacts.Closing(1.0, 1.0, 0.1), 1.0, 1.0),
    contacts.normal_energy: lambda p, d: (1.0, 1.0),
    birds.counted: lambda p, d: (),
    birds.turned: lambda p, d: (COUNTER, WHOLE, vec(d), vec(d), WHOLE),
    lattices.number_alone: lambda p, d: (WHOLE,),
    lattices.weight: lambda p, d: (WHOLE, WHOLE, WHOLE),
    lattices.change_of_weight: lambda p, d: (WHOLE, WHOLE, WHOLE, WHOLE),
    lattices.change_of_any: lambda p, d: (WHOLE, WHOLE),
    lattices.change_of_own: lambda p, d: (WHOLE, WHOLE),
    lattices.process_of: lambda p, d: (sites(d), WHOLE, 0.5),
    flown: lambda p, d: (vec(d), vec(d), vec(d)),
    distances.shortest: lambda p, d: (vec(3),),
    lists.seen_from: lambda p, d: (CELLS, 1.0, WHOLE, WHOLE),
    sliding.box_in_step: lambda p, d: (touching.Box(vec(3), vec(3)), 1.0, 1.0),
    sliding.slip: lambda p, d: (SLIDING, 1.0, 0.0),
    sliding.image_speed: lambda p, d: (vec(3),),
    sliding.across: lambda p, d: (1.0, 1.0),
    spheres.restitution: lambda p, d: (1.0,),
    spheres.next_contact: lambda p, d: (vec(d), vec(d), 1.0, 0.0),
    spheres.step_of_energy: lambda p, d: (1.0, 1.0),
    interactions.of_two: lambda p, d: (total(p, d), SPRING, vec(d), WHOLE, WHOLE),
    interactions.of_three: lambda p, d: (total(p, d), STIFF, vec(d), vec(d), WHOLE),
    interactions.of_wall: lambda p, d: (total(p, d), REPELS, (slit(d), 1.0), vec(d)),
}


def parts(d: int) -> Iterator[Any]:
    """Parameters of all that is registered, as a case of that dimension has them."""
    size, shut = (8,) * d, (False,) * d
    yield from (rule().kernel(d, 1.0) for rule in collision.RULES)
    yield SRD(angle_distribution="uniform").kernel(d, 1.0)
    yield from (rule().kernel(1.0, 0.0) for rule in thermostat.RULES)
    yield NoForce().kernel(size)
    yield Uniform(vec(d)).kernel(size)
    yield Sinusoidal(amplitude=1.0).kernel(size)
    yield varying.Scaled(Uniform(vec(d)).kernel(size), Cosine(1.0, 0.0), 1.0)
    yield from (Cosine(1.0, 0.0), Points(1, 1))
    yield Nodes(1, vec(d), vec(d), vec(d), (1,) * d)
    yield from (kind(**NEEDED.get(kind, {})).kernel() for kind in (*BONDS, *PAIRS, *ANGLES))
    yield Box(size).kernel(shut)
    for history in (SteadyShear(0.1), OscillatingShear(0.1, 0.1), StepStrain(0.1, 1.0, period=9.0)):
        yield history.kernel(1.0)
        yield Box(size, shear=history).kernel(shut)
    yield from (Plates(axis).kernel(size) for axis in Box(size).axes)
    yield Nothing()
    yield from (WordByWord(), AtOnce())
    yield bodies(d)
    yield from ENERGIES
    faults, tensor = np.zeros(8, np.int64), np.zeros(d * d, np.int64)
    yield interactions.BeadForce(1.0, np.zeros(8, np.int64), 1.0, 1, faults)
    yield interactions.Energy()
    yield from (rule().kernel() for rule in (*RULES, *NOISES))
    yield from (Linear(1.0, 0.0, 1.0, 0.0, 1.0), HertzContact(1.0, 1.0, 1.0))
    yield touching.Box(vec(3), vec(3))
    yield touching.SlidBox(vec(3), vec(3), 1.0, 1.0)
    yield from (sliding.AtRest(), SLIDING)
    yield interactions.Virial(1.0, tensor, 1.0)
    yield Ising().kernel(LATTICES[d], False)
    yield Ising(moves="exchange").kernel(LATTICES[d], False)
    yield SolidOnSolid().kernel(LATTICES[d], False)


def physics(d: int, **parts: Any) -> Physics:
    """What the particles obey, plain SRD unless said."""
    plain = {
        "rule": SRD().kernel(d, 1.0),
        "thermostat": MaxwellBoltzmann().kernel(1.0, 0.0),
        "field": NoForce().kernel((8,) * d),
        "solid": Nothing(),
        "masses": (1.0,),
        "energy": cell_energy.NotNeeded(),
        "timestep": 0.1,
        "kT": 1.0,
        "molecule": (),
        "zero": vec(d),
        "coefficients": (),
        "terms": (),
        "scales": vec(d),
        "momentum_scale": 1.0,
        "stress_scale": 1.0,
    }
    return Physics(**(plain | parts))


def registered(d: int) -> dict[str, Calls]:
    """Every implementation of every generic function, asked about what is registered."""
    return {
        f"{name} in {d}D": [
            (function, (part, *arguments(part, d)))
            for function, arguments in ASKED.items()
            if serves(function, type(part))
        ]
        for name, part in {named(part): part for part in parts(d)}.items()
    }


def named(part: Any) -> str:
    """Its kind, of a sheared box with that of its history."""
    kinds = [type(part), *([type(part.history)] if isinstance(part, boxes.Sheared) else [])]
    return " of ".join(kind.__name__ for kind in kinds)


def serves(function: Callable, kind: type) -> bool:
    """Whether it has code for these parameters: registered, or what it does otherwise."""
    family = [function]
    if function.others:  # type: ignore[attr-defined]
        family = [member for member in ASKED if member.__module__ == function.__module__]
    return any(kind in member.implementations for member in family)  # type: ignore[attr-defined]


@scalar
def flight(physics, r, v):  # type: ignore[no-untyped-def]
    """A timestep's flight, and what is asked to see whether it touches a solid."""
    a = halfway(physics.field, r, v, physics.timestep)
    return fall(r, v, a, physics.timestep), vector(a, r)


def others(d: int) -> dict[str, Calls]:
    """What a step does besides, with such parts and others."""
    r, grid, force = vec(d), Grid(vec(d), vec(d), vec(d), vec(d)), Uniform(vec(d))
    found = {
        "cells": [(in_cell, (r, grid)), (cell_index, (r, grid))],
        "flight": [
            (flight, (physics(d, field=some.kernel((8,) * d)), r, r)) for some in (force, NoForce())
        ],
        "angle": [(bend, (Bending(1.0).kernel(), r, r))],
        "random numbers": [
            (random.grid_shift, (COUNTER, r, 1.0)),
            (random.normals, (r, WORD, WORD, WORD, WORD)),
            (gamma.gamma_number, (1.0, COUNTER, WORD, WHOLE)),
            (poisson.poisson_number, (1.0, COUNTER, WORD, WHOLE)),
        ],
        "elementary functions": [(elementary.sincos_turn, (1.0,)), (elementary.rint, (1.0,))],
        "nearest image": [(nearest_image, (Box((8,) * d).kernel((False,) * d), r))],
        "cut cubes": [(share_beyond, (1.0, r)), (share_and_depth, (1.0, r))],
    }
    for energy in ENERGIES:
        found[f"sums, {type(energy).__name__}"] = calls = []
        for masses in ((1.0,), ()):
            terms = d + (masses == ()) + isinstance(energy, cell_energy.Column)
            p = physics(d, energy=energy, masses=masses, scales=vec(terms))
            calls.append((terms_of, (p, 1.0, r, ())))
            calls.append((read_sums, (p, (WHOLE,) * (1 + terms))))
    impulse = np.zeros(1, np.int64)
    for solid in (Plates("x").kernel((8,) * d), bodies(d)):
        given = (physics(d, solid=solid), 0.1, COUNTER, (WHOLE, 1.0), r, r, r, impulse)
        found[f"bounce at {type(solid).__name__}"] = [(bounce, given)]
    return {f"{name} in {d}D": calls for name, calls in found.items()}


CALLS = {
    name: calls for d in DIMENSIONS for name, calls in (registered(d) | others(d)).items() if calls
}
