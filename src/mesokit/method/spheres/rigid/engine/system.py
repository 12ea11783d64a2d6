"""Rigid grains in memory: contacts, sweeps, and reading by particle number."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.shear.protocol import slid
from mesokit.kernels.packing import Packing
from mesokit.loops.layout import zeros
from mesokit.method.spheres.common.contacts.groups import REACH, SlidBox
from mesokit.method.spheres.common.contacts.listed import ListedSpheres
from mesokit.method.spheres.common.contacts.now import COLUMNS
from mesokit.method.spheres.common.contacts.remembered import pairs_of, remember
from mesokit.method.spheres.common.contacts.taken import WIDTH, all_taken, in_numbers
from mesokit.method.spheres.rigid.engine.collect import Rows, collect, find_deepest
from mesokit.method.spheres.rigid.engine.groups import (
    CONTACT,
    DONE,
    INVERSE,
    MEAN,
    MOST_COLOURS,
    MOTION,
    NO_ROOM,
    NOTED,
    OLD_LISTS,
    RATIO,
    ROLL,
    SPIN,
    STEPS,
    SWEEPS,
    TOO_FAST,
    WHY,
    Bodies,
    Found,
    Order,
    Plates,
    Rules,
    Sums,
    World,
)
from mesokit.method.spheres.rigid.engine.sliding import AtRest
from mesokit.method.spheres.rigid.engine.step import advance
from mesokit.method.spheres.rigid.setup import RigidSetup
from mesokit.scalar.random import Counter
from mesokit.seam.engine import Array

FIRST_ROOM = 3  # contacts of a grain for which there is room at first
GROWTH = 1.5


class RigidSystem(ListedSpheres):
    """Rigid grains in a box, their contacts, and the threads that move them."""

    def __init__(self, given: RigidSetup, threads: int) -> None:
        self.given, self._packing = given, Packing()
        n, d = len(given.masses), len(given.listed.size)
        self.most = FIRST_ROOM * n // threads + 64
        self._rows = n + self.most * threads + len(given.listed.rows)
        self._whole: dict[int, Array] = {}
        super().__init__(given.listed, threads)
        self.flat, self.made_at = (0.0,) * d, 0.0
        self.noted = np.zeros((threads, NOTED))
        self.plates = np.zeros((len(given.listed.rows), 2))
        others = given.listed.others
        self.surfaces = len(given.listed.rows) + (0 if others is None else len(others.own))
        self.taken_sums = zeros((threads, self.surfaces + 1, WIDTH), np.int64)
        self.before = zeros((self._rows, MOTION[d]))
        self.found, self.order_of = self._found(), self._order()
        self.worker.compile_ahead(advance, *self._arguments(0, 0))

    def make_bodies(self, n: int) -> Bodies:
        """Memory for grains; that of motion has more rows, for walls that contacts are with."""
        d = len(self.given.listed.size)
        whole = zeros((self._rows, MOTION[d]))
        motion = whole[:n]
        self._whole[motion.ctypes.data] = whole
        images, number = np.zeros((n, 3), np.int32), np.zeros(n, np.int64)
        return Bodies(np.zeros((n, 4)), motion, images, number)

    def _found(self) -> Found:
        most, d = self.most * self.worker.size, self.dimension
        rolls = most if self.given.law.rolling > 0 else 0
        return Found(
            np.full((most, 2), -1, np.int64),
            np.zeros((most, 2), np.int64),
            np.zeros(most, np.int64),
            zeros((most, CONTACT[d])),
            np.zeros((most, 2)),
            zeros((rolls, ROLL)),
        )

    def _order(self) -> Order:
        most, d, n = self.most * self.worker.size, self.dimension, self.n
        rolls = most if self.given.law.rolling > 0 else 0
        at, by_number, colour = (np.zeros(most, np.int64) for _ in range(3))
        return Order(
            np.zeros((most, 2), np.int32),
            np.zeros(most, np.int64),
            zeros((most, CONTACT[d])),
            np.zeros((most, 2)),
            zeros((rolls, ROLL)),
            at,
            by_number,
            colour,
            np.zeros(n + 1, np.int64),
            np.zeros(n, np.int64),
            np.zeros(MOST_COLOURS + 2, np.int64),
            np.zeros(most, np.int64),
            zeros((most, 4)),
        )

    def _grow(self) -> None:
        """Make room for more contacts."""
        self.most = int(GROWTH * self.most) + 1
        rows = len(self.given.listed.rows)
        self._rows, self._whole = self.n + self.most * self.worker.size + rows, {}
        bodies, spare = self.make_bodies(self.n), self.make_bodies(self.n)
        for name in bodies._fields:
            getattr(bodies, name)[:] = getattr(self.bodies, name)
        self.bodies, self.spare = bodies, spare
        self.before = zeros((self._rows, MOTION[self.dimension]))
        self.found, self.order_of = self._found(), self._order()

    def box_of_lists(self) -> Any:
        return self.box_at(self.made_at)

    def box_at(self, time: float) -> Any:
        """The box as it is at a time."""
        shear = self.given.shear
        if isinstance(shear, AtRest):
            return self.box
        size, inverse = self.box
        return SlidBox(size, inverse, float(slid(shear.history, time)) % size[0], 0.0)

    # --- start and steps --------------------------------------------------------------------------

    def fill(self, places: Array, velocities: Array, spins: Array) -> None:
        """Put grains at these places (n, d), with velocities (n, d) and spins ((n,) or (n, 3))."""
        bodies, d = self.bodies, self.dimension
        inside, images = self.inside(places)
        for array in bodies:
            array[:] = 0
        bodies.number[:] = np.arange(self.n)
        bodies.place[:, :d], bodies.place[:, REACH] = inside, self.given.listed.reach
        bodies.images[:, :d] = images
        self._set_motion(velocities, np.reshape(spins, (self.n, -1)))
        self.plates[:] = 0
        self.forget_contacts()
        self.renew()

    def _set_motion(self, velocities: Array, spins: Array) -> None:
        """Velocities (n, d) and angular velocities (n, 1 or 3) by particle number, which is the
        order of memory now."""
        motion, d = self.bodies.motion, self.dimension
        motion[:, :d], motion[:, INVERSE] = velocities, 1 / self.given.masses
        motion[:, SPIN[d] : SPIN[d] + spins.shape[1]] = spins * self.given.listed.reach[:, None]

    @property
    def world(self) -> World:
        """The arrays of the loops in the present order of memory."""
        motion = self._whole[self.bodies.motion.ctypes.data]
        plates = Plates(self.plates, self.given.drive, self._rows - len(self.plates))
        return World(
            self.bodies, self.box, self.lists, self.walls, motion, self.before, plates, self.flat
        )

    def run(self, step: int, steps: int) -> int:
        """Do `steps` steps after step number `step`; 0 only loads the compiled loops.

        Returns how many it did: fewer before a grain so fast that contacts would be missed.
        """
        done = 0
        while done < steps or steps == 0:
            self.worker.run(advance, *self._arguments(step + done, steps - done))
            done += int(self.noted[0, DONE])
            why = self.noted[0, WHY]
            if why == TOO_FAST or steps == 0:
                break
            if why == OLD_LISTS:
                self.made_at = self.given.motion.step * (step + done)
                self.renew()
            if why == NO_ROOM:
                self._grow()
        return done

    def _arguments(self, step: int, steps: int) -> tuple[Any, ...]:
        given, counter = self.given, Counter(np.uint64(self.given.seed), np.uint64(step))
        motion = given.motion._replace(made=self.made_at)
        rules = Rules(given.law, given.solver, motion, given.shear)
        sums = Sums(self.noted, self.taken_sums)
        memory = rules, self.world, self.found, self.order_of, sums
        return counter, steps, *self._packing(*memory)

    def forget_sums(self) -> None:
        """Set the momentum taken by surfaces, and the energy lost, to zero."""
        self.taken_sums[:] = 0
        self.noted[:, STEPS] = 0.0

    def taken(self) -> Array:
        """Momentum that surfaces have taken, (surfaces, 3): rows, then bodies of others."""
        return np.asarray(in_numbers(all_taken(self.taken_sums))[:-1] * self.given.law.quantum)

    def lost(self) -> Array:
        """Energy that contacts have taken: by impact, friction and rolling."""
        quantum = self.given.law.energy_quantum
        return np.asarray(in_numbers(all_taken(self.taken_sums))[-1] * quantum)

    def last_solved(self) -> tuple[int, float, float, int]:
        """Of the last step: sweeps, largest change of an impulse in the last of them over the mean
        impulse, and this mean; and sweeps since the warm-up."""
        sweeps, ratio, mean, so_far = self.noted[0, [SWEEPS, RATIO, MEAN, STEPS]]
        return int(sweeps), float(ratio), float(mean), int(so_far)

    # --- reading ----------------------------------------------------------------------------------

    def contacts(self, time: float) -> tuple[NDArray[np.int64], Array]:
        """Pairs (m, 2) and values (m, 10) of all contacts with a force; see `collect.Rows`."""
        solid = self.walls.solid
        beside = () if self.listed.others is None else (solid.springs,)
        kept, pulled = (self._sprung(), self.walls.springs, *beside), self.given.law.pull > 0
        m = sum(len(a) if pulled else int(a.any(axis=1).sum()) for a in kept)
        rows = Rows(np.full((m, 2), -1, np.int64), np.zeros((m, COLUMNS)))
        world = self.world._replace(box=self.box_at(time))
        collect(self.given.law, self.given.motion.step, time, world, rows)
        written = rows.pairs[:, 0] >= 0  # a sphere may have left a solid since
        return rows.pairs[written], rows.values[written]

    def largest_overlap(self, time: float) -> float:
        """The largest overlap of two grains, or of one and a wall."""
        found = np.zeros(1)
        find_deepest(time, self.world._replace(box=self.box_at(time)), found)
        return -float(found[0])

    def _sprung(self) -> Array:
        """Impulses of pairs, (contacts, 3)."""
        return np.asarray(self.lists.springs[: int(self.lists.own.sum())])

    def state(self) -> dict[str, NDArray[Any]]:
        """All arrays that the next step depends on, by particle number."""
        bodies = self.bodies
        found = {
            "place": self.by_number(bodies.place[:, :3]),
            "motion": self.by_number(bodies.motion),
            "images": self.by_number(bodies.images),
            "plates": self.plates.copy(),
            "taken": all_taken(self.taken_sums),
            "solved": self.noted[0, [SWEEPS, RATIO, MEAN, STEPS]],
        }
        found["pairs"], found["springs"] = pairs_of(self.lists, bodies.number)
        return found | self.remembered_at_walls()

    def restore(self, state: dict[str, NDArray[Any]]) -> None:
        """Continue from a state."""
        bodies = self.bodies
        bodies.number[:] = np.arange(self.n)
        bodies.place[:, :3], bodies.place[:, REACH] = state["place"], self.given.listed.reach
        bodies.motion[:], bodies.images[:] = state["motion"], state["images"]
        self.forget_contacts()
        self.remember_at_walls(state)
        self.forget_sums()
        self.plates[:] = state["plates"]
        self.taken_sums[0] = state["taken"]
        self.noted[:, [SWEEPS, RATIO, MEAN, STEPS]] = state["solved"]
        self.renew()
        remember(self.lists, self.bodies.number, state["pairs"], state["springs"])
