"""The flight of molecules through a timestep, WIDTH of them at a time.

Springs by velocity Verlet: half a kick, then a drift and a kick for each sub-step, the last kick a
half one. Beads fly straight between two kicks, and bounce off solids there.
"""

from typing import NamedTuple

import numpy as np

from mesokit.execute.beads import WIDTH, bead_of, leave, look
from mesokit.execute.bounce import bounce
from mesokit.execute.forces import add_product, add_virial, kick
from mesokit.execute.layout import LANES, SCRATCH_ROW
from mesokit.execute.look_around import FEW, forget
from mesokit.execute.stages import Physics, clear_of, kind_of_solid
from mesokit.geometry.none import Nothing
from mesokit.geometry.protocol import free, touches
from mesokit.mpcd.molecule import Dimers
from mesokit.mpcd.streaming import fall, halfway
from mesokit.pointer import word
from mesokit.potential.protocol import torn
from mesokit.random import Counter
from mesokit.scalar import (
    added,
    added_scaled,
    by_type,
    by_type_with_views,
    chosen,
    dot,
    scalar,
    scaled,
)

SUBSTEP_BITS = 40  # sub-steps stand above these bits of a step's number in random streams


class Flock(NamedTuple):
    """Which molecules move: lanes from `start` on of the group whose first strip is `strip`."""

    strip: int
    start: int
    lanes: int  # so many of the WIDTH hold molecules


@by_type_with_views
def fly_molecules(
    physics, flock, counter, work, ident, clear, calm, hits, impulse, faults, measured, tensor,
    scales, like,
):  # fmt: skip
    """Positions and velocities of beads a timestep later.

    `clear` and `calm` say how far beads may fly before they meet a solid, and bonds that tear are
    noted in `faults`. `tensor` gets, if it is measured, the momentum that bonds hand over.
    """
    molecule = physics.types[physics.fields.index("molecule")]
    chosen = _fly_dimers if molecule.instance_class is Dimers else _fly_springs

    def fly(
        physics, flock, counter, work, ident, clear, calm, hits, impulse, faults, measured, tensor,
        scales, like,
    ):  # fmt: skip
        chosen(
            physics, flock, counter, work, ident, clear, calm, hits, impulse, faults, measured,
            tensor, scales, like,
        )  # fmt: skip

    return fly


