"""How a fluid starts: the first positions and velocities of its particles."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mesokit.geometry.solids.contact import MARGIN
from mesokit.method.mpcd.start.around_beads import out_of_beads
from mesokit.method.mpcd.start.conformation import connected, drawn
from mesokit.method.mpcd.start.draws import Draws
from mesokit.method.mpcd.start.room import periods, stays_out
from mesokit.method.mpcd.start.solutes import first_beads
from mesokit.scalar.fixed_point import total
from mesokit.scalar.random import INITIAL_POSITION, INITIAL_VELOCITY

if TYPE_CHECKING:
    from mesokit.execute.cpu.numbers import Numbers

Floats = NDArray[np.float64]


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
        A fluid in memory; its case says how to draw what is not given.
    positions, velocities : array (n, d), optional
        In cells, and in cells per unit of time, by particle number, as `read_arrays` has checked
        them.
    beads, bead_velocities : array (n, d), optional
        The same of the beads of solutes.
    """
    numbers: Numbers = engine.numbers
    case, mass, at_rest = numbers.case, numbers.masses(), velocities is None
    drift = np.zeros(numbers.dimension)
    if case.solutes is not None:
        given = beads, bead_velocities
        beads, bead_velocities, drift = first_beads(numbers, case.solutes, *given, at_rest)
        engine.solutes.begin(beads, bead_velocities)
    positions = first_positions(numbers, positions, beads)
    if at_rest:
        velocities = thermal_velocities(numbers, mass)
        velocities = velocities - drift if case.solutes is not None else velocities
    if at_rest and case.box.sheared:
        velocities[:, 0] += case.box.first_rate * (positions[:, 1] - 0.5 * numbers.box[1])
    engine.begin(positions, velocities)


def first_positions(numbers: Numbers, given: Any, beads: Any = None) -> Floats:
    """Positions (n, d): the given ones, or drawn where there is no solid, and where the beads that
    act on the fluid leave room."""
    case, molecule = numbers.case, numbers.case.fluid.molecule
    if given is not None:
        return given if molecule is None else connected(given, molecule, periods(numbers))
    number = numbers.n if molecule is None else numbers.n // molecule.length
    random = Draws(case.run.seed, INITIAL_POSITION, np.arange(number))
    if molecule is None:
        places = _uniform(numbers, random)
        return places if beads is None else out_of_beads(numbers, places, beads)
    return drawn(molecule, case.fluid.kT, numbers.box, random, stays_out(numbers))


def thermal_velocities(numbers: Numbers, mass: Floats) -> Floats:
    """Maxwellian velocities (n, d) without momentum."""
    case, who = numbers.case, np.arange(numbers.n)
    found = Draws(case.run.seed, INITIAL_VELOCITY, who).normals(numbers.dimension)
    found *= np.sqrt(case.fluid.kT / mass)[:, None]
    scale = numbers.units["momentum"]
    for k in range(numbers.dimension):
        momentum = total(np.rint(mass * found[:, k] * scale).astype(np.int64), scale)
        found[:, k] -= momentum / max(mass.sum(), 1e-300)
    return found


def _uniform(numbers: Numbers, random: Draws) -> Floats:
    """Places (n, d) uniform in the fluid: those that lie in a solid are drawn again."""
    places = random.units(numbers.dimension) * numbers.box
    if numbers.solids is None or numbers.slit is not None:
        return places
    left = np.arange(numbers.n)
    while len(left := left[numbers.solids.distance(places[left]) < MARGIN]):
        random = random.of(np.searchsorted(random.who, left))
        places[left] = random.units(numbers.dimension) * numbers.box
    return places
