"""Solids as tables for compiled code: their parts, and which of them are near each cell."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import CaseError
from mesokit.geometry.primitive import WIDTH
from mesokit.geometry.region import Room
from mesokit.geometry.shape_protocol import Body, Piece
from mesokit.geometry.solids import bodies, survey
from mesokit.geometry.solids.bodies import NO_TERM, REACH, Bodies
from mesokit.geometry.solids.survey import Blocks
from mesokit.scalar.pointer import address

EDGES = (64, 8, 1)  # cells: blocks, and blocks within them
MOST_NEAR = 2**31 - 1  # places in a list are 32-bit
FARTHEST = 8.0  # cells from a surface at which distances are needed
RULES = {"no-slip": bodies.NO_SLIP, "slip": bodies.SLIP, "diffuse": bodies.DIFFUSE}


class SolidTables:
    """Bodies in a room: the parameters that compiled code takes, and the tables that it reads."""

    def __init__(self, room: Room, bodies: list[Body]) -> None:
        self.room, self.bodies = room, bodies
        self.size, self.dimension = room.size, len(room.size)
        self.pattern = (0.0,) * self.dimension
        self._tables: list[NDArray[Any]] = []
        pieces = [(piece, row) for row, body in enumerate(bodies) for piece in body.pieces]
        self.kernel = self._kernel(pieces)
        # Most images of pieces are too far from all places in the box to matter.
        clearance = np.zeros(len(pieces))
        survey.term_clearances(self.kernel, tuple(0.5 * n for n in self.size), clearance)
        far = 0.5 * math.hypot(*self.size) + FARTHEST
        pieces = [piece for piece, c in zip(pieces, clearance, strict=True) if c <= far]
        self.kernel = self._kernel(pieces)
        self._terms = len(pieces)
        self.kernel = self.reaching(REACH)

    def reaching(self, away: float) -> Bodies:
        """Parameters for compiled code, with lists of the terms within `away` of each cell."""
        blocks = self._near_cells(away)
        self.least, starts, near = blocks.least, blocks.starts, blocks.near
        places = self._places.copy()
        places[bodies.STARTS], places[bodies.NEAR] = self._keep(starts), self._keep(near)
        return self.kernel._replace(tables=self._keep(places, np.int64))

    def _near_cells(self, away: float) -> Blocks:
        """The terms near each cell, found in smaller and smaller blocks."""
        every = np.arange(self._terms)
        blocks = Blocks(2 * max(self.size), np.array([0, len(every)]), every, np.full(1, np.inf))
        for edge in EDGES:
            if edge < blocks.edge:
                blocks = self._near(away, blocks, edge)
        return blocks

    def _near(self, away: float, above: Blocks, edge: int) -> Blocks:
        number = math.prod(-(-length // edge) for length in self.size)
        starts, least = np.zeros(number + 1, np.int64), np.zeros(number)
        counted = Blocks(edge, starts, np.zeros(0, np.int64), least)
        survey.near_blocks(self.kernel, self.pattern, away, above, counted)
        if starts[-1] > MOST_NEAR:
            raise CaseError(
                f"wall: {starts[-1]} parts of solids are near cells of this box; expected at most "
                f"{MOST_NEAR}: fewer parts, or a smaller box"
            )
        listed = counted._replace(near=np.zeros(max(starts[-1], 1), np.int64))
        survey.near_blocks(self.kernel, self.pattern, away, above, listed)
        return listed

    def _keep(self, table: Any, kind: Any = np.int32) -> int:
        """Keep a table as long as this object lives; its address."""
        table = np.ascontiguousarray(table, kind)
        self._tables.append(table)
        return address(table)

    def _kernel(self, pieces: list[tuple[Piece, int]]) -> Bodies:
        """Parameters for compiled code, still without its tables."""
        parts = [part for piece, _ in pieces for part in piece.term]
        numbers = np.array([part.numbers for part in parts]).reshape(-1, WIDTH)
        samples, total = [np.zeros(1)], 1
        begin: dict[int, int] = {}  # images share their samples
        for i, part in enumerate(parts):
            if part.samples is None:
                continue
            if id(part.samples) not in begin:
                begin[id(part.samples)] = total
                samples.append(part.samples.ravel())
                total += part.samples.size
            numbers[i, 7] = begin[id(part.samples)]
        pivots = np.zeros((len(pieces), 3))
        for i, (piece, _) in enumerate(pieces):
            pivots[i, : self.dimension] = piece.pivot
        inverse = tuple(
            0.0 if shut else 1.0 / length
            for shut, length in zip(self.room.closed, self.size, strict=True)
        )
        self.body_of_term = np.array([row for _, row in pieces], np.int32)
        self._body_of = np.array([*self.body_of_term, NO_TERM])  # of no term: the last
        self.pivots = pivots
        surfaces = [self._surface(body) for body in self.bodies]
        tables = {
            bodies.KINDS: self._keep([part.code for part in parts]),
            bodies.SIGNS: self._keep([part.sign for part in parts], float),
            bodies.NUMBERS: self._keep(numbers, float),
            bodies.SAMPLES: self._keep(np.concatenate(samples), float),
            bodies.FIRST: self._keep(np.cumsum([0, *(len(piece.term) for piece, _ in pieces)])),
            bodies.BODY: self._keep(self.body_of_term),
            bodies.PIVOT: self._keep(pivots, float),
            bodies.SURFACES: self._keep(surfaces, float),
        }
        self._places = np.zeros(bodies.SIZE + 3, np.int64)
        for number, place in tables.items():
            self._places[number] = place
        self._places[bodies.SIZE : bodies.SIZE + self.dimension] = self.size
        size = tuple(float(length) for length in self.size)
        return Bodies(
            size,
            inverse,
            address(self._places),
            parts=1.0,
            first=self.pattern,
            held=self.pattern,
            clear=self._keep([0.0], np.float32),
            plane_of=self._keep([-1]),
            planes=0,
            reach=0.0,
            stride=0.0,
            lowest=size,
            highest=size,
        )

    def _surface(self, body: Body) -> list[float]:
        velocity = list(body.surface.velocity or ()) + [0.0] * 3
        fills = body.surface.rule != "slip" and body.virtual != "none"
        return [RULES[body.surface.rule], *velocity[:3], *body.rotation, float(fills)]
