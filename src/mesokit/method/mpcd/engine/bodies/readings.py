"""Readings of bodies for observables, their state for checkpoints, and what stops a run."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.box import fold
from mesokit.errors import RunError
from mesokit.kernels.kernel import kernel
from mesokit.loops.threads import Worker
from mesokit.method.mpcd.body.protocol import named
from mesokit.method.mpcd.engine.beads.interactions import first_fault
from mesokit.method.mpcd.engine.bodies import state
from mesokit.method.mpcd.engine.bodies.allocate import masses_of
from mesokit.method.mpcd.engine.bodies.near import (
    LISTS_HOLD,
    PARTNERS_HOLD,
    bodies_near,
    body_near,
    cell_of,
    farthest_gap,
    list_by_cells,
    list_of,
)
from mesokit.method.mpcd.engine.bodies.state import (
    ANGLE,
    BOXES,
    CAUGHT,
    FORCE,
    FOUR,
    HOME,
    PATH,
    PLACE,
    PUT_BACK,
    RADIUS,
    RANGE,
    SECOND_HITS,
    SPIN,
    STILL_HITTING,
    TORQUE,
    TURN,
    VELOCITY,
    image_near,
    is_nearer,
    load,
    of_kind,
)
from mesokit.method.mpcd.engine.embedded.state import STEP, WHAT, WHICH
from mesokit.scalar.jit import seldom
from mesokit.scalar.vector import added_scaled, dot, row, scaled

Floats = NDArray[np.float64]
ALONE = Worker(0, 1, np.zeros(1, np.int64), np.zeros(1, np.int64))
MAKE_LISTS = 1e9  # a path after which lists are made anew
KEPT = {  # what a checkpoint holds, with the columns that it takes
    "place": (PLACE, 3),
    "turn": (TURN, 4),
    "velocity": (VELOCITY, 3),
    "spin": (SPIN, 3),
    "boxes": (BOXES, 3),
    "angle": (ANGLE, 3),
    "force": (FORCE, 3),
    "torque": (TORQUE, 3),
    "home": (HOME, 3),
}


class BodyReadings:
    """The bodies of a fluid in memory, by their numbers from 0, kind after kind."""

    def __init__(
        self, memory: Any, reduced: Callable[[Any], Any] = lambda numbers: numbers
    ) -> None:
        self.reduced = reduced  # sums over all ranks
        self.memory, self.case = memory, memory.numbers.case
        self.dimension, self.state_of = memory.numbers.dimension, memory.bodies
        self.names = [one.name for one in named(self.case.bodies)]
        self.kinds: NDArray[np.int64] = self.state_of.kind
        self.masses: Floats = masses_of(self.case)[self.kinds]
        self._listed: Floats | None = None  # places and orientations of which there are lists

    @property
    def number(self) -> int:
        """How many bodies."""
        return len(self.kinds)

    def _columns(self, first: int, number: int | None = None) -> Floats:
        number = self.dimension if number is None else number
        return np.array(self.state_of.rows[:, first : first + number])

    def places(self, unwrapped: bool = False) -> Floats:
        """Centres of mass (bodies, d), in the box or as if it had no bounds."""
        x = self._columns(PLACE)
        if unwrapped:
            boxes, box = self._columns(BOXES), self.memory.box
            x = x + boxes * self.memory.numbers.box
            if isinstance(box, state.SLIDING):
                x[:, 0] += boxes[:, 1] * box.offset
        return x

    @property
    def homes(self) -> Floats:
        """Where the springs of traps are fixed (bodies, d)."""
        return self._columns(HOME)

    @property
    def images(self) -> NDArray[np.int32]:
        """Boxes that each is away (bodies, d)."""
        return self._columns(BOXES).astype(np.int32)

    @property
    def velocities(self) -> Floats:
        """Velocities (bodies, d)."""
        return self._columns(VELOCITY)

    @property
    def spins(self) -> Floats:
        """Angular velocities (bodies, 3); in 2D along z."""
        return self._columns(SPIN, 3)

    @property
    def orientations(self) -> Floats:
        """Unit quaternions w, x, y, z (bodies, 4)."""
        return self._columns(TURN, 4)

    @property
    def headings(self) -> Floats:
        """The axis x of each body (bodies, d)."""
        w, x, y, z = self.orientations.T
        axis = [w * w + x * x - y * y - z * z, 2 * (x * y + w * z), 2 * (x * z - w * y)]
        return np.stack(axis[: self.dimension], axis=1)

    @property
    def angles(self) -> Floats:
        """Angular velocities, summed over time (bodies, 3): how far each has rotated."""
        return self._columns(ANGLE, 3)

    @property
    def forces(self) -> Floats:
        """Forces of the last timestep (bodies, d), of the fluid and of all else."""
        return self._columns(FORCE)

    @property
    def torques(self) -> Floats:
        """Torques of the last timestep (bodies, 3)."""
        return self._columns(TORQUE, 3)

    def counts(self) -> dict[str, int]:
        """Of the last step: second hits, particles put back, and those that hit in the last
        round, after which they fly on freely."""
        counters = self.state_of.counters[:, [SECOND_HITS, PUT_BACK, STILL_HITTING]].sum(axis=0)
        second, put_back, still = self.reduced(counters).tolist()
        return {"second hits": second, "put back": put_back, "still hitting": still}

    def forget_lists(self) -> None:
        """Lists are made anew at the next step."""
        self.state_of.rows[:, PATH] = MAKE_LISTS

    def inertia(self, kind: int) -> Floats:
        """Of a kind, in its own frame (3, 3)."""
        solid = self.case.bodies[kind].solid(self.dimension)
        found: Floats = masses_of(self.case)[kind] / solid.volume * solid.moments
        return found

    def in_own_frame(self, vectors: Floats) -> Floats:
        """Vectors (bodies, 3) along the axes of each body."""
        w, u = self.orientations[:, :1], -self.orientations[:, 1:]
        twist = 2.0 * np.cross(u, vectors)
        rotated: Floats = vectors + w * twist + np.cross(u, twist)
        return rotated

    def motion(self) -> Floats:
        """Momentum and twice the kinetic energy, that of rotation included (d + 1,)."""
        v, m = self.velocities, self.masses
        own, energy = self.in_own_frame(self.spins), 0.0
        for kind in range(len(self.case.bodies)):
            some = own[self.kinds == kind]
            energy += float(np.einsum("ni,ij,nj->", some, self.inertia(kind), some))
        return np.append(m @ v, m @ (v**2).sum(axis=1) + energy)

    def begin(self, places: Floats, turns: Floats, velocities: Floats, spins: Floats) -> None:
        """Give the bodies their first state."""
        rows, d = self.state_of.rows, self.dimension
        rows[:, PLACE : PLACE + d] = rows[:, HOME : HOME + d] = places
        for kind, given in enumerate(self.case.bodies):
            if given.trap is not None and given.trap.centre is not None:
                rows[self.kinds == kind, HOME : HOME + d] = given.trap.centre
        rows[:, TURN : TURN + 4] = rows[:, state.END_TURN : state.END_TURN + 4] = turns
        rows[:, VELOCITY : VELOCITY + d], rows[:, SPIN : SPIN + 3] = velocities, spins
        rows[:, PATH], self._listed = MAKE_LISTS, None

    def inside(self, places: Floats, part: float = 0.0) -> NDArray[np.bool_]:
        """Which of places (n, d) are in a body, or nearer to one than this part of its range."""
        found, zero = np.zeros(len(places), bool), self.memory.physics.zero
        here = self.state_of.rows[:, PLACE : TURN + 4].copy()
        anew = self._listed is None or not np.array_equal(here, self._listed)
        asked = np.ascontiguousarray(places), part, anew
        mark_inside(ALONE, self.memory.box, self.state_of, zero, asked, found)
        self._listed = here
        return found

    def state(self) -> dict[str, NDArray[Any]]:
        """All that the next step depends on."""
        return {
            f"body_{name}": self._columns(first, number) for name, (first, number) in KEPT.items()
        }

    def restore(self, given: dict[str, NDArray[Any]]) -> None:
        """Go on from `state()`."""
        rows = self.state_of.rows
        for name, (first, number) in KEPT.items():
            rows[:, first : first + number] = given[f"body_{name}"]
        rows[:, state.END_TURN : state.END_TURN + 4] = rows[:, TURN : TURN + 4]
        rows[:, PATH], self._listed = MAKE_LISTS, None
        self.state_of.counters[:] = self.state_of.faults[:] = 0

    def check(self) -> None:
        """That all bodies could be followed in the last steps. Raises RunError."""
        if (found := first_fault(self.state_of.faults)) is None:
            return
        step, what, which = found
        if what == CAUGHT:
            raise RunError(
                f"step {step}: particle {which - 1} is caught between bodies; expected a longer "
                "bodies.interaction.range"
            )
        if what == state.TOO_FAST:
            raise RunError(f"step {step}: {self._too_fast(step, which)}")
        raise RunError(
            f"step {step}: twice as many particles at bodies as there are in equilibrium; expected "
            "a fluid that is not so dense there"
        )

    def _too_fast(self, step: int, which: int) -> str:
        """What is said of a body, by its number from 1, that has gone too far in a step."""
        noted = self.state_of.faults[:, [STEP, WHAT, WHICH]] == [step, state.TOO_FAST, which]
        speed = self.state_of.faults[noted.all(axis=1)][0, state.SPEED] * state.MILLIONTH
        kind = self.kinds[which - 1]
        number = which - int(np.searchsorted(self.kinds, kind))
        path, most = speed * self.case.fluid.timestep, PARTNERS_HOLD - LISTS_HOLD
        return (
            f"body {number} of {self.names[kind]} goes {path:.3g} cells in a timestep, at a speed "
            f"of {speed:.4g}; expected at most {most:.3g}, or gaps may be missed: a shorter "
            "fluid.timestep, weaker forces or a smaller swim.B1"
        )


@kernel
def mark_inside(worker, box, bodies, zero, asked, found):
    """Note which places are in a body, or nearer to one than a part of its range; `asked` has both,
    and whether lists are to be made."""
    places, part, anew = asked
    if anew:
        list_by_cells(worker, box, bodies, zero)
    reach = part * farthest_gap(bodies)
    for n in range(len(places)):
        r = row(places, n, zero)
        r, _, _ = fold(box, r, zero, scaled(0.0, zero))
        cell = list_of(bodies, np.int64(cell_of(bodies, box, r)), reach)
        for k in range(bodies_near(bodies, cell)):
            i = body_near(bodies, cell, k)
            gap = part * of_kind(bodies, i, RANGE)
            found[n] |= is_within(box, bodies, i, r, gap)


@seldom
def is_within(box, bodies, i, r, gap):
    """Whether a place is nearer to body i than a gap, or in it."""
    x, _ = image_near(box, load(bodies.rows, i, PLACE, r), r)
    s, reach = added_scaled(r, -1.0, x), of_kind(bodies, i, RADIUS) + gap
    if dot(s, s) >= reach * reach:
        return False
    return is_nearer(bodies, bodies.kind[i], load(bodies.rows, i, TURN, FOUR), s, gap)
