"""Soft spheres in memory: sorting, neighbour lists, steps and reading by particle number."""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import RunError
from mesokit.geometry.protocol import Nothing
from mesokit.geometry.solids.bodies import NO_TERM
from mesokit.kernels.packing import Packing
from mesokit.loops.layout import by_number
from mesokit.loops.neighbours import GAP, inverse_lengths
from mesokit.loops.threads import Threads
from mesokit.method.spheres.common.walls import AMPLITUDE, AXIS, KIND, PLACE, PLANE
from mesokit.method.spheres.soft.engine import groups
from mesokit.method.spheres.soft.engine.acting import measure_all
from mesokit.method.spheres.soft.engine.contact.remembered import carry_springs, pairs_of, remember
from mesokit.method.spheres.soft.engine.contact.room import rooms
from mesokit.method.spheres.soft.engine.groups import (
    Bodies,
    Box,
    Lists,
    Motion,
    Solid,
    Walls,
    World,
)
from mesokit.method.spheres.soft.engine.lists import GROUP, make_lists, sort
from mesokit.method.spheres.soft.engine.solid import MOST
from mesokit.method.spheres.soft.engine.step import advance, find_forces
from mesokit.method.spheres.soft.engine.taken import all_taken, in_numbers
from mesokit.scalar.random import Counter
from mesokit.seam.engine import Array

CELLS = 4_000_000  # at most
ROUNDING = 1 + 1e-9  # cells are larger by this than they need to be
KEPT = ("place", "velocity", "spin", "force", "torque", "images")  # arrays in checkpoints


class Grid(NamedTuple):
    """Cells along each axis, their number per length, the number of cells on both sides that a list
    searches, and the square of the longest distance on a list."""

    cells: tuple[int, int, int]
    inverse: tuple[float, float, float]
    wide: tuple[int, int, int]
    farthest: float


class Others(NamedTuple):
    """Walls of any shape: bodies, pattern and own as of `groups.Solid`; kept: the owner of the
    memory of their tables."""

    bodies: Any
    pattern: tuple[float, ...]
    own: Array
    kept: Any


class SoftSetup(NamedTuple):
    """Parameters of a system of soft spheres.

    size of the box and closed axes; reach, masses, inertia (n,); law of the forces, see `acting`;
    halves: whether each pair is computed once; width: numbers in the springs of a contact; nearest:
    least allowed distance of two centres; motion; rows and own of walls, see `Walls`; seed; skin of
    lists; others: walls of any shape; fastest: largest speed at which steps resolve contacts.
    """

    size: tuple[float, ...]
    closed: tuple[bool, ...]
    reach: Array
    masses: Array
    inertia: Array
    law: Any
    halves: bool
    width: int
    nearest: float
    motion: Motion
    rows: Array
    own: Array
    seed: int
    skin: float
    others: Others | None = None
    fastest: float = math.inf


