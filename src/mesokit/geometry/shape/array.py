"""A shape repeated on a regular lattice."""

import itertools
import math
from typing import Any, Literal

from pydantic import field_validator

from mesokit.case.component import component, param, show, tag
from mesokit.case.describe.hints import Many
from mesokit.errors import CaseError
from mesokit.geometry import region
from mesokit.geometry.composite import require_bare
from mesokit.geometry.region import Room
from mesokit.geometry.shape_protocol import Piece, Repeatable, Shape, pieces_of

MOST_COPIES = 2**16


@component
class Array(Shape):
    """A shape repeated along each axis, evenly over the whole box: a post array in one line.

    With `repeat` [10, 5] in a box of 100 by 50, copies stand 10 apart along x and y; the shape
    itself is the copy nearest the origin.
    """

    shape: Literal["array"] = tag("array")
    of: Repeatable = param(doc="the shape to repeat")
    repeat: Many[int] = param(doc="number of copies along each axis")

    @field_validator("repeat")
    @classmethod
    def _positive(cls, repeat: tuple[int, ...]) -> tuple[int, ...]:
        if not all(n >= 1 for n in repeat):
            raise ValueError("expected at least 1 along each axis")
        if math.prod(repeat) > MOST_COPIES:
            raise ValueError(f"{math.prod(repeat)} copies; expected at most {MOST_COPIES}")
        return repeat

    def __post_init__(self) -> None:
        require_bare(self.of, "of", "array")

    def places(self, room: Room) -> list[list[float]]:
        """Where the copies are, relative to the first. Raises CaseError for too many."""
        if any(n > length for n, length in zip(self.repeat, room.size, strict=True)):
            raise CaseError(
                f"repeat = {show(self.repeat)}: copies less than a cell apart; expected at most "
                f"{show(room.size)} in this box"
            )
        steps = [length / n for length, n in zip(room.size, self.repeat, strict=True)]
        counts = itertools.product(*(range(n) for n in self.repeat))
        return [[i * step for i, step in zip(count, steps, strict=True)] for count in counts]

    def body(self, room: Room) -> region.Region:
        one = self.of.sided(self.of.body(room), room)
        return region.union(region.moved(one, place) for place in self.places(room))

    def pieces(self, room: Room) -> list[Piece]:
        """The solid in this box, in pieces, each turning about the pivot of its own copy."""
        if self.fluid == "inside":
            return super(Array, self).pieces(room)  # noqa: UP008  # the decorator makes a new class
        one, pivot = self.of.sided(self.of.body(room), room), self.of.pivot(room)
        return [
            piece
            for by in self.places(room)
            for piece in pieces_of(
                region.moved(one, by), [x + dx for x, dx in zip(pivot, by, strict=True)], room
            )
        ]

    def period(self, room: Room) -> tuple[float, ...]:
        """From one copy to the next."""
        return tuple(length / n for length, n in zip(room.size, self.repeat, strict=True))

    def pivot(self, room: Room) -> tuple[float, ...]:
        return self.of.pivot(room)

    def vectors(self) -> dict[str, Any]:
        parts = {f"of.{key}": value for key, value in self.of.vectors().items()}
        return parts | {"repeat": self.repeat}
