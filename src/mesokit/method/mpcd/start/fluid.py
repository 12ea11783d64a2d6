"""How a fluid starts: the first positions and velocities of its particles, made piece by piece."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mesokit.geometry.solids.contact import MARGIN
from mesokit.method.mpcd.start.around_beads import out_of_beads
from mesokit.method.mpcd.start.conformation import connected, drawn
from mesokit.method.mpcd.start.draws import Draws
from mesokit.method.mpcd.start.of_first import OfFirst, rows_of
from mesokit.method.mpcd.start.room import periods, stays_out
from mesokit.method.mpcd.start.solutes import first_beads
from mesokit.scalar.fixed_point import added_halves, halves
from mesokit.scalar.random import INITIAL_POSITION, INITIAL_VELOCITY

if TYPE_CHECKING:
    from mesokit.method.mpcd.engine.cpu.numbers import Numbers

Floats = NDArray[np.float64]
Who = NDArray[np.int64]


def start(
    engine: Any,
    positions: Any = None,
    velocities: Any = None,
    beads: Any = None,
    bead_velocities: Any = None,
) -> None:
    """Give the particles their first positions and velocities.

    Parameters
    ----------
    engine : Engine
        A fluid in memory; its case says how to draw what is not given, its `parts` which particles
        are to be made here.
    positions, velocities : array (n, d) or rows of a file, optional
        In cells, and in cells per unit of time, by particle number, as `read_arrays` has checked
        them. Where rank 0 alone has some, it makes all particles, a piece at a time.
    beads, bead_velocities : array (n, d), optional
        The same of the beads of solutes.
    """
    numbers: Numbers = engine.numbers
    case, at_rest = numbers.case, velocities is None
    parts = engine.parts(any(isinstance(array, OfFirst) for array in (positions, velocities)))
    positions, velocities = rows_of(positions), rows_of(velocities)
    drifts: list[Floats] = []  # to take off, one after the other
    if at_rest:
        drifts.append(_drift(engine))
    if case.solutes is not None:
        given = beads, bead_velocities
        beads, bead_velocities, drift = first_beads(numbers, case.solutes, *given, at_rest)
        engine.solutes.begin(beads, bead_velocities)
        drifts.append(drift)

    def made(first: int, last: int) -> tuple[Who, Floats, Floats, NDArray[np.int32]]:
        who = np.arange(first, last)
        r = first_positions(numbers, who, positions, beads)
        if not at_rest:
            v = np.asarray(velocities[first:last], float)
        else:
            v = thermal_velocities(numbers, who)
            for drift in drifts:
                v -= drift
            if case.box.sheared:
                v[:, 0] += case.box.first_rate * (r[:, 1] - 0.5 * numbers.box[1])
        return who, r, v, np.zeros(r.shape, np.int32)

    engine.begin(made(*part) for part in parts)


def first_positions(numbers: Numbers, who: Who, given: Any, beads: Any = None) -> Floats:
    """Positions (n, d) of particles with these numbers, in a row and whole molecules: the given
    ones, or drawn where there is no solid, and where the beads that act on the fluid leave room."""
    case, molecule = numbers.case, numbers.case.fluid.molecule
    if given is not None:
        places = np.asarray(given[who[0] : who[-1] + 1], float)
        return places if molecule is None else connected(places, molecule, periods(numbers))
    if molecule is None:
        places = _uniform(numbers, Draws(case.run.seed, INITIAL_POSITION, who))
        return places if beads is None else out_of_beads(numbers, who, places, beads)
    random = Draws(case.run.seed, INITIAL_POSITION, who[:: molecule.length] // molecule.length)
    return drawn(molecule, case.fluid.kT, numbers.box, random, stays_out(numbers))


def thermal_velocities(numbers: Numbers, who: Who) -> Floats:
    """Maxwellian velocities (n, d) of particles with these numbers."""
    found = Draws(numbers.case.run.seed, INITIAL_VELOCITY, who).normals(numbers.dimension)
    return found * np.sqrt(numbers.case.fluid.kT / numbers.masses_of(who))[:, None]


def _drift(engine: Any) -> Floats:
    """The mean velocity (d,) of all particles, wherever they are made."""
    numbers: Numbers = engine.numbers
    scale = numbers.units["momentum"]
    sums = np.zeros((2, numbers.dimension), np.int64)
    for first, last in engine.parts():
        who = np.arange(first, last)
        terms = numbers.masses_of(who)[:, None] * thermal_velocities(numbers, who) * scale
        sums = added_halves(np.stack([sums, halves(np.rint(terms).astype(np.int64))]))
    momentum = engine.readings.joined(sums, scale)
    return np.asarray(momentum / max(numbers.total_mass, 1e-300))


def _uniform(numbers: Numbers, random: Draws) -> Floats:
    """Places (n, d) uniform in the fluid: those that lie in a solid are drawn again."""
    places = random.units(numbers.dimension) * numbers.box
    if numbers.solids is None or numbers.slit is not None:
        return places
    left = np.arange(len(places))
    while len(left):
        inside = numbers.solids.distance(places[left]) < MARGIN
        left, random = left[inside], random.of(inside)
        places[left] = random.units(numbers.dimension) * numbers.box
    return places
