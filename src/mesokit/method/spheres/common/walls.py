"""Walls of spheres as rows of numbers for the loops: planes and round surfaces, and vibration."""

import math
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.geometry.region import Part, Room, Term
from mesokit.geometry.shape_protocol import closed_axes
from mesokit.geometry.solids.solids import Solids
from mesokit.geometry.surface import Surface
from mesokit.loops.neighbours import nearest_image
from mesokit.scalar.jit import elementwise, scalar
from mesokit.scalar.vector import added_scaled, dot, scaled
from mesokit.seam.engine import Array
from mesokit.seam.method import Plate

# columns: kind, place of three, unit vector of three (normal of a plane, axis of a cylinder),
# radius, velocity of three, amplitude, frequency, phase at the start of the window, speed of a
# plate along its normal, and how far it goes
KIND, PLACE, AXIS, ROUND, MOVES = 0, 1, 4, 7, 8
AMPLITUDE, FREQUENCY, PHASE, SPEED, TRAVEL, COLUMNS = 11, 12, 13, 14, 15, 16
PLANE, OUTSIDE, INSIDE = 0.0, 1.0, -1.0  # kinds: a plane; fluid outside or inside of a round wall
ROUND_KINDS = ("ball", "rod")
ALLOWED = "expected plates, or something round, or a rectangle or cuboid with fluid = 'inside'"


@scalar
def vibration(walls, w, time):
    """Displacement and velocity of a wall along its normal, and the bound of its acceleration."""
    amplitude, frequency = walls[w, AMPLITUDE], walls[w, FREQUENCY]
    if amplitude == 0.0:
        return 0.0, 0.0, 0.0
    phase = frequency * time + walls[w, PHASE]
    return (
        amplitude * math.sin(phase),
        amplitude * frequency * math.cos(phase),
        amplitude * frequency * frequency,
    )


@scalar
def displaced(walls, w, time):
    """Displacement and velocity along the normal of a plate that vibrates or moves."""
    shift, speed, _ = vibration(walls, w, time)
    path = walls[w, SPEED] * time
    if walls[w, SPEED] == 0.0:
        return shift, speed
    if abs(path) >= walls[w, TRAVEL]:
        return math.copysign(walls[w, TRAVEL], path), 0.0
    return path, walls[w, SPEED]


@elementwise
def entries(rows, i, start, pattern):
    """Consecutive entries of row i, as a tuple as long as `pattern`."""
    return "rows[i, start + {k}]"


@scalar
def outward(walls, w, box, r):
    """Distance of a place from a wall that does not vibrate, and the normal into the box."""
    from_place = added_scaled(r, -1.0, entries(walls, w, PLACE, r))
    axis = entries(walls, w, AXIS, r)
    if walls[w, KIND] == PLANE:
        return dot(from_place, axis), axis
    from_place = nearest_image(box, from_place)
    across = added_scaled(from_place, -dot(from_place, axis), axis)
    length = math.sqrt(dot(across, across))
    normal = scaled(walls[w, KIND] / length, across) if length > 0.0 else axis
    return walls[w, KIND] * (length - walls[w, ROUND]), normal


class SurfaceRows(NamedTuple):
    """rows (walls, 16); surfaces: number of the wall and surface of each row; surface (walls,):
    number of the body of each row; names of the bodies."""

    rows: Array
    surfaces: list[tuple[int, Surface]]
    surface: NDArray[np.int64]
    names: tuple[str, ...]


class NotARow(CaseError):
    """A wall of a shape that is no row of numbers."""


def other_walls(case: Case) -> list[int]:
    """Numbers of the walls that are no rows: neither planes nor round, nor boxes from within."""
    room, found = room_of(case), []
    for i, wall in enumerate(case.walls):
        try:
            for body in wall.bodies(room, ""):
                if body.surface.rotation is not None:
                    raise NotARow("it turns")
                list(_parts(body, room, i, case.run.method))
        except NotARow:
            found.append(i)
    return found


def surface_rows(case: Case, without: Sequence[int] = ()) -> SurfaceRows:
    """Places and motion of the walls of a case, except those of the numbers `without`.

    Raises CaseError for walls that are no rows.
    """
    room, method = room_of(case), case.run.method
    rows: list[Array] = []
    surfaces: list[tuple[int, Surface]] = []
    body_of: list[int] = []
    names: list[str] = []
    for i, wall in enumerate(case.walls):
        if i in without:
            continue
        if not wall.closed_axes and any(length != int(length) for length in case.box.size):
            raise CaseError(
                f"wall[#{i + 1}]: solids other than plates need a box of whole lengths, not "
                f"box.size = {show(list(case.box.size))}"
            )
        for body in wall.bodies(room, f"{type(wall).__name__.lower()}-{i + 1}"):
            if body.surface.rotation is not None:
                raise CaseError(f"wall[#{i + 1}]: rotation: not with method {method!r}")
            for part in _parts(body, room, i, method):
                rows.append(_row(part, body.surface, case.box.dimension))
                surfaces.append((i, body.surface))
                body_of.append(len(names))
            names.append(body.name)
    return SurfaceRows(
        np.array(rows, float).reshape(-1, COLUMNS),
        surfaces,
        np.array(body_of, np.int64),
        tuple(names),
    )


def surfaces_of(case: Case) -> tuple[int, NDArray[np.int64]]:
    """The number of surfaces, wall by wall, and the number of the surface of each row of walls, and
    then of each body of the other walls (rows + bodies,)."""
    which = other_walls(case)
    rows = surface_rows(case, which)
    walls = np.zeros(len(rows.names), np.int64)
    walls[rows.surface] = [i for i, _ in rows.surfaces]
    others = Solids(case.walls, case.box, only=which).walls if which else []
    bodies = np.concatenate([walls, np.array(others, np.int64)])
    rank = np.empty(len(bodies), np.int64)
    rank[np.argsort(bodies, kind="stable")] = np.arange(len(bodies))
    return len(bodies), np.concatenate([rank[rows.surface], rank[len(walls) :]])


