"""Base classes of walls and shapes of solids, and the bodies of which solids consist."""

import math
from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from typing import Any, ClassVar, Literal, NamedTuple

import numpy as np

from mesokit.case.box import AXES, Axis
from mesokit.case.component import component, option
from mesokit.case.registry import family
from mesokit.errors import CaseError
from mesokit.geometry import primitive
from mesokit.geometry.region import Region, Room, Term, complement, images
from mesokit.geometry.solids.bodies import REACH
from mesokit.geometry.surface import Surface
from mesokit.scalar.intrinsics import with_item
from mesokit.scalar.jit import seldom
from mesokit.scalar.pointer import address


def reaches(term: Term, room: Room) -> bool:
    """Whether a term is on the list of what is near any cell of the box."""
    clear = np.full(math.prod(room.size), -np.inf)
    size, nothing = tuple(float(length) for length in room.size), np.zeros(1)
    for part in term:
        numbers = np.array(part.numbers)
        samples = nothing if part.samples is None else part.samples
        farthest_out(part.code, part.sign, address(numbers), address(samples), size, clear)
    return bool(clear.min() <= 0.5 * math.sqrt(room.dimension) + REACH)


@seldom
def farthest_out(kind, sign, numbers, samples, size, clear):
    """Raise the clearance of the middle of each cell to that from a part."""
    for cell in range(len(clear)):
        r, rest = size, cell
        for k in range(len(size)):
            length = int(size[k])
            r = with_item(r, k, rest % length + 0.5)
            rest //= length
        clear[cell] = max(clear[cell], sign * primitive.distance(kind, numbers, samples, r))


Virtual = Literal["extrapolate", "fill", "top-up", "none"]
VIRTUAL = (
    "virtual particles in the cells that the surface cuts: 'fill' the solid part with a gas at the "
    "surface's velocity, 'extrapolate' the fluid's velocity into that gas, 'top-up' each cell to "
    "the mean density, or 'none' (a slip surface has none)"
)

MOST_TERMS = 4096  # of a complement, which has one for each choice of a part from every term


class Piece(NamedTuple):
    """A term of a body, and the place about which it turns and its torque is taken."""

    term: Term
    pivot: tuple[float, ...]


def pieces_of(region: Region, pivot: Sequence[float], room: Room) -> list[Piece]:
    """The terms of a region and their periodic images, of which each has its own pivot."""
    return [
        Piece(term, tuple(x + dx for x, dx in zip(pivot, by, strict=True)))
        for term, by in images(region, room)
    ]


class Body(NamedTuple):
    """A solid with one surface and one force on it; the rate of rotation is a vector of three."""

    name: str
    surface: Surface
    virtual: str
    pieces: list[Piece]
    rotation: tuple[float, ...]


@family("shape", "shape", "mesokit.shape")
@component
class Wall(ABC):
    """A solid, or several, that the fluid cannot enter."""

    per_axis: ClassVar[tuple[str, ...]] = ()  # keys with one number for each axis
    dimensions: ClassVar[tuple[int, ...]] = (2, 3)
    virtual: Virtual = option(default="extrapolate", doc=VIRTUAL, kw_only=True)
    name: str | None = option(
        default=None,
        doc="name in the results (shape and number unless said)",
        kw_only=True,
        min_length=1,
    )
    opens: float | None = option(
        default=None,
        doc="time at which it is taken away, the warm-up included (never unless said)",
        kw_only=True,
        gt=0,
    )

    @property
    def closed_axes(self) -> tuple[Axis, ...]:
        """Axes of the box that it closes."""
        return ()

    @abstractmethod
    def surfaces(self) -> dict[str, Surface]:
        """Its surfaces, by key."""

    @abstractmethod
    def bodies(self, room: Room, label: str) -> list[Body]:
        """Its bodies, one for each surface, named after it or `label`."""

    def period(self, room: Room) -> tuple[float, ...]:
        """Lengths after which it is the same again: those of the box unless it repeats itself."""
        return tuple(map(float, room.size))

    def vectors(self) -> dict[str, Any]:
        """Its parameters that have one number for each axis, by key."""
        return {key: v for key in self.per_axis if (v := getattr(self, key)) is not None}


