"""Neighbour lists of beads, which hold until a bead has moved by half a skin.

A list is in the order of the beads' numbers and reaches beyond the potential: what it holds too
much adds nothing, so that forces have the same bits whenever it was made. A bead with more
neighbours than its list has room for looks at all beads.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from mesokit.case.box import SLIDING, fold
from mesokit.loops.cells import NOWHERE, cell_after, cell_of, cells_along, row_around
from mesokit.loops.layout import share
from mesokit.loops.neighbours import GAP, insert, nearest_image, outdated
from mesokit.loops.threads import barrier
from mesokit.method.mpcd.engine.beads.state import AROUND, OWN, bead_of, number_of
from mesokit.method.mpcd.engine.cpu.strips.rows import load_values, store_values
from mesokit.scalar.elementary import rint
from mesokit.scalar.intrinsics import floor, with_item
from mesokit.scalar.jit import by_type, scalar, seldom
from mesokit.scalar.pointer import element
from mesokit.scalar.vector import added_scaled, dot, scaled

CROWDED = -1  # the length of a list that did not fit
MOVED, OFFSET, MADE = 0, 1, 2  # places in `Neighbours.noted`


class Neighbours(NamedTuple):
    """Lists, and what they were made from.

    reach: how far the potential and the skin go; skin: how far the list goes beyond the potential;
    most: room of a list.
    cells (d,), inverse (d,): their number along each axis, and per length of the box.
    cell (beads,): of each bead; head (cells,), following (beads,): the beads of each cell, one
    leading to the next, -1 last.
    count (beads,), near (beads, most): the lists.
    made_at (beads, d), boxes (beads,): where beads were then, and in which image along y.
    noted (threads, GAP): of each thread, the square of the longest displacement of its beads, the
    offset of the images when the lists were made, and whether there are any.
    """

    reach: float
    skin: float
    most: int
    cells: tuple[int, ...]
    inverse: tuple[float, ...]
    cell: Any
    head: Any
    following: Any
    count: Any
    near: Any
    made_at: Any
    boxes: Any
    noted: Any


def lists_of(
    reach: float, skin: float, beads: int, most: int, box: Any, closed: Any, threads: int
) -> Neighbours:
    """Lists of at most so many beads, in a box (d,) with closed axes; without any, cells alone."""
    cells = [max(int(length / reach), 1) for length in box]
    cells = [n if n >= 3 or shut else 1 for n, shut in zip(cells, closed, strict=True)]
    if cells[1] == 1:  # images above and below may be displaced along x by any distance
        cells[0] = 1
    return Neighbours(
        reach=reach,
        skin=skin,
        most=max(most, 1),
        cells=tuple(cells),
        inverse=tuple(n / float(length) for n, length in zip(cells, box, strict=True)),
        cell=np.zeros(beads, np.int32),
        head=np.zeros(math.prod(cells), np.int32),
        following=np.zeros(beads, np.int32),
        count=np.zeros(beads if most else 0, np.int32),
        near=np.zeros((beads, most) if most else (0, 1), np.int32),
        made_at=np.zeros(beads * len(cells)),
        boxes=np.zeros(beads),
        noted=np.zeros((threads, GAP)),
    )


@by_type
def apart(box, r, other):
    """The vector from r to the nearest image of the other."""
    return _apart_sliding if box.instance_class in SLIDING else _apart


def _apart(box, r, other):
    return nearest_image(box, added_scaled(other, -1.0, r))


def _apart_sliding(box, r, other):
    up = rint((other[1] - r[1]) * box.inverse[1])
    image = with_item(other, 0, other[0] - up * box.offset)
    return nearest_image(box, added_scaled(image, -1.0, r))


@by_type
def offset_of_images(box):
    """The present displacement of the image above, along x."""
    return (lambda box: box.offset) if box.instance_class in SLIDING else (lambda box: 0.0)


@by_type
def refresh(worker, lists, halo, box, places, zero):
    """Make the lists anew if they may miss a pair; nothing without a pair potential."""
    return _refresh if len(lists) else lambda worker, lists, halo, box, places, zero: None


def _refresh(worker, lists, halo, box, places, zero):
    (lists,) = lists
    every, noted, farthest = len(lists.cell), lists.noted[worker.thread], 0.0
    around = share(number_of(halo, every, AROUND), worker.thread, worker.threads)
    slip = slip_since(box, noted[OFFSET])
    for n in range(around[0], around[1]):
        i = bead_of(halo, AROUND, n)
        place = load_values(places, np.uint64(i * len(zero)), zero)
        farthest = max(farthest, square_moved(lists, i, place, slip))
    noted[MOVED] = farthest
    barrier(worker)
    # All threads come to the same answer, so that all make lists or none.
    old = outdated(lists.noted, MOVED, worker.threads, abs(slip), lists.skin)
    if noted[MADE] == 0.0 or old:
        find_cells(lists, halo, box, places, around, zero)
        noted[OFFSET] = offset_of_images(box)
        noted[MADE] = 1.0
        barrier(worker)
        link(lists, halo, share(len(lists.head), worker.thread, worker.threads))
        barrier(worker)
        first, last = share(number_of(halo, every, OWN), worker.thread, worker.threads)
        for n in range(first, last):
            make_list(lists, box, places, bead_of(halo, OWN, n), zero)
        barrier(worker)


@scalar
def slip_since(box, offset):
    """How far the images above have slid since they had this offset."""
    slip = offset_of_images(box) - offset
    return slip - rint(slip * box.inverse[0]) * box.size[0]


@scalar
def square_moved(lists, i, place, slip):
    """Square of the displacement of bead i since the lists were made, relative to what is around.

    Under shear images slide meanwhile: of a bead that was `boxes` images up along y, as many slips
    are taken off. It is infinite for a bead that is lost.
    """
    before = load_values(lists.made_at, np.uint64(i * len(place)), place)
    moved = added_scaled(place, -1.0, before)
    moved = with_item(moved, 0, moved[0] - element(lists.boxes, i) * slip)
    square = dot(moved, moved)
    return square if square >= 0.0 else np.inf


@seldom
def find_cells(lists, halo, box, places, share_of, zero):
    """Find the cells of these beads, and store their places."""
    still = scaled(0.0, zero)
    for n in range(share_of[0], share_of[1]):
        i = bead_of(halo, AROUND, n)
        at = np.uint64(i * len(zero))
        r = load_values(places, at, zero)
        store_values(lists.made_at, at, r)
        lists.boxes[i] = floor(r[1] * box.inverse[1])
        r, _, _ = fold(box, r, still, still)
        lists.cell[i] = cell_of(lists, r)


@seldom
def link(lists, halo, cells):
    """Link the beads of the cells of this thread; the last bead comes first."""
    first, last = cells
    lists.head[first:last] = -1
    # Every thread reads all beads and links those of its own cells, so no two write to one cell.
    # The order in a cell follows from the list of beads, not from threads.
    for n in range(number_of(halo, len(lists.following), AROUND)):
        i = bead_of(halo, AROUND, n)
        cell = lists.cell[i]
        if first <= cell < last:
            lists.following[i] = lists.head[cell]
            lists.head[cell] = i


@seldom
def make_list(lists, box, places, i, zero):
    """List all beads within reach of bead i, by id."""
    d, still, found, most = len(zero), scaled(0.0, zero), 0, lists.near.shape[1]
    mine = load_values(places, np.uint64(i * d), zero)
    r, _, _ = fold(box, mine, still, still)
    slide, square = offset_of_images(box), lists.reach * lists.reach
    # Neighbours are inserted by id. A bead adds up forces in this order, so its sum of floats has
    # the same bits whenever the list was made. `found` counts on beyond a full list, to mark it
    # CROWDED.
    here = cells_along(lists, r)
    for n in range(3 ** (d - 1)):
        row, middle = row_around(lists, box, r, here, slide, n)
        for a in range(-1, 2 if row != NOWHERE else -1):
            along_x = cell_after(lists, box, 0, middle, a)
            j = lists.head[np.uint64(row + along_x)] if along_x != NOWHERE else -1
            while j >= 0:
                separation = apart(box, mine, load_values(places, np.uint64(j * d), zero))
                if j != i and dot(separation, separation) <= square:
                    found = insert(lists.near, i, found, j) if found < most else found + 1
                j = lists.following[j]
    lists.count[i] = found if found <= most else CROWDED