def opening(case: Case, i: int) -> float:
    """The time at which wall number i is taken away, infinite for others."""
    opens = case.walls[i].opens
    return math.inf if opens is None else float(opens)


def moving_plates(case: Case, time: float) -> tuple[Plate, ...]:
    """Plates that vibrate or move into the box, displaced as at a time."""
    rows, d = surface_rows(case, other_walls(case)).rows, case.box.dimension
    return tuple(
        Plate(rows[w, PLACE : PLACE + d], rows[w, AXIS : AXIS + d], displaced(rows, w, time)[0])
        for w in np.flatnonzero((rows[:, AMPLITUDE] > 0) | (rows[:, SPEED] != 0))
    )


def pushed_plates(case: Case) -> list[tuple[int, Plate]]:
    """Plates that are pushed into the box, at rest, with the numbers of their surfaces."""
    which, d = other_walls(case), case.box.dimension
    rows, (_, surface) = surface_rows(case, which), surfaces_of(case)
    found = []
    for w, (_, own) in enumerate(rows.surfaces):
        contact = own.contact
        if contact is not None and (contact.force is not None or contact.pressure is not None):
            point, normal = rows.rows[w, PLACE : PLACE + d], rows.rows[w, AXIS : AXIS + d]
            found.append((int(surface[w]), Plate(point, normal, 0.0)))
    return found


def room_of(case: Case) -> Room:
    """The box, and which of its axes plates close."""
    shut = closed_axes(case.walls)
    return Room(case.box.size, tuple(axis in shut for axis in case.box.axes))


def _parts(body: Any, room: Room, i: int, method: str) -> Iterator[Part]:
    """The planes and round surfaces of a body, each once."""
    contact = body.surface.contact
    for piece in body.pieces:
        part = _alone(piece.term, room)
        if part is None:
            raise NotARow(f"wall[#{i + 1}]: not with method {method!r}; {ALLOWED}")
        if contact is not None and contact.amplitude > 0 and part.kind != "half_space":
            raise CaseError(
                f"wall[#{i + 1}].surface.contact.amplitude = {show(contact.amplitude)}: only "
                "plates vibrate"
            )
        if part.kind == "brick" and part.sign < 0:
            yield from _sides(part, room.dimension)
        elif part.kind == "half_space" and part.sign > 0:
            yield part
        elif part.kind in ROUND_KINDS:
            if _in_box(part, room):
                yield part  # its images are found by the nearest one
        else:
            raise NotARow(f"wall[#{i + 1}]: not with method {method!r}; {ALLOWED}")


def _alone(term: Term, room: Room) -> Part | None:
    """The one part of a term, its images aside; None of several parts."""
    if len(term) == 1:
        return term[0]
    part = next((part for part in term if _in_box(part, room)), None)
    if part is None or part.sign > 0 or part.kind not in (*ROUND_KINDS, "brick"):
        return None
    for other in term:  # images that do not overlap
        offset = [a - b for a, b in zip(other.numbers[:3], part.numbers[:3], strict=True)]
        if any(x % length for x, length in zip(offset, room.size, strict=False)):
            return None
        if any(offset) and not _apart(part, offset):
            return None
        if other.numbers[3:] != part.numbers[3:] or other.kind != part.kind:
            return None
    return part


def _apart(part: Part, offset: Sequence[float]) -> bool:
    """Whether a part and its image so far away do not overlap."""
    half = part.numbers[3:6]
    if part.kind != "brick":
        return math.hypot(*offset) >= 2 * part.numbers[6]
    upright = part.numbers[7] == 0.0
    beside = upright and any(abs(x) >= 2 * h for x, h in zip(offset, half, strict=True) if x)
    return beside or math.hypot(*offset) >= 2 * math.hypot(*half)


def _in_box(part: Part, room: Room) -> bool:
    return all(0 <= x < length for x, length in zip(part.numbers, room.size, strict=False))


def _sides(part: Part, dimension: int) -> Iterator[Part]:
    """The faces of a rectangle or cuboid from within, as planes that look inwards."""
    centre, half = np.array(part.numbers[:3]), part.numbers[3:6]
    cos, sin = part.numbers[6], part.numbers[7]
    axes = np.array([(cos, sin, 0.0), (-sin, cos, 0.0), (0.0, 0.0, 1.0)])
    for k in range(dimension):
        for sign in (1.0, -1.0):
            place = centre + sign * half[k] * axes[k]
            yield Part("half_space", (*place, *(-sign * axes[k])))


def _row(part: Part, surface: Surface, dimension: int) -> Array:
    row = np.zeros(COLUMNS)
    row[PLACE : PLACE + 3] = part.numbers[:3]
    if part.kind == "half_space":
        row[KIND] = PLANE
        row[AXIS : AXIS + 3] = part.numbers[3:6]
    else:
        row[KIND] = part.sign  # +1: solid within, spheres outside
        row[ROUND] = part.numbers[6]
        if part.kind == "rod":
            row[AXIS : AXIS + 3] = part.numbers[3:6]
    row[MOVES : MOVES + dimension] = surface.velocity or 0.0
    if surface.contact is not None:
        row[AMPLITUDE] = surface.contact.amplitude
        row[FREQUENCY] = surface.contact.frequency
        row[SPEED] = surface.contact.speed
        row[TRAVEL] = math.inf if surface.contact.travel is None else surface.contact.travel
    return row
