"""External forces on single beads: pulls, traps, magnetic fields."""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.method.mpcd.engine.cpu.strips.rows import load_values
from mesokit.method.mpcd.engine.where import where
from mesokit.method.mpcd.solutes import Solutes
from mesokit.scalar.elementary import sincos_turn
from mesokit.scalar.intrinsics import floor
from mesokit.scalar.jit import scalar
from mesokit.scalar.pointer import element
from mesokit.scalar.vector import added, added_scaled, dot, scaled


class External(NamedTuple):
    """Force (beads * d), stiffness (beads,) about a centre (beads * d), and by how many turns in a
    unit of time velocities turn about the axes x, y, z: (beads * 3)."""

    force: Any
    stiffness: Any
    centre: Any
    turns: Any


def external_of(given: Solutes, d: int) -> tuple[External, ...]:
    """The sum of all pulls, traps and fields; () where there is none."""
    if not (given.pulls or given.traps or given.magnetic):
        return ()
    n = given.beads
    force, stiffness, held = np.zeros((n, d)), np.zeros(n), np.zeros((n, d))
    turns, masses = np.zeros((n, 3)), np.broadcast_to(given.mass_per_bead(), (n,))
    for pull in given.pulls:
        force[pull.beads(given)] += pull.force
    for trap in given.traps:
        beads = trap.beads(given)
        stiffness[beads] += trap.k
        held[beads] += trap.k * np.array(trap.centre)
    for field in given.magnetic:
        beads = field.beads(given)
        rate = field.charge / (2 * math.pi * masses[beads])
        turns[beads] += rate[:, None] * np.array(field.field)
    centre = held / np.maximum(stiffness, 1e-300)[:, None]
    return (External(force.ravel(), stiffness, centre.ravel(), turns.ravel()),)


def external_energy(external: tuple[External, ...], places: NDArray[np.float64]) -> float:
    """Energy of beads (n, d) in their traps; pulls, which do not end, have none."""
    squares = [((places - one.centre.reshape(places.shape)) ** 2).sum(1) for one in external]
    each = zip(external, squares, strict=True)
    return sum(float((0.5 * one.stiffness * square).sum()) for one, square in each)


@where("force", external=len)
def from_outside(external, force, i, r):
    """The force on bead i at r, and what acts from outside."""
    (given,) = external
    start = np.uint64(i * len(r))
    away = added_scaled(load_values(given.centre, start, r), -1.0, r)
    return added_scaled(
        added(force, load_values(given.force, start, r)), element(given.stiffness, i), away
    )


@scalar
def turned_about(turns, time, v):
    """The velocity (3) after a time of turning clockwise about a vector of turns."""
    rate = math.sqrt(dot(turns, turns))
    if rate == 0.0:
        return v
    axis, angle = scaled(1.0 / rate, turns), rate * time
    sine, cosine = sincos_turn(angle - floor(angle))
    along = scaled((1.0 - cosine) * dot(axis, v), axis)
    x, y, z = v
    a, b, c = axis
    across = y * c - z * b, z * a - x * c, x * b - y * a
    return added(added_scaled(scaled(cosine, v), sine, across), along)


@where("v", external=len)
def turned_by_field(external, time, i, v):
    """The velocity of bead i after a time in a magnetic field."""
    (given,) = external
    if len(v) == 2:  # the literal length picks one of the two when it is compiled
        x, y, _ = turned_about((0.0, 0.0, element(given.turns, 3 * i + 2)), time, (v[0], v[1], 0.0))
        return x, y
    return turned_about(load_values(given.turns, np.uint64(3 * i), v), time, v)
