"""Virtual particles in memory: the cells that surfaces cut, and what fills them at this step."""

from typing import Any, NamedTuple

from mesokit.method.mpcd.engine.cpu.physics import field_of

KINDS = 1024  # masses to draw from, in a mixture
MOST = 2**20  # of one cell: so far apart are the numbers of the first particles of two cells


class VirtualParticles(NamedTuple):
    """Tables and memory of the virtual particles; arrays, `threads` first where each has its own.

    density: particles per cell.
    starts (offsets + 1,), cells, corners (entries, d): cut cells for each offset of the grid, and
    their lower corners in the grid; keys: their numbers in the whole box, for random numbers.
    `cells` and `keys` go on for a batch, so that batches may end anywhere.
    pieces: number of the piece of surface in each cell of the box, or -1.
    outward, probes (pieces, d): its normal, and where first to look for fluid; terms (pieces,).
    rates (pieces, columns): what is known of the flow there.
    masses: those of mixtures.
    data, cell, number, term (threads, ...), filled (threads,): the virtual particles of this step.
    per_cell: CellParticles, or () where they come one by one.
    seen: FlowAtSurface, or () where all cells are those of one rank.
    """

    density: float
    starts: Any
    cells: Any
    keys: Any
    corners: Any
    pieces: Any
    outward: Any
    probes: Any
    terms: Any
    rates: Any
    masses: Any
    data: Any
    cell: Any
    number: Any
    term: Any
    filled: Any
    per_cell: Any
    seen: Any


class FlowAtSurface(NamedTuple):
    """The flow at pieces of surface that one rank of several measures and sends to its partners.

    limits: its block of cells, as two tuples of floats. here (pieces here,): pieces near it.
    step (pieces, PROBES), values (pieces, PROBES, d + 1): last step with a value of a probe, and
    the value.
    given_starts (partners + 1,), given: the pieces near the block of each partner.
    """

    limits: tuple
    here: Any
    step: Any
    values: Any
    given_starts: Any
    given: Any


class CellParticles(NamedTuple):
    """Planes of the cut cells, and the virtual particles of this step; a row for each cell.

    normals (d * entries,), heights (entries,): of the middle of the cell over the surface, at the
    middle of the interval of offsets; places (d * entries,): that middle, in the box.
    terms, pieces (entries,): the surface, and the piece of it.
    work (threads, ROWS * SCRATCH_ROW): the numbers of a batch, in rows.
    state (threads, entries, 3 d + 1): velocity, velocity kept for the collision, place, mass.
    entry (threads, entries), filled (threads,).
    """

    normals: Any
    heights: Any
    places: Any
    terms: Any
    pieces: Any
    work: Any
    state: Any
    entry: Any
    filled: Any


def has_gradient(walls: Any) -> bool:
    """Whether virtual particles move as the fluid's profile would go on, from the same type."""
    return len(field_of(walls, "gradient")) > 0


def drawn_per_cell(walls: Any) -> bool:
    """Whether those of a cell are drawn all at once, from the numba type of `Walls`."""
    per_cell = field_of(field_of(walls, "virtual"), "per_cell")
    return getattr(per_cell, "instance_class", None) is CellParticles