class SoftSystem:
    """Soft spheres in a box, their neighbour lists, and the threads that move them."""

    def __init__(self, given: SoftSetup, threads: int) -> None:
        n, self.given, self.worker = len(given.reach), given, Threads(threads)
        self.n, self.dimension, self._packing = n, len(given.size), Packing()
        self.box = _box(given)
        self.grid = _grid(given, self.box)
        self.bodies, self.spare = _bodies(n), _bodies(n)
        self.walls, self.lists, self.old = self._walls(), self._lists(GROUP), self._lists(GROUP)
        self.cell, self.order = np.zeros(n, np.int64), np.zeros(n, np.int64)
        self.begins = np.zeros(int(np.prod(self.grid.cells)) + 1, np.int64)
        self.scratch = np.zeros((threads, n + GROUP), np.int64)
        self.noted = np.zeros((threads, GAP))
        surfaces = len(given.rows) + (0 if given.others is None else len(given.others.own))
        self.rooms = rooms(threads, surfaces)
        self.noted.view(np.int64)[:, groups.NEAREST] = np.float64(np.inf).view(np.int64)
        self.worker.compile_ahead(advance, *self._arguments(0, 0))

    def _walls(self) -> Walls:
        """Walls without contacts."""
        n, given = self.n, self.given
        solid: Any = Nothing()
        if (others := given.others) is not None:
            terms, springs = np.full((n, MOST), NO_TERM, np.int32), self._springs(n * MOST)
            solid = Solid(others.bodies, others.pattern, others.own, terms, springs)
        return Walls(given.rows, given.own, self._springs(n * len(given.rows)), solid)

    def _springs(self, contacts: int) -> Array:
        return np.zeros((contacts, self.given.width))

    def _lists(self, most: int) -> Lists:
        n, given = self.n, self.given
        count, own, begin = (np.zeros(n, np.int64) for _ in range(3))
        near, springs = np.zeros((n, most), np.int32), np.zeros((n * given.width, given.width))
        return Lists(given.skin, given.halves, count, own, near, begin, springs, np.zeros((n, 4)))

    # --- start and steps --------------------------------------------------------------------------

    def fill(self, places: Array, velocities: Array, spins: Array) -> None:
        """Put spheres at these places (n, d), with velocities (n, d) and spins ((n,) or (n, 3))."""
        given, bodies, d = self.given, self.bodies, self.dimension
        size, repeats = np.array(given.size), ~np.array(given.closed)
        images = np.where(repeats, np.floor(places / size), 0).astype(np.int32)
        inside = places - images * size
        inside = np.where(repeats & (inside >= size), 0.0, inside)
        for array in bodies:
            array[:] = 0
        bodies.number[:] = np.arange(self.n)
        bodies.place[:, :d], bodies.place[:, groups.REACH] = inside, given.reach
        bodies.images[:, :d] = images
        bodies.velocity[:, :d], bodies.velocity[:, groups.INVERSE] = velocities, 1 / given.masses
        bodies.spin[:, 2 if d == 2 else slice(3)] = spins
        bodies.spin[:, groups.INVERSE] = 1 / given.inertia
        self.walls, self.lists = self._walls(), self._lists(GROUP)
        self.renew()

    @property
    def world(self) -> World:
        """The arrays of the loops in the present order of memory."""
        return World(self.bodies, self.box, self.lists, self.walls)

    def find_forces(self, time: float) -> None:
        """Compute the forces at the start."""
        self.worker.run(find_forces, time, self.given.law, self.world, self.noted, self.rooms)
        self.forget_taken()
        self._check_forces()

    def forget_taken(self) -> None:
        """Set the momentum taken by surfaces to zero."""
        self.rooms.taken[:] = 0

    def taken(self) -> Array:
        """Forces on surfaces, (surfaces, 3), summed over steps: rows, then bodies of others."""
        return np.asarray(in_numbers(all_taken(self.rooms.taken)) * self.given.law.quantum)

    def run(self, step: int, steps: int) -> None:
        """Do `steps` steps after step number `step`; 0 only loads the compiled loops.

        Raises RunError where forces are beyond all bounds.
        """
        done = 0
        # The loops return early with forces pending when lists are outdated; then lists are made
        # at the places of t + dt, and the next call begins with the forces there.
        self.noted[:, groups.PENDING] = 0.0
        while done < steps or steps == 0:
            self.worker.run(advance, *self._arguments(step + done, steps - done))
            done += int(self.noted[0, groups.DONE])
            self._check_forces()
            if self.noted[0, groups.PENDING]:
                self.renew()
            if steps == 0:
                return

    def _arguments(self, step: int, steps: int) -> tuple[Any, ...]:
        given, counter = self.given, Counter(np.uint64(self.given.seed), np.uint64(step))
        law, motion, world, rooms = self._packing(given.law, given.motion, self.world, self.rooms)
        return counter, steps, law, motion, world, self.noted, rooms

    def _check_forces(self) -> None:
        nearest = np.sqrt(self.noted.view(np.int64)[:, groups.NEAREST].view(np.float64).min())
        if nearest < self.given.nearest:
            raise RunError(
                f"two spheres, or a sphere and a wall, are {nearest:.3g} apart: the force is "
                "beyond all bounds; expected a shorter timestep, or a start without overlaps"
            )
        if self.noted[:, groups.LARGEST].max() > 2.0**61:
            raise RunError(
                "a force of a contact is beyond all bounds; expected a shorter timestep, or a "
                "start without overlaps"
            )

    # --- lists ------------------------------------------------------------------------------------

    def renew(self) -> None:
        """Sort spheres by cells, and make neighbour lists."""
        bodies, spare = self.bodies, self.spare
        if not np.isfinite(bodies.place).all():
            raise RunError("places are no numbers any more; expected a shorter timestep")
        if math.isfinite(self.given.fastest):
            self._require_followed()
        self._require_inside()
        sort(self.grid, bodies.place, self.cell, self.begins, self.order)
        for old, new in zip(bodies, spare, strict=True):
            np.take(old, self.order, axis=0, out=new, mode="clip")
        self.bodies, self.spare = spare, bodies
        self.lists, self.old = self.old, self.lists
        self._sort_walls()
        columns = np.zeros((4, self.n + GROUP))
        columns[:, : self.n] = self.bodies.place.T
        while True:
            memory = self.bodies, self.box, self.lists, self.scratch
            self.worker.run(make_lists, self.grid, self.begins, columns, *memory)
            longest = int(self.lists.count.max())
            if longest < self.lists.near.shape[1]:  # one place is written beyond the end
                break
            self.lists = self._lists(longest + GROUP)
        if self.given.halves:
            self._carry_springs()

    def _require_followed(self) -> None:
        """Raise RunError for a sphere so fast that its contact with one at rest has few steps."""
        v, given = self.bodies.velocity[:, :3], self.given
        if not len(given.rows) and given.others is None:
            v = v - v.mean(axis=0)
        fastest = math.sqrt(float(np.einsum("ij,ij->i", v, v).max()))
        if fastest > given.fastest:
            raise RunError(
                f"a sphere moves at {fastest:.3g}: with a timestep of {given.motion.step:.3g} "
                f"contacts take less than ten steps above {given.fastest:.3g}; expected a shorter "
                "spheres.timestep, or a larger spheres.speed, from which that follows"
            )

    def _require_inside(self) -> None:
        """Raise RunError for a sphere whose centre lies behind a plane wall."""
        places = self.bodies.place[:, :3]
        for row in self.given.rows:
            if row[KIND] != PLANE:
                continue
            inside = (places - row[PLACE : PLACE + 3]) @ row[AXIS : AXIS + 3] + row[AMPLITUDE]
            if inside.min() < 0:
                raise RunError(
                    f"the centre of a sphere has passed a wall by {-float(inside.min()):.3g}: "
                    "contacts are too soft for what falls or moves; expected shorter contacts"
                )

    def _carry_springs(self) -> None:
        lists = self.lists
        np.cumsum(lists.own[:-1], out=lists.begin[1:])
        contacts = int(lists.own.sum())
        if len(lists.springs) < contacts:
            springs = np.zeros((contacts + contacts // 8, self.given.width))
            self.lists = lists._replace(springs=springs)
        self.worker.run(carry_springs, self.order, self.old, self.lists)

    def _sort_walls(self) -> None:
        walls, order = self.walls, self.order

        def ordered(springs: Array) -> Array:
            return self._of_each(springs)[order].reshape(springs.shape)

        if self.given.others is not None:
            solid = walls.solid
            terms, beside = solid.terms[order], ordered(solid.springs)
            walls = walls._replace(solid=solid._replace(terms=terms, springs=beside))
        self.walls = walls._replace(springs=ordered(walls.springs))

    def _of_each(self, springs: Array) -> Array:
        """Springs of contacts with walls, sphere by sphere."""
        return springs.reshape(self.n, len(springs) // self.n, springs.shape[1])

    # --- reading ----------------------------------------------------------------------------------

    def by_number(self, rows: NDArray[Any]) -> NDArray[Any]:
        """Rows in the order of memory, by particle number."""
        return by_number(self.bodies.number, rows)

    def readings(self, time: float) -> NDArray[np.int64]:
        """Readings of every sphere, by number, in quanta; see `acting.measure`."""
        readings = np.zeros((self.n, groups.READINGS), np.int64)
        self.worker.run(measure_all, time, self.given.law, self.world, readings)
        return self.by_number(readings)

    def state(self) -> dict[str, NDArray[Any]]:
        """All arrays that the next step depends on, by particle number."""
        bodies = self.bodies
        found = {name: self.by_number(getattr(bodies, name)[:, :3]) for name in KEPT}
        if self.given.width:
            found["pairs"], found["springs"] = pairs_of(self.lists, bodies.number)
            found["wall_springs"] = self.by_number(self._of_each(self.walls.springs))
        if self.given.others is not None:
            found["solid_terms"] = self.by_number(self.walls.solid.terms)
            found["solid_springs"] = self.by_number(self._of_each(self.walls.solid.springs))
        if self.rooms.taken.size:
            found["taken"] = all_taken(self.rooms.taken)
        return found

    def restore(self, state: dict[str, NDArray[Any]]) -> None:
        """Continue from a state."""
        bodies, given = self.bodies, self.given
        bodies.number[:] = np.arange(self.n)
        bodies.place[:, groups.REACH] = given.reach
        bodies.velocity[:, groups.INVERSE] = 1 / given.masses
        bodies.spin[:, groups.INVERSE] = 1 / given.inertia
        for name in KEPT:
            getattr(bodies, name)[:, :3] = state[name]
        self.walls, self.lists = self._walls(), self._lists(GROUP)
        if given.width:
            self._of_each(self.walls.springs)[:] = state["wall_springs"]
        if given.others is not None:
            self.walls.solid.terms[:] = state["solid_terms"]
            self._of_each(self.walls.solid.springs)[:] = state["solid_springs"]
        self.forget_taken()
        if self.rooms.taken.size:
            self.rooms.taken[0] = state["taken"]
        self.renew()
        if given.width:
            remember(self.lists, self.bodies.number, state["pairs"], state["springs"])


def _box(given: SoftSetup) -> Box:
    size = [*given.size, 1.0, 1.0][:3]
    shut = [*given.closed, True, True][:3]
    return Box(_three(size), _three(inverse_lengths(size, shut)))


def _three(numbers: Any, kind: type = float) -> tuple[Any, Any, Any]:
    x, y, z = (kind(number) for number in numbers)
    return x, y, z


def _grid(given: SoftSetup, box: Box) -> Grid:
    """Cells of half the length that lists reach, of which five lie along an axis at least; or of
    all of it, three at least; or one."""
    d, reach = len(given.size), 2 * float(given.reach.max()) + given.skin
    least = (float(np.prod(given.size)) / CELLS) ** (1 / d)
    cells, wide = [1, 1, 1], [0, 0, 0]
    for k, length in enumerate(given.size):
        for width in (1, 2):
            number = int(length / max(reach / width * ROUNDING, least))
            if number >= 2 * width + 1:
                cells[k], wide[k] = number, width
    inverse = [number / length for number, length in zip(cells, box.size, strict=True)]
    return Grid(_three(cells, int), _three(inverse), _three(wide, int), (reach * ROUNDING) ** 2)


def _bodies(n: int) -> Bodies:
    place, velocity, seen, spin = (np.zeros((n, 4)) for _ in range(4))
    force, torque = np.zeros((n, 3), np.int64), np.zeros((n, 3), np.int64)
    images, number = np.zeros((n, 3), np.int32), np.zeros(n, np.int64)
    return Bodies(place, velocity, seen, spin, force, torque, images, number)
