"""The further memory of solutes that act on the fluid by a potential."""

from typing import Any, NamedTuple

from mesokit.method.mpcd.engine.cpu.physics import field_of

PARTNERS = 24  # beads that a particle of the fluid has on its list; with more it looks at all beads
ALL_BEADS = -1  # the length of a list that does not hold: the particle looks at all beads
COUNT = 0  # where a thread counts the particles near beads
# what is noted, of each thread: the step, or 0, and what went wrong
STEP, WHAT, WHICH = 0, 1, 2
TOO_FAR, TOO_HARD, TOO_MANY = 1, 2, 3


class Embedded(NamedTuple):
    """Beads in a fluid that they push away (or attract), and the particles near them.

    potential: of a bead and a particle, which ends at `reach`; skin: how far a bead may go in a
    timestep; travel: how far nearly all particles fly in one; further: what walls may add to that.
    grid: cells of the fluid, without shift; marked (cells + 1,): when something near a bead was
    last in each. lists: the cells of beads (`Neighbours`, whose lists are not made).
    lane, partners (threads, most): where each particle near a bead lies in the strips, and how
    many beads are near it; beads (threads, most * PARTNERS): which. r, v, start (threads,
    most * d): its place and velocity, and where the timestep began; bound (threads, most): how far
    it may go before other beads may be near. number (threads, GAP): how many there are.
    chosen (threads, LANES): scratch memory.
    taken (threads, beads * d): momentum that beads take from them, in whole numbers.
    faults (threads, 8): the first thing that went wrong.
    """

    potential: tuple
    reach: float
    skin: float
    travel: float
    further: float
    grid: tuple
    marked: Any
    lists: tuple
    lane: Any
    partners: Any
    beads: Any
    r: Any
    v: Any
    start: Any
    bound: Any
    number: Any
    chosen: Any
    taken: Any
    faults: Any


def is_embedded(beads: Any) -> bool:
    """Whether beads act by a potential, from the numba type of `Beads` or ()."""
    return len(beads) > 0 and len(field_of(beads, "embedded")) > 0


def collides(beads: Any) -> bool:
    """Whether beads take part in the collisions of the fluid, from the same."""
    return len(beads) > 0 and len(field_of(beads, "embedded")) == 0
