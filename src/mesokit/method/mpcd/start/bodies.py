"""How bodies start: places without overlap, orientations and thermal velocities."""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.method.mpcd.body.protocol import LATTICE, RANDOM
from mesokit.method.mpcd.engine.bodies.allocate import masses_of
from mesokit.method.mpcd.start.body_room import (
    Apart,
    deepest_in_wall,
    free_places,
    least_gap,
    open_lengths,
    overlap,
    tree_of,
)
from mesokit.method.mpcd.start.draws import Draws
from mesokit.method.mpcd.start.known_bodies import KnownBodies, known_bodies
from mesokit.scalar.random import INITIAL_BODIES

Floats = NDArray[np.float64]
GAP = 0.85  # of the range of the potential of gaps: drawn bodies are at least so far apart
NONE = 1e-3  # cells, without a potential


class FirstBodies(NamedTuple):
    """All kinds, one after the other: centres (bodies, d), orientations (bodies, 4), velocities
    (bodies, d), angular velocities (bodies, 3), and whether any of these velocities were known."""

    places: Floats
    turns: Floats
    velocities: Floats
    spins: Floats
    moving: bool


def first_bodies(case: Case) -> FirstBodies:
    """The bodies as they start, with thermal velocities where none are known.

    Raises CaseError where there is no room, where bodies overlap, and for files and runs that do
    not fit.
    """
    known = [known_bodies(case, number) for number in range(1, len(case.bodies) + 1)]
    places, turns = first_places(case, known)
    v, spins = first_velocities(case, places, turns, known)
    moving = any(one.velocities is not None or one.spins is not None for one in known)
    return FirstBodies(places, turns, v, spins, moving)


def first_places(case: Case, known: Sequence[KnownBodies] = ()) -> tuple[Floats, Floats]:
    """Centres (bodies, d) and orientations (bodies, 4) of all kinds, one after the other.

    `known` is what the starts of the kinds say. Raises CaseError where there is no room, where
    bodies overlap, and for files and runs that do not fit.
    """
    known = known or [known_bodies(case, number) for number in range(1, len(case.bodies) + 1)]
    d, size = case.box.dimension, np.array(case.box.size, float)
    total = sum(kind.number for kind in case.bodies)
    places, turns, done, order = np.zeros((total, d)), np.zeros((total, 4)), 0, []
    for number, kind in enumerate(case.bodies, start=1):
        rows = slice(done, done + kind.number)
        order.append((known[number - 1].places is None, -kind.solid(d).radius, number, rows, kind))
        done += kind.number
    placed: list[Apart] = []
    # Given places first, then kinds of large bodies before those of small ones.
    for _, _, number, rows, kind in sorted(order, key=lambda one: one[:2]):
        ids = np.arange(rows.start, rows.stop)
        gap = GAP * kind.interaction.range if kind.interaction.depth else NONE
        reach = kind.solid(d).radius + 0.5 * gap
        if (given := known[number - 1].places) is not None:
            places[rows] = given
        elif kind.start.rule == LATTICE:
            places[rows] = _lattice(kind.number, size)
        else:
            places[rows], found = free_places(case, ids, reach, reach + 0.5 * gap, placed)
            if found < kind.number:
                raise CaseError(
                    f"bodies[#{number}].number = {kind.number}: no room was found for more than "
                    f"{found}; expected fewer or smaller bodies, or start.rule = 'lattice'"
                )
        oriented = known[number - 1].turns
        turns[rows] = _turns(case, kind, ids) if oriented is None else oriented
        placed.append(Apart(tree_of(places[rows], open_lengths(case)), reach))
    _require_room(case, places, turns)
    return places, turns


def _lattice(number: int, size: Floats) -> Floats:
    """The middles of equal parts of the box, as nearly cubes as may be; the first so many."""
    spacing = (float(np.prod(size)) / number) ** (1.0 / len(size))
    counts = np.maximum(np.rint(size / spacing), 1).astype(int)
    while math.prod(counts.tolist()) < number:
        counts[int((size / counts).argmax())] += 1
    along = [(np.arange(n) + 0.5) * length / n for n, length in zip(counts, size, strict=True)]
    places = np.stack(np.meshgrid(*along, indexing="ij"), -1).reshape(-1, len(size))
    return places[:number]


def _turns(case: Case, kind: Any, ids: NDArray[np.int64]) -> Floats:
    """Orientations where none are known: drawn with random places, else those of the box."""
    d = case.box.dimension
    turns = np.tile([1.0, 0.0, 0.0, 0.0], (len(ids), 1))
    if kind.start.rule != RANDOM or kind.hinge is not None or "orientation" in kind.fixed:
        return turns
    random = Draws(case.run.seed, INITIAL_BODIES, ids, 2**20)
    if d == 2:
        half = math.pi * random.units(1)[:, 0]
        return np.stack([np.cos(half), 0 * half, 0 * half, np.sin(half)], axis=1)
    found = np.concatenate([random.normals(3), random.normals(3)[:, :1]], axis=1)
    return found / np.linalg.norm(found, axis=1)[:, None]