@scalar
def _fly_springs(
    physics, flock, counter, work, ident, clear, calm, hits, impulse, faults, measured, tensor,
    scales, like,
):  # fmt: skip
    beads, substeps = physics.molecule.beads, physics.molecule.substeps
    time = physics.timestep / substeps
    short = within(physics, time)
    for k in range(beads):
        remember(physics.solid, bead_of(work, k, like), like)
    for n in range(substeps + 1):
        if n > 0:  # r: t + (n - 1) h -> t + n h
            at = Counter(counter.seed, counter.step + (n << SUBSTEP_BITS))
            for k in range(beads):
                bead, s = bead_of(work, k, like), flock.strip + k
                around = clear[k * SCRATCH_ROW + flock.start : (k + 1) * SCRATCH_ROW]
                who = ident[s * LANES + flock.start : (s + 1) * LANES]
                if drift_bead(
                    short, at, bead, flock.lanes, who, around, hits, impulse, scales, like
                ):
                    forget(calm, s, 1 << (flock.start // FEW))
        # v: the second half of the kick of that sub-step, and the first half of the next one's
        span = time if 0 < n < substeps else 0.5 * time
        if measured:
            add_virial(physics, work, span, flock.lanes, tensor, like)
        if kick(physics, work, span, like):
            note_torn(physics.molecule, flock, counter, work, ident, faults, like)


@scalar
def _fly_dimers(
    physics, flock, counter, work, ident, clear, calm, hits, impulse, faults, measured, tensor,
    scales, like,
):  # fmt: skip
    d, exact, time = len(like), physics.molecule, physics.timestep
    a, b = bead_of(work, 0, like), bead_of(work, 1, like)
    if measured:
        _exact_virial(exact, a, b, flock.lanes, tensor, like)
    for i in range(WIDTH):
        r, v = look(a, i, 0, like), look(a, i, d, like)
        r2, v2 = look(b, i, 0, like), look(b, i, d, like)
        way, rate = added_scaled(r2, -1.0, r), added_scaled(v2, -1.0, v)
        centre, drift = scaled(0.5, added(r, r2)), scaled(0.5, added(v, v2))
        pull = halfway(physics.field, centre, drift, time)
        centre, drift = fall(centre, drift, pull, time)
        half = scaled(0.5, added_scaled(scaled(exact.cosine, way), exact.late, rate))
        turn = scaled(0.5, added_scaled(scaled(exact.cosine, rate), exact.early, way))
        leave(a, i, 0, added_scaled(centre, -1.0, half) + added_scaled(drift, -1.0, turn))
        leave(b, i, 0, added(centre, half) + added(drift, turn))


@scalar
def _exact_virial(exact, a, b, lanes, tensor, like):
    """Add the momentum that harmonic bonds hand over in a timestep: -2K times the time integral of
    the outer product of the vector between the beads with itself."""
    d = len(like)
    for i in range(lanes):
        way = added_scaled(look(b, i, 0, like), -1.0, look(a, i, 0, like))
        rate = added_scaled(look(b, i, d, like), -1.0, look(a, i, d, like))
        add_product(tensor, exact.ways, way, way)
        add_product(tensor, exact.mixed, way, rate)
        add_product(tensor, exact.mixed, rate, way)
        add_product(tensor, exact.rates, rate, rate)


@scalar
def within(physics, time):
    """The same physics for a shorter time."""
    return Physics(
        physics.rule, physics.thermostat, physics.field, physics.solid, physics.masses,
        physics.energy, time, physics.kT, physics.molecule,
    )  # fmt: skip


@by_type
def remember(solid, bead, like):
    """Keep the places from which the timestep started, where solids ask for them."""
    return (lambda *_: None) if solid.instance_class is Nothing else _remember


def _remember(solid, bead, like):
    for i in range(WIDTH):
        leave(bead, i, 2 * len(like), look(bead, i, 0, like))


@by_type
def drift_bead(short, counter, bead, lanes, ident, clear, hits, impulse, scales, like):
    """Straight flight through a sub-step, with reflections; whether beads came near a solid."""
    return _drift if kind_of_solid(short) is Nothing else _drift_among_solids


def _drift(short, counter, bead, lanes, ident, clear, hits, impulse, scales, like):
    d = len(like)
    for i in range(WIDTH):
        r, v = look(bead, i, 0, like), look(bead, i, d, like)
        leave(bead, i, 0, added_scaled(r, short.timestep, v))
    return False


def _drift_among_solids(short, counter, bead, lanes, ident, clear, hits, impulse, scales, like):
    # Beads that may hit a surface stay behind in the first loop, as in `stages.fly`. How far they
    # may go is known from where the timestep started: so the whole way from there counts.
    d, solid, time, rest = len(like), short.solid, short.timestep, scaled(0.0, like)
    any_hit = np.int64(0)
    for i in range(WIDTH):
        r, v = look(bead, i, 0, like), look(bead, i, d, like)
        there, start = added_scaled(r, time, v), look(bead, i, 2 * d, like)
        way = added_scaled(there, -1.0, start)
        hit = np.int64(touches(solid, clear_of(solid, clear, i), start, way, rest, 1.0))
        hits[i] = hit
        any_hit |= hit
        leave(bead, i, 0, chosen(hit != 0, r, there))
    if any_hit == 0:
        return False
    for i in range(lanes):
        if hits[i] != 0:
            r, v = look(bead, i, 0, like), look(bead, i, d, like)
            if free(solid, r, v, rest, time):
                r, v = fall(r, v, rest, time)
            else:
                m = short.masses[0]
                r, v = bounce(short, counter, ident[i], m, r, v, rest, impulse, scales[0])
            leave(bead, i, 0, r + v)
    return True


@scalar
def note_torn(molecule, flock, counter, work, ident, faults, like):
    """Note step and beads of the first bond that is longer than it can be (seldom called)."""
    base = flock.strip * LANES + flock.start
    for n in range(molecule.number[0]):
        a, b = word(molecule.links, 2 * n), word(molecule.links, 2 * n + 1)
        for i in range(flock.lanes):
            way = added_scaled(
                look(bead_of(work, b, like), i, 0, like), -1.0,
                look(bead_of(work, a, like), i, 0, like),
            )  # fmt: skip
            if torn(molecule.bond, dot(way, way)):
                one = np.int64(ident[base + a * LANES + i])
                other = np.int64(ident[base + b * LANES + i])
                step = np.int64(counter.step)
                before = faults[0] == 0 or step < faults[0]
                if before or (step == faults[0] and one < faults[1]):
                    faults[0], faults[1], faults[2] = step, one, other