def closed_axes(walls: Iterable[Wall]) -> set[Axis]:
    """Axes that walls close; the box is periodic along the others."""
    return {axis for wall in walls for axis in wall.closed_axes}


@component
class Shape(Wall):
    """A solid: its place, its surface, and the side of it on which the fluid is."""

    fluid: Literal["outside", "inside"] = option(
        default="outside", doc="side of the surface on which the fluid is", kw_only=True
    )
    surface: Surface = option(default=Surface(), doc="what its surface does", kw_only=True)

    def sided(self, within: Region, room: Room) -> Region:
        """The solid, given what lies within the surface."""
        return complement(within) if self.fluid == "inside" else within

    @abstractmethod
    def body(self, room: Room) -> Region:
        """The region within the surface."""

    @abstractmethod
    def pivot(self, room: Room) -> tuple[float, ...]:
        """The place about which it turns and torques are taken."""

    def pieces(self, room: Room) -> list[Piece]:
        """The solid in this box, in pieces, with what its images put into the box."""
        if self.fluid == "outside":
            return pieces_of(self.body(room), self.pivot(room), room)
        everywhere = tuple(term for term, _ in images(self.body(room), room) if reaches(term, room))
        if math.prod(map(len, everywhere)) > MOST_TERMS:
            raise CaseError(
                "fluid = 'inside': too many parts whose outsides overlap; expected fewer of them"
            )
        return [Piece(term, self.pivot(room)) for term in complement(everywhere)]

    def surfaces(self) -> dict[str, Surface]:
        return {"surface": self.surface}

    def bodies(self, room: Room, label: str) -> list[Body]:
        name = self.name or label
        return [Body(name, self.surface, self.virtual, self.pieces(room), self.turning(room))]

    def turning(self, room: Room) -> tuple[float, ...]:
        """Its rate of rotation, as a vector of three."""
        rate = self.surface.rotation
        if isinstance(rate, tuple):
            return rate
        return tuple((rate or 0.0) * x for x in self.axis_of_rotation(room))

    def axis_of_rotation(self, room: Room) -> tuple[float, ...]:
        """Unit vector about which a rotation given as a number turns."""
        return (0.0, 0.0, 1.0)


class Centred:
    """Mixin of shapes that turn about their centre."""

    centre: Any
    per_axis: ClassVar[tuple[str, ...]] = ("centre",)

    def pivot(self, room: Room) -> tuple[float, ...]:
        return tuple(self.centre)


def positive(lengths: tuple[float, ...] | None) -> tuple[float, ...] | None:
    """Lengths as they are. Raises ValueError if one is not positive."""
    if lengths is not None and not all(x > 0 for x in lengths):
        raise ValueError("expected positive lengths")
    return lengths


def a_direction(axis: Any) -> Any:
    """A letter or a vector as it is. Raises ValueError if the vector gives no direction in 3D."""
    if isinstance(axis, tuple) and not (len(axis) == 3 and any(axis)):
        raise ValueError("expected 'x', 'y', 'z' or three numbers, not all zero")
    return axis


def unit_vector(axis: Any) -> tuple[float, ...]:
    """Along an axis of the box, given by its letter, or along a vector, in 3D."""
    if isinstance(axis, str):
        return tuple(1.0 * (letter == axis) for letter in AXES)
    size = sum(x * x for x in axis) ** 0.5
    return tuple(x / size for x in axis)


# Families of shapes of which others can be made. One lies within the other.


@family("shape to repeat", "shape", "mesokit.shape")
@component
class Repeatable(Shape):
    """A shape of which there can be an array."""


@family("part of a union", "shape", "mesokit.shape")
@component
class Joinable(Repeatable):
    """A shape that can also be part of a union."""


@family("simple shape", "shape", "mesokit.shape")
@component
class Simple(Joinable):
    """A shape that can also be part of an intersection."""


@family("shape with an end", "shape", "mesokit.shape")
@component
class Movable(Simple):
    """A simple shape that has an end, which can also be part of a body that moves."""