def _require_room(case: Case, places: Floats, turns: Floats) -> None:
    """Raise CaseError for bodies that overlap one another or a wall."""
    ends = np.cumsum([kind.number for kind in case.bodies])

    def key(body: int) -> tuple[int, int]:
        kind = int(np.searchsorted(ends, body, side="right"))
        return kind + 1, body - int(ends[kind]) + case.bodies[kind].number + 1

    def named(kind: int, i: int) -> str:
        rows = case.bodies[kind - 1].start.positions
        if rows is None or isinstance(rows, str):
            return f"bodies[#{kind}].start: its body {i}"
        return f"bodies[#{kind}].start.positions[#{i}] = {show(rows[i - 1])}: body {i}"

    met = overlap(case, places, turns)
    if met is not None:
        (first, i), (last, j) = map(key, met)
        of = "" if first == last else f" of bodies[#{first}]"
        one, other = case.bodies[first - 1], case.bodies[last - 1]
        d, least = case.box.dimension, least_gap(one, other)
        balls = least and one.solid(d).ball and other.solid(d).ball
        near = f", or is nearer than {least:.2g} cells to it" if balls else ""
        fewer = "; expected fewer or smaller bodies" if other.start.rule == LATTICE else ""
        raise CaseError(f"{named(last, j)} overlaps body {i}{of}{near}{fewer}")
    deep = deepest_in_wall(case, places, turns) if case.walls else None
    if deep is not None:
        raise CaseError(f"{named(*key(deep[0]))} is in a wall, about {deep[1]:.2g} deep")


def first_velocities(
    case: Case, places: Floats, turns: Floats, known: Sequence[KnownBodies]
) -> tuple[Floats, Floats]:
    """Velocities (bodies, d) and angular velocities (bodies, 3): known ones, or thermal ones about
    a sheared flow."""
    d, kT = case.box.dimension, case.fluid.kT
    numbers = [kind.number for kind in case.bodies]
    mass = np.repeat(masses_of(case), numbers)
    random = Draws(case.run.seed, INITIAL_BODIES, np.arange(len(places)), 2**21)
    v = random.normals(d) * np.sqrt(kT / mass)[:, None]
    spins, own = np.zeros((len(places), 3)), random.normals(3)
    shear = case.box.first_rate if case.box.sheared else 0.0
    v[:, 0] += shear * (places[:, 1] - 0.5 * case.box.size[1])
    done = 0
    for kind, m in zip(case.bodies, masses_of(case), strict=True):
        rows, solid = slice(done, done + kind.number), kind.solid(d)
        for k, name in enumerate("xyz"[:d]):
            if name in kind.fixed:
                v[rows, k] = 0.0
        inertia, turning = m / solid.volume * solid.moments, np.array([0.0, 0.0, -0.5 * shear])
        if kind.hinge is not None:
            h = np.array(kind.hinge) / np.linalg.norm(kind.hinge)
            turning = (h @ turning) * h
        if "orientation" not in kind.fixed:
            spins[rows] = _thermal_spins(kind, inertia, own[rows], turns[rows], kT, d) + turning
        done += kind.number
    done = 0
    for kind, one in zip(case.bodies, known, strict=True):
        rows = slice(done, done + kind.number)
        v[rows] = v[rows] if one.velocities is None else one.velocities
        spins[rows] = spins[rows] if one.spins is None else one.spins
        done += kind.number
    return v, spins


def _thermal_spins(
    kind: Any, inertia: Floats, drawn: Floats, turns: Floats, kT: float, d: int
) -> Floats:
    """Angular velocities (n, 3) of bodies of a kind, from normal numbers (n, 3)."""
    if d == 2:
        return np.stack([0 * drawn[:, 0], 0 * drawn[:, 0], drawn[:, 2]], axis=1) * math.sqrt(
            kT / inertia[2, 2]
        )
    if kind.hinge is not None:
        h = np.array(kind.hinge) / np.linalg.norm(kind.hinge)
        return drawn[:, :1] * h * math.sqrt(kT / float(h @ inertia @ h))
    values, axes = np.linalg.eigh(inertia)
    own = (drawn * np.sqrt(kT / values)) @ axes.T
    w, u = turns[:, :1], turns[:, 1:]
    twist = 2.0 * np.cross(u, own)
    found: Floats = own + w * twist + np.cross(u, twist)
    return found
