"""The solids of a case, assembled: what is where, how much fluid there is room for.

One object serves everything: the start, the step, the observables and the pictures.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Collection, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.box import Box
from mesokit.case.case import Case
from mesokit.case.component import name_of, show
from mesokit.errors import CaseError
from mesokit.geometry.region import Room
from mesokit.geometry.samples.from_file import FromFile
from mesokit.geometry.shape.plates import Plates
from mesokit.geometry.shape_protocol import Body, Wall, closed_axes
from mesokit.geometry.solids import survey
from mesokit.geometry.solids.tables import SolidTables

Floats = NDArray[np.float64]
THIN, NARROW = 1.5, 3.0  # cells
SKIN = 0.02  # cells: two surfaces so near each other touch
TRIES = 30  # steps by which a place near a solid comes onto its surface
Tight = tuple[tuple[float, ...], float]
FINE = 8  # parts of a cell, along each axis, by which volumes are summed


def _places(along: Sequence[Any]) -> Floats:
    """All places (n, d) with these coordinates along each axis; the last axis varies fastest."""
    return np.stack(np.meshgrid(*along, indexing="ij"), -1).reshape(-1, len(along))


def slit_of(case: Case) -> Plates | None:
    """The two plates, if these are all walls: the step has simpler code for them."""
    return case.walls[0] if _is_slit(case.walls) else None


def _is_slit(walls: Sequence[Wall]) -> bool:
    return len(walls) == 1 and isinstance(walls[0], Plates) and not walls[0].diffuse


def labels(walls: Sequence[Wall]) -> list[str]:
    """The names of walls: given, or shape and number."""
    numbers: dict[str, int] = {}
    found = []
    for wall in walls:
        shape = name_of(wall)
        number = numbers[shape] = numbers.get(shape, 0) + 1
        found.append(wall.name or f"{shape}-{number}")
    return found


def solids_of(case: Case) -> Solids:
    """The solids of a case; kept, for they take a moment to survey."""
    digests = tuple(wall.digest for wall in case.walls if isinstance(wall, FromFile))
    return _kept(case.walls, case.box, digests)


def solids_left(case: Case, time: float) -> Solids | None:
    """The solids of a case that are not yet taken away at a time; None where none are left."""
    left = tuple(wall for wall in case.walls if wall.opens is None or time < wall.opens)
    digests = tuple(wall.digest for wall in left if isinstance(wall, FromFile))
    return _kept(left, case.box, digests) if left else None


@functools.lru_cache(maxsize=8)
def _kept(walls: tuple[Wall, ...], box: Box, digests: tuple[str, ...]) -> Solids:
    """Files may change, and walls that name them are then other walls."""
    return Solids(walls, box)


def free_volume(case: Case) -> float:
    """Volume that the walls of a case leave to the fluid, in cells."""
    slit = all(isinstance(wall, Plates) for wall in case.walls)
    return float(case.box.volume) if slit else solids_of(case).free_volume


class Solids(SolidTables):
    """The solids of a case, in tables.

    Parameters
    ----------
    walls : sequence of shapes
        As in a case.
    box : Box
        As in a case.

    Attributes
    ----------
    bodies : list of Body
        What has a surface and a force of its own.
    free_volume : float
        Volume of the fluid, in cells.

    Examples
    --------
    >>> import mesokit
    >>> solids = Solids([mesokit.Disk(centre=[5, 5], radius=2)], mesokit.Box([10, 10]))
    >>> solids.distance([[5.0, 5.0], [5.0, 7.5]]).tolist()
    [-2.0, 0.5]
    >>> round(solids.free_volume, 2)
    87.43
    """

    def __init__(
        self, walls: Sequence[Wall], box: Box, *, only: Collection[int] | None = None
    ) -> None:
        self._walls, self._box = walls, box
        shut = closed_axes(walls)
        room = Room(box.size, tuple(axis in shut for axis in box.axes))
        bodies: list[Body] = []
        self.walls: list[int] = []  # of which wall each body is
        for index, (wall, label) in enumerate(zip(walls, labels(walls), strict=True)):
            if only is not None and index not in only:
                continue
            if not wall.closed_axes and any(length != int(length) for length in box.size):
                raise CaseError(
                    f"wall[#{index + 1}]: solids other than plates need a box of whole lengths, "
                    f"not box.size = {show(list(box.size))}"
                )
            try:
                made = wall.bodies(room, label)
            except CaseError as error:
                raise CaseError(f"wall[#{index + 1}].{error}") from None
            bodies += made
            self.walls += [index] * len(made)
        # tables are of whole cells: the last may reach beyond a box of plates alone
        super().__init__(Room(tuple(map(math.ceil, box.size)), room.closed), bodies)

    @property
    def obstruct(self) -> bool:
        """Whether there is more than the two plates of a slit."""
        return not _is_slit(self._walls)

    @functools.cached_property
    def _others(self) -> Solids:
        """The same without the plates, in the same room."""
        rest = [i for i, wall in enumerate(self._walls) if not isinstance(wall, Plates)]
        return Solids(self._walls, self._box, only=rest)

    @functools.cached_property
    def period(self) -> tuple[int, ...]:
        """Cells along each axis after which all walls are the same again: those of the box at
        most."""
        whole = tuple(map(int, self.size))
        each = [wall.period(self.room) for wall in self._walls]
        if any(self.room.closed) or any(n % 1 for period in each for n in period):
            return whole
        return tuple(math.lcm(*map(int, along)) for along in zip(*each, strict=True)) or whole

    @property
    def names(self) -> list[str]:
        """Of the bodies."""
        return [body.name for body in self.bodies]

    def samples(self, wall: int) -> Floats:
        """The signed distances, smoothed, of a wall that was read from a file, by its number."""
        found = self.bodies[self.walls.index(wall)].pieces[0].term[0].samples
        assert found is not None
        return found

    def distance(self, points: Any, plates: bool = True) -> Floats:
        """Signed distance (n,) of points (n, d) from the nearest surface, positive in the fluid.

        Exact near surfaces; elsewhere, and inside of solids made of several, a lower bound of its
        size. Without `plates`, from the other surfaces. Raises ValueError for points that do not
        have one number for each axis.
        """
        if not plates and any(self.room.closed):
            return self._others.distance(points)
        points = self._rows(points)
        out = np.zeros(len(points))
        survey.clearances(self.kernel, self.least, self.pattern, points, out)
        return out

    def _rows(self, points: Any) -> Floats:
        """Points (n, d), or a grid of them, as rows. Raises ValueError."""
        given = np.ascontiguousarray(points, float)
        if given.shape[-1] != self.dimension:
            raise ValueError(
                f"points: expected shape (n, {self.dimension}), not {given.shape}: "
                f"{self.dimension} numbers for each point in a {self.dimension}D box"
            )
        return given.reshape(-1, self.dimension)

    def nearest(self, points: Any) -> tuple[NDArray[np.int64], Floats, Floats]:
        """Body (-1: none within a cell), distance (n,) and normal (n, d) at points (n, d)."""
        terms, distance, normal = survey.nearest_surfaces(self.kernel, self._rows(points))
        return self._body_of[terms], distance, normal

    def depths(self, away: float) -> Callable[[Any], tuple[NDArray[np.int64], Floats, Floats]]:
        """The function of points (n, d) that gives body (-1: none so near), distance (n,) and
        normal, exact for distances up to `away`."""
        kernel = self.reaching(away)

        def look(points: Any) -> tuple[NDArray[np.int64], Floats, Floats]:
            rows = self._rows(points)
            terms, distance, normal = survey.nearest_surfaces(kernel, rows, float(away))
            return self._body_of[terms], distance, normal

        return look

    @functools.cached_property
    def open_cells(self) -> Floats:
        """Part of each cell of the box that is fluid, one axis after the other."""
        clear = self.distance(self._centres()).reshape(self.size)
        share = (clear > 0).astype(float)
        mixed = np.argwhere(np.abs(clear) < 0.5 * math.sqrt(self.dimension))
        share[tuple(mixed.T)] = self.open_part(mixed + 0.5, 1.0)
        return share

    def open_share(self, axes: tuple[int, ...], bins: tuple[int, ...]) -> Floats:
        """Part of each bin that is fluid: equal bins over the whole box along some axes."""
        other = tuple(k for k in range(self.dimension) if k not in axes)
        per_cell = [n // self.size[k] for k, n in zip(axes, bins, strict=True)]
        if max(per_cell) == 1:
            return np.transpose(self.open_cells.mean(axis=other), np.argsort(np.argsort(axes)))
        pieces = [1] * self.dimension
        for k, n in zip(axes, per_cell, strict=True):
            pieces[k] = n
        fine = [FINE // math.gcd(FINE, n) * n if n <= FINE else n for n in pieces]
        along = [(np.arange(n * m) + 0.5) / m for n, m in zip(self.size, fine, strict=True)]
        side = max(1.0 / m for m in fine)
        whole = np.clip(0.5 + self.distance(_places(along)) / side, 0.0, 1.0)
        shape = [m for k, n in enumerate(self.size) for m in (n * pieces[k], fine[k] // pieces[k])]
        share = whole.reshape(shape).mean(axis=tuple(range(1, 2 * self.dimension, 2)))
        return np.transpose(share.mean(axis=other), np.argsort(np.argsort(axes)))

    def open_part(self, centres: NDArray[Any], side: float, fine: int = FINE) -> Floats:
        """Part of cubes of this side that is fluid, from fine^d cubes in each."""
        steps = ((np.arange(fine) + 0.5) / fine - 0.5) * side
        grid = _places([steps] * self.dimension)
        share = np.zeros(len(centres))
        for first in range(0, len(centres), 4096):
            some = centres[first : first + 4096]
            points = (some[:, None] + grid).reshape(-1, self.dimension)
            out = np.zeros(len(points))
            survey.open_volume(self.kernel, self.pattern, points, side / fine, out)
            share[first : first + 4096] = out.reshape(len(some), -1).mean(axis=1)
        return share

    @functools.cached_property
    def free_volume(self) -> float:
        """Volume of the fluid, in cells."""
        return float(self.open_cells.sum())

    def misfit(self, axis: int) -> float:
        """Largest difference of the clearances at the two ends of an axis, where there is fluid."""
        if self.room.closed[axis]:
            return 0.0
        grids = [(np.arange(4 * n) + 0.5) / 4 for n in self.size]
        grids[axis] = np.zeros(1)
        start = _places(grids)
        end = start.copy()
        end[:, axis] = np.nextafter(self.size[axis], 0.0)
        a, b = self.distance(start), self.distance(end)
        return float(np.abs(np.clip(a, 0, 1) - np.clip(b, 0, 1)).max())

    def tight_places(self) -> tuple[Tight | None, Tight | None]:
        """Where the solid is thinner than THIN cells, and a gap narrower than NARROW: the tightest
        place of each, and its width; None where there is none."""
        centres = self._centres()
        body, distance, normal = self.nearest(centres)
        near = (body >= 0) & (np.abs(distance) < 0.5 * math.sqrt(self.dimension))
        feet, normal = centres[near] - distance[near, None] * normal[near], normal[near]
        # where solids touch, such as one and its own image, there is solid on both sides
        bare = (self.distance(feet + SKIN * normal) > 0) & (self.distance(feet - SKIN * normal) < 0)
        feet, normal = feet[bare], normal[bare]
        found: list[Tight | None] = []
        for side, limit in ((-1.0, THIN), (1.0, NARROW)):
            tightest = None
            for step in np.arange(0.25, limit, 0.25):
                there = side * self.distance(feet + side * step * normal)
                beyond = np.flatnonzero(there < -0.05)
                if len(beyond):
                    tightest = tuple(feet[beyond[0]] % self.size), float(step)
                    break
            found.append(tightest)
        return found[0], found[1]

    def without_surface(self) -> list[int]:
        """The walls, by number, of which no surface is in the box, be it behind others."""
        seen = {self.walls[body] for body in self._bodies_met()}
        rest = sorted(set(self.walls) - seen)
        return [i for i in rest if not Solids(self._walls, self._box, only=[i])._bodies_met()]

    def _bodies_met(self) -> set[int]:
        """The bodies that have a surface which is nearest to the middle of a cell."""
        r = self._centres()
        body, distance, _ = self.nearest(r)
        near = (body >= 0) & (np.abs(distance) <= 0.5 * math.sqrt(self.dimension) + SKIN)
        r, found = r[near], set()
        for _ in range(TRIES):
            body, distance, normal = self.nearest(r)
            r = r - distance[:, None] * normal
            there = (body >= 0) & (np.abs(distance) < 1e-6)
            found |= set(body[there].tolist())
            if there.all() or len(found) == len(self.bodies):
                break
        return found

    def _centres(self) -> Floats:
        return _places([np.arange(n) + 0.5 for n in self.size])

    @functools.cached_property
    def motion(self) -> dict[int, tuple[float, float]]:
        """How fast the surface of each wall moves, by its number, and would move across itself."""
        centres = self._centres()
        terms, distance, normal = survey.nearest_surfaces(self.kernel, centres)
        found: dict[int, tuple[float, float]] = {}
        order = np.argsort(terms, kind="stable")  # all cells of one term follow one another
        starts = np.flatnonzero(np.diff(terms[order], prepend=-2))
        for at in np.split(order, starts[1:]):
            term = terms[at[0]]
            if term < 0:
                continue
            body = self.bodies[self.body_of_term[term]]
            arm = centres[at] - distance[at, None] * normal[at]
            arm -= self.pivots[term, : self.dimension]
            full = np.zeros((len(arm), 3))
            full[:, : self.dimension] = arm
            u = np.cross(body.rotation, full)[:, : self.dimension]
            u += np.array(body.surface.velocity or (0.0,) * self.dimension)
            with np.errstate(over="ignore"):  # absurd speeds are refused elsewhere
                speed = float(np.sqrt((u**2).sum(axis=1)).max())
            across = float(np.abs((u * normal[at]).sum(axis=1)).max())
            wall = self.walls[self.body_of_term[term]]
            fastest, most = found.get(wall, (0.0, 0.0))
            found[wall] = max(fastest, speed), max(most, across)
        return found
