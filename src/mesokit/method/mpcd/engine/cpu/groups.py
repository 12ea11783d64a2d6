"""Named groups of what the stages of a step work on."""

from typing import Any, NamedTuple

from mesokit.kernels.group import by_address
from mesokit.method.mpcd.engine.cpu.grid import Grid
from mesokit.scalar.random import Counter

# What a stage is to do.
COLLIDE, STREAM, MEASURE_STRESS, MEASURE_WALLS = 1, 2, 4, 8


class Course(NamedTuple):
    """The steps to run, and the state in which the last ones ended."""

    steps: int
    done: int
    seed: int
    grid_shift: float  # largest displacement of the grid, in cells
    closed: tuple  # 1.0 for each axis along which walls end the box, else 0.0
    flags: int  # MEASURE_WALLS for all steps, MEASURE_STRESS for the last
    box: tuple
    grid: Grid


class Now(NamedTuple):
    """The step from t to t + dt that is being done."""

    counter: Counter  # of its random numbers
    box: tuple  # at t + dt
    old: Grid  # cells of the collision at t
    grid: Grid  # cells of the collision at t + dt
    flags: int


@by_address("filling")  # of ranks, whose particles come and go
class Particles(NamedTuple):
    """The fluid's particles, strip by strip (see `loops.layout`); lanes are counted through."""

    data: Any  # positions, velocities, and masses where they differ
    cell: Any  # (lanes,) number of each particle's cell
    ident: Any  # (lanes,) number of each particle
    image: Any  # (d, lanes) boxes that it is away along each axis
    filling: tuple  # how many lie in the strips
    rows: int  # numbers kept for each particle


class Cells(NamedTuple):
    """The collision cells; one more than there are takes what must not act. Slots of ghosts follow
    where ranks share cells."""

    number: int
    coefficients: Any  # a record for each cell: what its particles need to collide
    sums: Any  # (threads, ...) fixed-point sums over the particles of each cell
    neighbour_sums: tuple  # one of these sums in all cells, if the rule needs its gradient, or ()
    shared: Any  # with other ranks (`domains.messages.shared.Shared`), or ()


class Scratch(NamedTuple):
    """Memory of each thread for the strip, or the batch of cells, in hand: (threads, ...)."""

    coefficients: Any
    terms: Any
    marks: Any
    clear: Any  # square of the distance that each lane may fly in any direction
    beads: Any


class Taken(NamedTuple):
    """Sums of a step for observables, and faults."""

    impulse: Any  # (threads, ...) momentum and angular momentum that surfaces took
    tensor: Any  # (2 or 3, strips, 2 d^2) terms of the stress
    faults: Any  # (threads, 8) step and beads of the first bond that tore


class FluidMemory(NamedTuple):
    """A fluid in memory."""

    particles: Particles
    cells: Cells
    room: Any  # distance that is surely clear around all of a part of a strip
    scratch: Scratch
    taken: Taken


class Suspended(NamedTuple):
    """What moves in the fluid: beads of solutes, and bodies; () where there are none."""

    beads: Any
    bodies: Any


class Walls(NamedTuple):
    """Virtual particles, and by which rule: each field is () where there is none of it."""

    top_up: tuple  # (density,) where cells are filled up to the mean density
    gradient: tuple  # (1.0,) where they move as the fluid's profile would go on
    virtual: Any  # VirtualParticles
