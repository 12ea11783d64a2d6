"""Soft spheres in memory: sorting, neighbour lists, steps and reading by particle number."""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import RunError
from mesokit.kernels.packing import Packing
from mesokit.loops.neighbours import GAP
from mesokit.method.spheres.common.contacts.groups import INVERSE, NEVER, REACH, WITHIN_THREAD
from mesokit.method.spheres.common.contacts.listed import Listed, ListedSpheres, Others
from mesokit.method.spheres.common.contacts.now import COLUMNS
from mesokit.method.spheres.common.contacts.remembered import pairs_of, remember
from mesokit.method.spheres.common.contacts.taken import all_taken, in_numbers
from mesokit.method.spheres.common.walls import AMPLITUDE, AXIS, KIND, PLACE, PLANE, SPEED
from mesokit.method.spheres.soft.engine import groups
from mesokit.method.spheres.soft.engine.acting import measure_all
from mesokit.method.spheres.soft.engine.contact.collect import Rows, collect_all
from mesokit.method.spheres.soft.engine.contact.room import rooms
from mesokit.method.spheres.soft.engine.groups import Bodies, Motion, World
from mesokit.method.spheres.soft.engine.step import advance, find_forces
from mesokit.scalar.random import Counter
from mesokit.seam.engine import Array

KEPT = ("place", "velocity", "spin", "force", "torque", "images")  # arrays in checkpoints


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


def _bodies(n: int) -> Bodies:
    place, velocity, seen, spin = (np.zeros((n, 4)) for _ in range(4))
    force, torque = np.zeros((n, 3), np.int64), np.zeros((n, 3), np.int64)
    images, number = np.zeros((n, 3), np.int32), np.zeros(n, np.int64)
    return Bodies(place, velocity, seen, spin, force, torque, images, number)


def _listed(given: SoftSetup) -> Listed:
    once = WITHIN_THREAD if given.halves else NEVER
    lists = given.size, given.closed, given.reach, given.skin, once, given.width
    return Listed(*lists, given.rows, given.own, given.others)


class SoftSystem(ListedSpheres):
    """Soft spheres in a box, their neighbour lists, and the threads that move them."""

    def make_bodies(self, n: int) -> Bodies:
        return _bodies(n)

    def __init__(self, given: SoftSetup, threads: int) -> None:
        super().__init__(_listed(given), threads)
        self.given, self._packing = given, Packing()
        self.noted = np.zeros((threads, GAP))
        surfaces = len(given.rows) + (0 if given.others is None else len(given.others.own))
        self.rooms = rooms(threads, surfaces)
        self.noted.view(np.int64)[:, groups.NEAREST] = np.float64(np.inf).view(np.int64)
        self.worker.compile_ahead(advance, *self._arguments(0, 0))

    # --- start and steps --------------------------------------------------------------------------

    def fill(self, places: Array, velocities: Array, spins: Array) -> None:
        """Put spheres at these places (n, d), with velocities (n, d) and spins ((n,) or (n, 3))."""
        given, bodies, d = self.given, self.bodies, self.dimension
        inside, images = self.inside(places)
        for array in bodies:
            array[:] = 0
        bodies.number[:] = np.arange(self.n)
        bodies.place[:, :d], bodies.place[:, REACH] = inside, given.reach
        bodies.images[:, :d] = images
        bodies.velocity[:, :d], bodies.velocity[:, INVERSE] = velocities, 1 / given.masses
        bodies.spin[:, 2 if d == 2 else slice(3)] = spins
        bodies.spin[:, INVERSE] = 1 / given.inertia
        self.forget_contacts()
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
        """Sort spheres by cells, and make neighbour lists. Raises RunError for lost spheres."""
        if math.isfinite(self.given.fastest):
            self._require_followed()
        self._require_inside()
        super().renew()

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
            if row[KIND] != PLANE or row[SPEED] < 0:
                continue
            inside = (places - row[PLACE : PLACE + 3]) @ row[AXIS : AXIS + 3] + row[AMPLITUDE]
            if inside.min() < 0:
                raise RunError(
                    f"the centre of a sphere has passed a wall by {-float(inside.min()):.3g}: "
                    "contacts are too soft for what falls or moves; expected shorter contacts"
                )

    # --- reading ----------------------------------------------------------------------------------

    def readings(self, time: float) -> NDArray[np.int64]:
        """Readings of every sphere, by number, in quanta; see `acting.measure`."""
        readings = np.zeros((self.n, groups.READINGS), np.int64)
        self.worker.run(measure_all, time, self.given.law, self.world, readings)
        return self.by_number(readings)

    def contacts(self, time: float) -> tuple[NDArray[np.int64], Array]:
        """Pairs (m, 2) and values (m, 10) of all contacts, in no order; see `collect.Rows`."""
        readings = np.zeros((self.n, groups.READINGS), np.int64)
        self.worker.run(measure_all, time, self.given.law, self.world, readings)
        # A sphere writes no more rows than it has contacts; rows that it leaves out stay -1.
        touching = readings[:, groups.TOUCHING]
        begin, m = np.cumsum(touching) - touching, int(touching.sum())
        rows = Rows(begin, np.full((m, 2), -1, np.int64), np.zeros((m, COLUMNS)))
        self.worker.run(collect_all, time, self.given.law, self.world, rows)
        written = rows.pairs[:, 0] >= 0
        return rows.pairs[written], rows.values[written]

    def state(self) -> dict[str, NDArray[Any]]:
        """All arrays that the next step depends on, by particle number."""
        bodies = self.bodies
        found = {name: self.by_number(getattr(bodies, name)[:, :3]) for name in KEPT}
        if self.given.width:
            found["pairs"], found["springs"] = pairs_of(self.lists, bodies.number)
        found |= self.remembered_at_walls()
        if self.rooms.taken.size:
            found["taken"] = all_taken(self.rooms.taken)
        return found

    def restore(self, state: dict[str, NDArray[Any]]) -> None:
        """Continue from a state."""
        bodies, given = self.bodies, self.given
        bodies.number[:] = np.arange(self.n)
        bodies.place[:, REACH] = given.reach
        bodies.velocity[:, INVERSE] = 1 / given.masses
        bodies.spin[:, INVERSE] = 1 / given.inertia
        for name in KEPT:
            getattr(bodies, name)[:, :3] = state[name]
        self.forget_contacts()
        self.remember_at_walls(state)
        self.forget_taken()
        if self.rooms.taken.size:
            self.rooms.taken[0] = state["taken"]
        self.renew()
        if given.width:
            remember(self.lists, self.bodies.number, state["pairs"], state["springs"])
