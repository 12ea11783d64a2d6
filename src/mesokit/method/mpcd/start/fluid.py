"""How a fluid starts: the first positions and velocities of its particles, made piece by piece.

Solutes that act on the fluid by a potential have it about them as in equilibrium. An ideal gas has
the density exp(-U/kT) about beads at rest: so a particle that was put near a bead stays with that
chance, and is put elsewhere otherwise. The attraction of a well is left out: there the fluid starts
as dense as far away.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.box import AXES
from mesokit.errors import RunError
from mesokit.geometry.solids.contact import MARGIN
from mesokit.method.mpcd.engine.cpu.numbers import Numbers
from mesokit.method.mpcd.solutes import Solutes
from mesokit.method.mpcd.start.arrays import OfFirst, rows_of
from mesokit.method.mpcd.start.bodies import GAP, first_bodies
from mesokit.method.mpcd.start.conformation import connected, drawn, nearest_of
from mesokit.method.mpcd.start.draws import Draws
from mesokit.method.mpcd.start.growth import InFluid, grown
from mesokit.potential.thermal import energies
from mesokit.scalar.fixed_point import added_halves, halves
from mesokit.scalar.random import FIRST_BEAD, INITIAL_POSITION, INITIAL_VELOCITY

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]
FIRST_AGAIN = 2**20  # draws of this number and on are of those that were put elsewhere
TRIES = 1000
LEAST_GAP = 0.6  # of the range of the potential of gaps, where that is some 400 times its depth


def stays_out(numbers: Numbers, clear: float = 0.0) -> Callable[[Floats], NDArray[np.bool_]]:
    """Which of places (..., d) are in the fluid, so far from its surfaces."""
    if numbers.solids is None:
        return lambda places: np.ones(places.shape[:-1], bool)
    if numbers.slit is not None:
        axis, length = AXES.index(numbers.slit.axis), numbers.box[AXES.index(numbers.slit.axis)]
        return lambda places: (places[..., axis] > clear) & (places[..., axis] < length - clear)
    solids, d = numbers.solids, numbers.dimension

    def outside(places: Floats) -> NDArray[np.bool_]:
        inside_box = places.reshape(-1, d).copy()
        good = np.ones(len(inside_box), bool)
        for k, shut in enumerate(numbers.closed):
            x = inside_box[:, k]
            if shut:
                good &= (x > clear) & (x < numbers.box[k] - clear)
            else:
                x -= np.floor(x / numbers.box[k]) * numbers.box[k]
        good[good] = solids.distance(inside_box[good]) >= max(clear, MARGIN)
        return good.reshape(places.shape[:-1])

    return outside


def out_of_bodies(bodies: Any, in_fluid: InFluid) -> InFluid:
    """Which of places (n, d) are in the fluid, and so far from bodies as these start apart."""
    if bodies is None:
        return in_fluid
    return lambda places: in_fluid(places) & ~bodies.inside(places, GAP)


def _require_outside(bodies: Any, places: Floats) -> None:
    """Raise RunError for beads that start in a body, or where it repels too strongly."""
    inside = bodies.inside(places, LEAST_GAP)
    if inside.any():
        raise RunError(
            f"solutes.start.positions: bead {int(np.argmax(inside)) + 1} lies in a body, or nearer "
            f"to it than {LEAST_GAP:g} of its interaction.range"
        )


def periods(numbers: Numbers) -> Floats:
    """Lengths of the box, infinite where walls close it."""
    return np.where(numbers.closed, np.inf, numbers.box)


def out_of_beads(numbers: Numbers, ids: Ids, places: Floats, beads: Floats) -> Floats:
    """Places (n, d) of particles with these numbers, those that beads push away drawn again.

    Raises RunError where beads leave no room.
    """
    solutes = numbers.case.solutes
    if solutes is None or solutes.solvent_pair is None or not len(places):
        return places
    from scipy.spatial import cKDTree

    pair, period = solutes.solvent_pair, periods(numbers)
    boxes = np.where(np.isfinite(period), period, 0.0)

    def tree(x: Floats) -> cKDTree:
        inside = np.where(boxes > 0.0, x % np.where(boxes > 0.0, boxes, 1.0), x)
        return cKDTree(inside, boxsize=boxes)

    random, around = Draws(numbers.case.run.seed, INITIAL_POSITION, ids, FIRST_AGAIN), tree(beads)
    left, kT = np.arange(len(places)), numbers.case.fluid.kT
    for _ in range(TRIES):
        # the energy of each place, by all beads near it, in the same order among any others
        near = around.sparse_distance_matrix(tree(places[left]), pair.reach, output_type="ndarray")
        near = near[np.lexsort((near["i"], near["j"]))]
        energy = np.zeros(len(left))
        np.add.at(energy, near["j"], energies((pair.kernel(),), near["v"]))
        repelled = random.units(1)[:, 0] >= np.exp(-np.clip(energy / kT, 0.0, None))
        if numbers.solids is not None and numbers.slit is None:
            repelled |= numbers.solids.distance(places[left]) < MARGIN
        if not repelled.any():
            return places
        left, random = left[repelled], random.of(repelled)
        places[left] = random.units(numbers.dimension) * numbers.box
    raise RunError("solutes.solvent_pair: the beads leave no room to the fluid; expected fewer")


def first_beads(
    engine: Any, solutes: Solutes, places: Any, velocities: Any, fluid_is_drawn: bool
) -> tuple[Any, Any, Any]:
    """Places and velocities (beads, d), drawn where there are none, and the drift (d,) to take off.

    Beads are grown where there is room, with thermal velocities. The fluid, if its velocities are
    drawn too, takes part of their momentum, so that the whole is at rest.
    """
    numbers: Numbers = engine.numbers
    case, drift = numbers.case, np.zeros(numbers.dimension)
    kT = case.fluid.kT
    if places is not None and engine.bodies is not None:
        _require_outside(engine.bodies, places)
    if places is None:
        clear = nearest_of(solutes.wall.kernel(), kT) if solutes.wall else MARGIN
        room = out_of_bodies(engine.bodies, stays_out(numbers, clear))
        places = grown(solutes, kT, numbers.box, periods(numbers), case.run.seed, room)
    if velocities is None:
        ids = np.arange(FIRST_BEAD, FIRST_BEAD + solutes.beads)
        random = Draws(case.run.seed, INITIAL_VELOCITY, ids)
        mass = solutes.mass_per_bead()
        velocities = random.normals(numbers.dimension)
        velocities *= np.sqrt(kT / np.asarray(mass))[..., None]
        if fluid_is_drawn:
            one = isinstance(mass, float)
            momentum = mass * velocities.sum(axis=0) if one else mass @ velocities
            drift = momentum / (solutes.total_mass + numbers.total_mass)
            velocities -= drift
            velocities[:, 0] += case.box.first_rate * (places[:, 1] - 0.5 * numbers.box[1])
    return places, velocities, drift


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
        A fluid in memory; its case defines how to draw what is not given, its `parts` which
        particles are to be made here.
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
    if at_rest:  # less the mean velocity of all particles, wherever they are made
        scale = numbers.units["momentum"]
        sums = np.zeros((2, numbers.dimension), np.int64)
        for first, last in engine.parts():
            ids = np.arange(first, last)
            terms = numbers.masses_of(ids)[:, None] * thermal_velocities(numbers, ids) * scale
            sums = added_halves(np.stack([sums, halves(np.rint(terms).astype(np.int64))]))
        momentum = engine.readings.joined(sums, scale)
        drifts.append(np.asarray(momentum / max(numbers.total_mass, 1e-300)))
    if case.bodies:
        drifts.append(_begin_bodies(engine, at_rest))
    if case.solutes is not None:
        given = beads, bead_velocities
        beads, bead_velocities, drift = first_beads(engine, case.solutes, *given, at_rest)
        engine.solutes.begin(beads, bead_velocities)
        drifts.append(drift)

    def made(first: int, last: int) -> tuple[Ids, Floats, Floats, NDArray[np.int32]]:
        ids = np.arange(first, last)
        r = first_positions(numbers, ids, positions, beads, engine.bodies)
        if not at_rest:
            v = np.asarray(velocities[first:last], float)
        else:
            v = thermal_velocities(numbers, ids)
            for drift in drifts:
                v -= drift
            if case.box.sheared:
                v[:, 0] += case.box.first_rate * (r[:, 1] - 0.5 * numbers.box[1])
        return ids, r, v, np.zeros(r.shape, np.int32)

    engine.begin(made(*part) for part in parts)


def _begin_bodies(engine: Any, fluid_is_drawn: bool) -> Floats:
    """Give the bodies their first state; the drift (d,) to take off the fluid, so that the whole is
    at rest, or goes with the shear flow: else more would leave through one end than through the
    other, where images slide, and gain velocity for ever."""
    case, bodies, fluid_mass = engine.numbers.case, engine.bodies, engine.numbers.total_mass
    first = first_bodies(case)
    v, drift = first.velocities, np.zeros(engine.numbers.dimension)
    own = v.copy()
    own[:, 0] -= case.box.first_rate * (first.places[:, 1] - 0.5 * engine.numbers.box[1])
    held = {axis for kind in case.bodies for axis in kind.fixed}  # where momentum is not kept
    if fluid_is_drawn and not first.moving:
        drift = bodies.masses @ own / (bodies.masses.sum() + fluid_mass)
        drift[[axis in held for axis in AXES[: len(drift)]]] = 0.0
        v -= drift
    elif fluid_is_drawn and case.box.sheared and "y" not in held:  # of the fluid alone
        drift[1] = bodies.masses @ own[:, 1] / fluid_mass
    bodies.begin(first.places, first.turns, v, first.spins)
    return drift


def first_positions(
    numbers: Numbers, ids: Ids, given: Any, beads: Any = None, bodies: Any = None
) -> Floats:
    """Positions (n, d) of particles with these numbers, in a row and whole molecules: the given
    ones, or drawn where there is no solid and no body, and where the beads that act on the fluid
    leave room."""
    case, molecule = numbers.case, numbers.case.fluid.molecule
    if given is not None:
        places = np.asarray(given[ids[0] : ids[-1] + 1], float)
        if bodies is not None and bodies.inside(places).any():
            row = ids[0] + int(np.argmax(bodies.inside(places)))
            raise RunError(f"fluid.start.positions: row {row} lies in a body")
        return places if molecule is None else connected(places, molecule, periods(numbers))
    if molecule is None:
        random = Draws(case.run.seed, INITIAL_POSITION, ids)
        places = random.units(numbers.dimension) * numbers.box
        among_solids = numbers.solids is not None and numbers.slit is None
        left = np.arange(len(places) if among_solids or bodies is not None else 0)
        while len(left):  # those in a solid or in a body are drawn again
            inside = np.zeros(len(left), bool) if bodies is None else bodies.inside(places[left])
            if among_solids:
                assert numbers.solids is not None
                inside |= numbers.solids.distance(places[left]) < MARGIN
            left, random = left[inside], random.of(inside)
            places[left] = random.units(numbers.dimension) * numbers.box
        return places if beads is None else out_of_beads(numbers, ids, places, beads)
    random = Draws(case.run.seed, INITIAL_POSITION, ids[:: molecule.length] // molecule.length)
    return drawn(molecule, case.fluid.kT, numbers.box, random, stays_out(numbers))


def thermal_velocities(numbers: Numbers, ids: Ids) -> Floats:
    """Maxwellian velocities (n, d) of particles with these numbers."""
    found = Draws(numbers.case.run.seed, INITIAL_VELOCITY, ids).normals(numbers.dimension)
    return found * np.sqrt(numbers.case.fluid.kT / numbers.masses_of(ids))[:, None]
