"""How bodies start: places without overlap, orientations and thermal velocities."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.errors import CaseError
from mesokit.geometry.solids.solids import solids_of
from mesokit.method.mpcd.engine.bodies.allocate import masses_of
from mesokit.method.mpcd.start.draws import Draws
from mesokit.scalar.random import INITIAL_BODIES

Floats = NDArray[np.float64]
TRIES = 20_000  # places that are drawn for a body before there is no room
GAP = 0.85  # of the range of the potential of gaps: drawn bodies are at least so far apart
NONE = 1e-3  # cells, without a potential


def first_places(case: Case, periods: Floats) -> tuple[Floats, Floats]:
    """Centres (bodies, d) and orientations (bodies, 4) of all kinds, one after the other.

    Raises CaseError where there is no room, or where given places overlap.
    """
    d, size = case.box.dimension, np.array(case.box.size, float)
    total = sum(kind.number for kind in case.bodies)
    places, radii, gaps = np.zeros((total, d)), np.zeros(total), np.zeros(total)
    turns, done, order = np.zeros((total, 4)), 0, []
    for kind in case.bodies:
        rows = slice(done, done + kind.number)
        radii[rows] = kind.solid(d).radius
        gaps[rows] = GAP * kind.interaction.range if kind.interaction else NONE
        order.append((kind.start.rule != "given", -kind.solid(d).radius, rows, kind))
        done += kind.number
    placed: list[int] = []
    # Given places first, then kinds of large bodies before those of small ones.
    for _, _, rows, kind in sorted(order, key=lambda one: one[:2]):
        ids = np.arange(rows.start, rows.stop)
        if kind.start.rule == "given":
            places[rows] = _given(case, kind)
        elif kind.start.rule == "lattice":
            places[rows] = _lattice(kind.number, size)
        else:
            _draw(case, ids, places, radii + 0.5 * gaps, placed, periods)
        turns[rows] = _turns(case, kind, ids)
        placed += ids.tolist()
    _require_room(case, places, radii, periods)
    return places, turns


def _given(case: Case, kind: Any) -> Floats:
    rows, d = kind.start.positions, case.box.dimension
    if len(rows) != kind.number or any(len(row) != d for row in rows):
        raise CaseError(
            f"bodies.start.positions: expected {kind.number} rows (number) of {d} numbers"
        )
    return np.array(rows, float)


def _lattice(number: int, size: Floats) -> Floats:
    """The middles of equal parts of the box, as nearly cubes as may be; the first so many."""
    spacing = (float(np.prod(size)) / number) ** (1.0 / len(size))
    counts = np.maximum(np.rint(size / spacing), 1).astype(int)
    while math.prod(counts.tolist()) < number:
        counts[int((size / counts).argmax())] += 1
    along = [(np.arange(n) + 0.5) * length / n for n, length in zip(counts, size, strict=True)]
    places = np.stack(np.meshgrid(*along, indexing="ij"), -1).reshape(-1, len(size))
    return places[:number]


def _draw(
    case: Case, ids: NDArray[np.int64], places: Floats, radii: Floats, placed: list[int],
    periods: Floats,
) -> None:  # fmt: skip
    """Draw places of these bodies, one after the other, none nearer to another than their radii."""
    d, size = case.box.dimension, np.array(case.box.size, float)
    solids = solids_of(case) if case.walls else None
    finite = np.where(np.isfinite(periods), periods, 1e300)
    there = list(placed)
    for i in ids.tolist():
        random = Draws(case.run.seed, INITIAL_BODIES, np.array([i]))
        others = np.array(there, np.int64)
        for _ in range(TRIES):
            x = random.units(d)[0] * size
            away = places[others] - x
            away -= finite * np.rint(away / finite)
            apart = (away**2).sum(axis=1) >= (radii[others] + radii[i]) ** 2
            if apart.all() and (solids is None or float(solids.distance(x[None])[0]) >= radii[i]):
                break
        else:
            raise CaseError(
                f"bodies: no room for body {i + 1} after {TRIES} places were drawn; expected fewer "
                "or smaller bodies, or bodies.start.rule = 'lattice'"
            )
        places[i] = x
        there.append(i)


def _turns(case: Case, kind: Any, ids: NDArray[np.int64]) -> Floats:
    """Orientations: given, drawn with random places, else those of the box."""
    d, given = case.box.dimension, kind.start.orientations
    turns = np.tile([1.0, 0.0, 0.0, 0.0], (len(ids), 1))
    if given is not None:
        width = 1 if d == 2 else 4
        if len(given) != kind.number or any(len(row) != width for row in given):
            raise CaseError(
                f"bodies.start.orientations: expected {kind.number} rows (number) of {width} "
                + ("number, the angle" if d == 2 else "numbers, a quaternion")
            )
        rows = np.array(given, float)
        if d == 2:
            half = np.radians(0.5 * rows[:, 0])
            return np.stack([np.cos(half), 0 * half, 0 * half, np.sin(half)], axis=1)
        return rows / np.linalg.norm(rows, axis=1)[:, None]
    if kind.start.rule != "random" or kind.hinge is not None or "orientation" in kind.fixed:
        return turns
    random = Draws(case.run.seed, INITIAL_BODIES, ids, 2**20)
    if d == 2:
        half = math.pi * random.units(1)[:, 0]
        return np.stack([np.cos(half), 0 * half, 0 * half, np.sin(half)], axis=1)
    found = np.concatenate([random.normals(3), random.normals(3)[:, :1]], axis=1)
    return found / np.linalg.norm(found, axis=1)[:, None]


def _require_room(case: Case, places: Floats, radii: Floats, periods: Floats) -> None:
    """Raise CaseError for balls that overlap one another or a wall."""
    finite = np.where(np.isfinite(periods), periods, 1e300)
    balls = np.repeat(
        [len(k.solid(case.box.dimension).parts) == 1 and k.shape in ("sphere", "disk")
         for k in case.bodies],
        [k.number for k in case.bodies],
    )  # fmt: skip
    for i in range(len(places)):
        away = places[:i] - places[i]
        away -= finite * np.rint(away / finite)
        touch = (radii[:i] + radii[i]) * (balls[:i] & balls[i])
        near = np.flatnonzero((away**2).sum(axis=1) < touch**2)
        if len(near):
            raise CaseError(f"bodies.start: bodies {near[0] + 1} and {i + 1} overlap")
    if case.walls:
        depth = radii * balls - solids_of(case).distance(places)
        if (depth > 0).any():
            i = int(depth.argmax())
            raise CaseError(f"bodies.start: body {i + 1} is in a wall, {depth[i]:.3g} deep")


def first_velocities(case: Case, places: Floats, turns: Floats) -> tuple[Floats, Floats]:
    """Thermal velocities (bodies, d) and angular velocities (bodies, 3), about a sheared flow."""
    d, kT = case.box.dimension, case.fluid.kT
    numbers = [kind.number for kind in case.bodies]
    mass = np.repeat(masses_of(case), numbers)
    random = Draws(case.run.seed, INITIAL_BODIES, np.arange(len(places)), 2**21)
    v = random.normals(d) * np.sqrt(kT / mass)[:, None]
    spins, own = np.zeros((len(places), 3)), random.normals(3)
    done = 0
    for kind, m in zip(case.bodies, masses_of(case), strict=True):
        rows, solid = slice(done, done + kind.number), kind.solid(d)
        for k, name in enumerate("xyz"[:d]):
            if name in kind.fixed:
                v[rows, k] = 0.0
        if kind.start.velocities is not None:
            given = kind.start.velocities
            if len(given) != kind.number or any(len(row) != d for row in given):
                raise CaseError(
                    f"bodies.start.velocities: expected {kind.number} rows (number) of {d} numbers"
                )
            v[rows] = given
        inertia = m / solid.volume * solid.moments
        if "orientation" not in kind.fixed:
            spins[rows] = _thermal_spins(kind, inertia, own[rows], turns[rows], kT, d)
        done += kind.number
    if case.box.sheared:
        v[:, 0] += case.box.first_rate * (places[:, 1] - 0.5 * case.box.size[1])
        spins[:, 2] -= 0.5 * case.box.first_rate
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
