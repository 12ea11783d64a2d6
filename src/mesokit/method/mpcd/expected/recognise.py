"""Solids whose flow is known: round pipes, drums and gaps, arrays of cylinders and of spheres."""

import math
from typing import Any, NamedTuple

from mesokit.case.box import AXES
from mesokit.case.case import Case
from mesokit.geometry.shape.array import Array
from mesokit.geometry.shape.cylinder import Cylinder
from mesokit.geometry.shape.disk import Disk
from mesokit.geometry.shape.plates import Plates
from mesokit.geometry.shape.rectangle import Rectangle
from mesokit.geometry.shape.sphere import Sphere
from mesokit.geometry.solids.solids import solids_of


class Pipe(NamedTuple):
    """Something round along axis number `axis`, through `centre`."""

    axis: int
    centre: tuple[float, ...]
    radius: float


class Gap(NamedTuple):
    """Fluid between two round surfaces about one axis: 2, or that of two cylinders.

    `inner_body` and `outer_body` are their numbers.
    """

    axis: int
    centre: tuple[float, ...]
    inner: float
    outer: float
    inner_rate: float
    outer_rate: float
    inner_body: int
    outer_body: int


class Drum(NamedTuple):
    """Fluid in a round vessel that turns about its axis."""

    axis: int
    centre: tuple[float, ...]
    radius: float
    rate: float


class Lattice(NamedTuple):
    """Disks, cylinders or spheres on a square or cubic lattice with the axes `across`."""

    across: tuple[int, ...]
    pitch: float
    radius: float

    @property
    def concentration(self) -> float:
        """Part of the volume that is solid."""
        if len(self.across) == 2:
            return math.pi * (self.radius / self.pitch) ** 2
        return 4 * math.pi / 3 * (self.radius / self.pitch) ** 3


def pipe(case: Case) -> Pipe | None:
    """The round pipe at rest that is the only wall, along an axis of the box."""
    if len(case.walls) != 1:
        return None
    (wall,) = case.walls
    axis = _axis(wall)
    if not isinstance(wall, Cylinder) or axis is None:
        return None
    if wall.fluid == "outside" or not _still(wall):
        return None
    return Pipe(axis, wall.centre, wall.radius)


def lone_post(case: Case) -> Pipe | None:
    """The disk or cylinder along an axis of the box that is the only wall, fluid around it."""
    if len(case.walls) != 1:
        return None
    wall: Any = case.walls[0]
    axis = _axis(wall)
    if axis is None or wall.fluid == "inside":
        return None
    return Pipe(axis, wall.centre, wall.radius)


def drum(case: Case) -> Drum | None:
    """The round vessel that is the only wall, if it does not move but by turning."""
    if len(case.walls) != 1:
        return None
    wall: Any = case.walls[0]
    axis = _axis(wall)
    if axis is None or wall.fluid == "outside" or wall.surface.rule != "no-slip":
        return None
    rate = solids_of(case).bodies[0].rotation
    if any(wall.surface.velocity or ()) or any(rate[k] for k in range(3) if k != axis):
        return None
    return Drum(axis, wall.centre, wall.radius, rate[axis])


def gap(case: Case) -> Gap | None:
    """The gap between two no-slip disks or cylinders with one axis, which may turn about it."""
    if len(case.walls) != 2 or {type(wall) for wall in case.walls} not in ({Disk}, {Cylinder}):
        return None
    walls: Any = case.walls
    first, second = walls
    axis = _axis(first)
    if axis is None or axis != _axis(second) or first.fluid == second.fluid:
        return None
    inner, outer = (0, 1) if first.fluid == "outside" else (1, 0)
    surfaces = [wall.surface for wall in walls]
    if not all(one.rule == "no-slip" and not any(one.velocity or ()) for one in surfaces):
        return None
    centres = enumerate(zip(first.centre, second.centre, strict=True))
    off = [a - b for k, (a, b) in centres if k != axis]
    rates = [body.rotation for body in solids_of(case).bodies]
    crooked = any(rate[k] for rate in rates for k in range(3) if k != axis)
    if any(off) or crooked or walls[inner].radius >= walls[outer].radius:
        return None
    radii, turning = (walls[inner].radius, walls[outer].radius), [rate[axis] for rate in rates]
    return Gap(axis, first.centre, *radii, turning[inner], turning[outer], inner, outer)


def lattice(case: Case) -> Lattice | None:
    """The square array of disks or cylinders, or simple cubic one of spheres, at rest."""
    if len(case.walls) != 1:
        return None
    wall: Any = case.walls[0]
    repeated = isinstance(wall, Array)
    one = wall.of if repeated else wall
    repeat = wall.repeat if repeated else (1,) * case.box.dimension
    if not isinstance(one, Disk | Cylinder | Sphere) or not _still(wall):
        return None
    along = _axis(one)
    if "inside" in (wall.fluid, one.fluid) or (isinstance(one, Cylinder) and along is None):
        return None
    across = tuple(k for k in range(case.box.dimension) if isinstance(one, Sphere) or k != along)
    pitches = {case.box.size[k] / repeat[k] for k in across}
    if len(pitches) != 1 or one.radius > min(pitches) / 2:
        return None
    return Lattice(across, pitches.pop(), one.radius)


def in_channel(case: Case) -> str | None:
    """ "disk" or "square" for one at rest in the middle of a 2D channel 8 times as high."""
    channels = [wall for wall in case.walls if isinstance(wall, Plates)]
    bodies = [wall for wall in case.walls if isinstance(wall, Disk | Rectangle)]
    if case.box.dimension == 3 or len(case.walls) != 2 or not (channels and bodies):
        return None
    plates, body = channels[0], bodies[0]
    if body.fluid == "inside" or not _still(body):
        return None
    if not all(s.rule == "no-slip" and not s.moves for s in (plates.lower, plates.upper)):
        return None
    across = AXES.index(plates.axis)
    height = case.box.size[across]
    sides: tuple[float, ...] = body.size if isinstance(body, Rectangle) else (2 * body.radius,)
    square = isinstance(body, Disk) or (sides[0] == sides[1] and body.angle % 90 == 0)
    middle = abs(body.centre[across] - height / 2) < 0.02 * height
    if not square or not middle or abs(8 * sides[0] / height - 1) > 0.03:
        return None
    return "disk" if isinstance(body, Disk) else "square"


def _axis(wall: Any) -> int | None:
    """Number of the axis of a disk (that would be z) or cylinder, None along no axis of the box."""
    if isinstance(wall, Disk):
        return 2
    if not isinstance(wall, Cylinder):
        return None
    found = [k for k in range(len(AXES)) if abs(wall.direction[k]) == 1]
    return found[0] if found else None


def _still(wall: Any) -> bool:
    return wall.surface.rule == "no-slip" and not wall.surface.moves
