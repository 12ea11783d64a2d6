"""Spheres in memory: sorting by cells, neighbour lists and what contacts remember."""

from abc import abstractmethod
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import RunError
from mesokit.geometry.protocol import Nothing
from mesokit.geometry.solids.bodies import NO_TERM
from mesokit.loops.layout import by_number
from mesokit.loops.neighbours import inverse_lengths
from mesokit.loops.threads import Threads
from mesokit.method.spheres.common.contacts.groups import NEVER, Box, Lists, Solid, Walls
from mesokit.method.spheres.common.contacts.lists import GROUP, make_lists, sort
from mesokit.method.spheres.common.contacts.remembered import carry_springs
from mesokit.method.spheres.common.contacts.solid import MOST
from mesokit.seam.engine import Array

CELLS = 4_000_000  # at most
ROUNDING = 1 + 1e-9  # cells are larger by this than they need to be


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


class Listed(NamedTuple):
    """What lists need: size of the box and closed axes; reach (n,); skin; once: see `Lists`; width:
    numbers that a contact remembers; rows and own of walls, see `Walls`; others: of any shape."""

    size: tuple[float, ...]
    closed: tuple[bool, ...]
    reach: Array
    skin: float
    once: int
    width: int
    rows: Array
    own: Array
    others: Others | None


