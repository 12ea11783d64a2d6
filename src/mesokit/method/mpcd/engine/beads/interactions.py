"""The sums of a traversal over bonds, angles, pairs and walls: force, energy or virial.

The class of `action` picks one of these when the calling loop is compiled. Each adds its part to
`total`, a tuple: the force on a bead has as many numbers as there are axes, the energy one, and
the virial none, as it goes to memory.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import RunError
from mesokit.geometry.protocol import facing
from mesokit.method.mpcd.engine.cpu.bounce import add_recoil
from mesokit.method.mpcd.engine.cpu.stress import add_product
from mesokit.potential.angle import bend
from mesokit.potential.protocol import breaks, central
from mesokit.scalar.jit import by_type, generic, scalar
from mesokit.scalar.pointer import raise_to
from mesokit.scalar.vector import added, added_scaled, dot, scaled

STEP, FIRST, SECOND = 0, 1, 2  # what is noted, of each thread: its step, or 0, and two beads
SHARED = 2  # numbers that tell all threads the same
LATEST, BEAD_BITS = 1 << 62, 31  # of these: the first comes to be the largest


class BeadForce(NamedTuple):
    """The force on a bead.

    It is kept for a `time`, in which walls take the opposite momentum: `impulse`, in units of
    1 / scale. Broken bonds go to `faults` with the step and their beads, the first of which is 1.
    """

    time: float
    impulse: Any
    scale: float
    step: int
    faults: Any


class Energy(NamedTuple):
    """The energy, each bond, angle and pair counted once."""


class Virial(NamedTuple):
    """The vector between two beads times the impulse on the second in a time: (d, d) sums.

    Each bond, angle and pair is counted once. That of walls is left out.
    """

    time: float
    tensor: Any
    scale: float  # whole numbers per unit


@generic
def of_two(action, total, potential, separation, i, j):
    """The total with the part of beads i and j; `separation` leads from j to i. The pair comes a
    second time as j and i."""


@generic
def of_three(action, total, potential, before, after, role):
    """The total with the part of two bonds in a row, for the bead with that role: 0 the first, 2
    the last."""


@generic
def of_wall(action, total, potential, near_wall, r):
    """The total with the part of a bead at r and the nearest surface."""


@of_two.register(BeadForce)
def _(action, total, potential, separation, i, j):
    square = dot(separation, separation)
    _, force_over_r = central(potential, square)
    if breaks(potential, square):
        note_broken(action.faults, action.step, min(i, j) + 1, max(i, j) + 1)
    return added_scaled(total, force_over_r if j != i else 0.0, separation)


@of_three.register(BeadForce)
def _(action, total, potential, before, after, role):
    _, first, last = bend(potential, before, after)
    middle = scaled(-1.0, added(first, last))
    own = first if role == 0 else (last if role == 2 else middle)
    return added(total, own)


@of_wall.register(BeadForce)
def _(action, total, potential, near_wall, r):
    solid, reach = near_wall
    distance, out, surface, lever = facing(solid, reach, r)
    if distance >= reach:
        return total
    _, force_over_r = central(potential, distance * distance)
    force = scaled(force_over_r * distance, out)
    add_recoil(action.impulse, surface, lever, scaled(-action.time, force), action.scale)
    return added(total, force)


@of_two.register(Energy)
def _(action, total, potential, separation, i, j):
    energy, _ = central(potential, dot(separation, separation))
    return added(total, (energy if j > i else 0.0,))


@of_three.register(Energy)
def _(action, total, potential, before, after, role):
    energy, _, _ = bend(potential, before, after)
    return added(total, (energy if role == 1 else 0.0,))


@of_wall.register(Energy)
def _(action, total, potential, near_wall, r):
    solid, reach = near_wall
    distance, _, _, _ = facing(solid, reach, r)
    energy, _ = central(potential, distance * distance)
    return added(total, (energy,))


@of_two.register(Virial)
def _(action, total, potential, separation, i, j):
    if j > i:
        _, force_over_r = central(potential, dot(separation, separation))
        add_product(action.tensor, action.scale, action.time * force_over_r, separation, separation)
    return total


@of_three.register(Virial)
def _(action, total, potential, before, after, role):
    if role == 1:
        _, first, last = bend(potential, before, after)
        add_product(action.tensor, action.scale, -action.time, before, first)
        add_product(action.tensor, action.scale, action.time, after, last)
    return total


@of_wall.register(Virial)
def _(action, total, potential, near_wall, r):
    return total


@by_type
def note_broken(faults, step, one, other):
    """Note step and beads of the first bond that is longer than it can be (seldom called).

    `faults` is an array of one thread, or the address of two numbers that all threads share. Of
    the bonds of one step the first is that with the lowest numbers of beads.
    """
    from numba import types

    if isinstance(faults, types.Integer):
        return lambda faults, step, one, other: note_for_all(faults, step, one, other)
    return _note_own


def _note_own(faults, step, one, other):
    step, one, other = np.int64(step), np.int64(one), np.int64(other)
    earlier = faults[STEP] == 0 or step < faults[STEP]
    lower = one < faults[FIRST] or (one == faults[FIRST] and other < faults[SECOND])
    if earlier or (step == faults[STEP] and lower):
        faults[STEP], faults[FIRST], faults[SECOND] = step, one, other


@scalar
def note_for_all(faults, step, one, other):
    """Note a step and two numbers at the address of two, of which the first are kept."""
    present = LATEST - np.int64(step)
    if raise_to(faults, 0, present) <= present:
        raise_to(faults, 1, LATEST - (np.int64(one) << BEAD_BITS | np.int64(other)))


def shared_fault(noted: NDArray[np.int64]) -> tuple[int, int, int]:
    """Step and beads of the first bond, from the two numbers that threads share; 0 if none."""
    step, beads = (LATEST - int(number) if number else 0 for number in noted)
    return step, beads >> BEAD_BITS, beads & (1 << BEAD_BITS) - 1


def first_fault(faults: NDArray[np.int64]) -> tuple[int, int, int] | None:
    """The first of what the threads noted in the last steps: step, and two numbers; else None."""
    noted = faults[faults[:, STEP] > 0]
    return min(map(tuple, noted[:, :3].tolist()), default=None)


def refuse_broken(faults: NDArray[np.int64], longest: float, name: str, advice: str) -> None:
    """Raise RunError if a bond of those, as they are called, was broken in the last steps.

    `faults` has a row for each thread, `longest` is what no bond can reach.
    """
    if found := first_fault(faults):
        step, first, second = found
        raise RunError(
            f"step {step}: the bond of {name} {first} and {second} is longer than the "
            f"{longest:g} that it can be; {advice}"
        )