class ListedSpheres:
    """Spheres in a box and their neighbour lists, on some threads.

    `bodies` and `spare` are a NamedTuple of arrays in the order of memory.
    """

    @abstractmethod
    def make_bodies(self, n: int) -> Any:
        """Memory for so many."""

    def __init__(self, listed: Listed, threads: int) -> None:
        n, self.listed, self.worker = len(listed.reach), listed, Threads(threads)
        self.n, self.dimension = n, len(listed.size)
        self.box: Any = _box(listed)
        self.grid = _grid(listed, self.box)
        self.bodies, self.spare = self.make_bodies(n), self.make_bodies(n)
        self.walls, self.lists, self.old = self._walls(), self._lists(GROUP), self._lists(GROUP)
        self.cell, self.order = np.zeros(n, np.int64), np.zeros(n, np.int64)
        self.begins = np.zeros(int(np.prod(self.grid.cells)) + 1, np.int64)
        self.scratch = np.zeros((threads, n + GROUP), np.int64)

    def _walls(self) -> Walls:
        """Walls without contacts."""
        n, listed = self.n, self.listed
        solid: Any = Nothing()
        if (others := listed.others) is not None:
            terms, springs = np.full((n, MOST), NO_TERM, np.int32), self._springs(n * MOST)
            solid = Solid(others.bodies, others.pattern, others.own, terms, springs)
        return Walls(listed.rows, listed.own, self._springs(n * len(listed.rows)), solid)

    def _springs(self, contacts: int) -> Array:
        return np.zeros((contacts, self.listed.width))

    def _lists(self, most: int) -> Lists:
        n, listed = self.n, self.listed
        count, own, begin = (np.zeros(n, np.int64) for _ in range(3))
        near, springs = np.zeros((n, most), np.int32), np.zeros((n * listed.width, listed.width))
        return Lists(listed.skin, listed.once, count, own, near, begin, springs, np.zeros((n, 4)))

    def forget_contacts(self) -> None:
        """Begin without contacts."""
        self.walls, self.lists = self._walls(), self._lists(GROUP)

    def box_of_lists(self) -> Any:
        """The box as it is when lists are made."""
        return self.box

    def inside(self, places: Array) -> tuple[Array, NDArray[np.int32]]:
        """Places (n, d) in the box, and image counts (n, d)."""
        listed = self.listed
        size, repeats = np.array(listed.size), ~np.array(listed.closed)
        images = np.where(repeats, np.floor(places / size), 0).astype(np.int32)
        inside = places - images * size
        return np.where(repeats & (inside >= size), 0.0, inside), images

    def renew(self) -> None:
        """Sort spheres by cells, and make neighbour lists. Raises RunError for lost places."""
        bodies, spare = self.bodies, self.spare
        if not np.isfinite(bodies.place).all():
            raise RunError("places are no numbers any more; expected a shorter timestep")
        sort(self.grid, bodies.place, self.cell, self.begins, self.order)
        for old, new in zip(bodies, spare, strict=True):
            np.take(old, self.order, axis=0, out=new, mode="clip")
        self.bodies, self.spare = spare, bodies
        self.lists, self.old = self.old, self.lists
        self._sort_walls()
        columns = np.zeros((4, self.n + GROUP))
        columns[:, : self.n] = self.bodies.place.T
        while True:
            memory = self.bodies, self.box_of_lists(), self.lists, self.scratch
            self.worker.run(make_lists, self.grid, self.begins, columns, *memory)
            longest = int(self.lists.count.max())
            if longest < self.lists.near.shape[1]:  # one place is written beyond the end
                break
            self.lists = self._lists(longest + GROUP)
        if self.listed.once != NEVER:
            self._carry_springs()

    def _carry_springs(self) -> None:
        lists = self.lists
        np.cumsum(lists.own[:-1], out=lists.begin[1:])
        contacts = int(lists.own.sum())
        if len(lists.springs) < contacts:
            springs = np.zeros((contacts + contacts // 8, self.listed.width))
            self.lists = lists._replace(springs=springs)
        self.worker.run(carry_springs, self.order, self.old, self.lists)

    def _sort_walls(self) -> None:
        walls, order = self.walls, self.order

        def ordered(springs: Array) -> Array:
            return self.of_each(springs)[order].reshape(springs.shape)

        if self.listed.others is not None:
            solid = walls.solid
            terms, beside = solid.terms[order], ordered(solid.springs)
            walls = walls._replace(solid=solid._replace(terms=terms, springs=beside))
        self.walls = walls._replace(springs=ordered(walls.springs))

    def of_each(self, springs: Array) -> Array:
        """What contacts with walls remember, sphere by sphere."""
        return springs.reshape(self.n, len(springs) // self.n, springs.shape[1])

    def by_number(self, rows: NDArray[Any]) -> NDArray[Any]:
        """Rows in the order of memory, by particle number."""
        return by_number(self.bodies.number, rows)

    def remembered_at_walls(self) -> dict[str, NDArray[Any]]:
        """What contacts with walls remember, by particle number."""
        found = {}
        if self.listed.width:
            found["wall_springs"] = self.by_number(self.of_each(self.walls.springs))
        if self.listed.others is not None:
            found["solid_terms"] = self.by_number(self.walls.solid.terms)
            found["solid_springs"] = self.by_number(self.of_each(self.walls.solid.springs))
        return found

    def remember_at_walls(self, state: dict[str, NDArray[Any]]) -> None:
        """Go on from `remembered_at_walls`, while spheres lie in the order of their numbers."""
        if self.listed.width:
            self.of_each(self.walls.springs)[:] = state["wall_springs"]
        if self.listed.others is not None:
            self.walls.solid.terms[:] = state["solid_terms"]
            self.of_each(self.walls.solid.springs)[:] = state["solid_springs"]


def three(numbers: Any, kind: type = float) -> tuple[Any, Any, Any]:
    """Three numbers as a tuple."""
    x, y, z = (kind(number) for number in numbers)
    return x, y, z


def _box(listed: Listed) -> Box:
    size = [*listed.size, 1.0, 1.0][:3]
    shut = [*listed.closed, True, True][:3]
    return Box(three(size), three(inverse_lengths(size, shut)))


def _grid(listed: Listed, box: Box) -> Grid:
    """Cells of half the length that lists reach, of which five lie along an axis at least; or of
    all of it, three at least; or one."""
    d, reach = len(listed.size), 2 * float(listed.reach.max()) + listed.skin
    least = (float(np.prod(listed.size)) / CELLS) ** (1 / d)
    cells, wide = [1, 1, 1], [0, 0, 0]
    for k, length in enumerate(listed.size):
        for width in (1, 2):
            number = int(length / max(reach / width * ROUNDING, least))
            if number >= 2 * width + 1:
                cells[k], wide[k] = number, width
    inverse = [number / length for number, length in zip(cells, box.size, strict=True)]
    return Grid(three(cells, int), three(inverse), three(wide, int), (reach * ROUNDING) ** 2)
