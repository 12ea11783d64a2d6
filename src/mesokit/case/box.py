"""The box that holds the fluid."""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

from pydantic import field_validator

from mesokit.case.component import component, param
from mesokit.case.describe.hints import Many
from mesokit.errors import CaseError
from mesokit.scalar.elementary import sincos_turn
from mesokit.scalar.intrinsics import floor, with_item
from mesokit.scalar.jit import generic, scalar

Axis = Literal["x", "y", "z"]
AXES: tuple[Axis, ...] = ("x", "y", "z")
TURNS = 0.5 / math.pi  # in a radian


@component
class Box:
    """A rectangular box of whole cells; two sizes make it 2D. Periodic where no wall closes it."""

    size: Many[int] = param(doc="length along each axis: two numbers (2D) or three", unit="a")
    shear_rate: float = param(
        0.0,
        doc="Lees-Edwards shear: flow along x, gradient along y",
        unit="1/time",
        ge=-1e6,
        le=1e6,
    )
    shear_frequency: float = param(
        0.0,
        doc="the shear rate is shear_rate * cos(shear_frequency * time)",
        unit="1/time",
        ge=0,
        le=1e6,
    )

    @field_validator("size")
    @classmethod
    def _two_or_three_lengths(cls, size: tuple[int, ...]) -> tuple[int, ...]:
        if len(size) not in (2, 3):
            raise ValueError("expected two lengths (2D) or three (3D)")
        if min(size) < 2:
            raise ValueError("expected at least 2 cells along each axis")
        return size

    @property
    def density_unit(self) -> str:
        """Unit of a number of particles in a cell.

        >>> Box([8, 8]).density_unit
        '1/a^2'
        """
        return f"1/a^{self.dimension}"

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return len(self.size)

    @property
    def axes(self) -> tuple[Axis, ...]:
        """The names of the axes: x, y and, in 3D, z."""
        return AXES[: self.dimension]

    def index(self, axis: str, key: str = "axis") -> int:
        """0, 1 or 2 for x, y or z. Raises CaseError, which names the key, for z in 2D."""
        index = AXES.index(axis)
        if index >= self.dimension:
            raise CaseError(f"{key} = {axis!r}: a 2D box has only 'x' and 'y'")
        return index

    @property
    def volume(self) -> int:
        """Number of cells."""
        cells = 1
        for length in self.size:
            cells *= length
        return cells

    def kernel(
        self, closed: tuple[bool, ...], time: float = 0.0
    ) -> Periodic | Sheared | Oscillating:
        """Parameters for `fold` at a time; `closed` says which axes walls close."""
        size = tuple(float(length) for length in self.size)
        inverse = tuple(
            0.0 if shut else 1.0 / length for shut, length in zip(closed, size, strict=True)
        )
        if self.shear_rate == 0.0:
            return Periodic(size, inverse)
        speed = self.shear_rate * size[1]
        if self.shear_frequency == 0.0:
            return Sheared(size, inverse, speed, speed * time % size[0])
        return oscillating(size, inverse, speed, self.shear_frequency, time)

    def displacement(self, time: float) -> float:
        """How far the image above has slid since time 0.

        >>> Box([8, 8], shear_rate=0.1).displacement(5.0)
        4.0
        """
        speed = self.shear_rate * self.size[1]
        if self.shear_frequency == 0.0:
            return speed * time
        return speed / self.shear_frequency * math.sin(self.shear_frequency * time)


class Periodic(NamedTuple):
    """Lengths, and their inverses (0 along an axis that walls close)."""

    size: tuple[float, ...]
    inverse: tuple[float, ...]


class Sheared(NamedTuple):
    """A box whose images along y slide along x (Lees and Edwards 1972).

    The image above moves at `speed` and is displaced by `offset` at this time.
    """

    size: tuple[float, ...]
    inverse: tuple[float, ...]
    speed: float
    offset: float


class Oscillating(NamedTuple):
    """The same where the speed is `fastest` times the cosine of `frequency` times the time."""

    size: tuple[float, ...]
    inverse: tuple[float, ...]
    speed: float
    offset: float
    fastest: float
    frequency: float


SLIDING = (Sheared, Oscillating)  # boxes whose images move: what is next to what depends on time


@scalar
def oscillating(size, inverse, fastest, frequency, time):
    """An oscillating box at a time."""
    turns = frequency * time * TURNS
    sine, cosine = sincos_turn(turns - floor(turns))
    offset = fastest / frequency * sine % size[0]
    return Oscillating(size, inverse, fastest * cosine, offset, fastest, frequency)


@generic
def at_time(box, time):
    """The box at a time: under shear its images have moved."""


@at_time.register(Periodic)
def _(box, time):
    return box


@at_time.register(Sheared)
def _(box, time):
    return Sheared(box.size, box.inverse, box.speed, box.speed * time % box.size[0])


@at_time.register(Oscillating)
def _(box, time):
    return oscillating(box.size, box.inverse, box.fastest, box.frequency, time)


@scalar
def images(box, r, shift):
    """How many boxes r + shift is away from the primary one, along each axis, as floats."""
    for k in range(len(r)):
        r = with_item(r, k, floor((r[k] + shift[k]) * box.inverse[k]))
    return r


@generic
def fold(box, r, v, shift):
    """The image whose r + shift lies in the primary box: position, velocity, boxes crossed.

    Under shear the image below or above moves: crossing upwards takes the shear velocity off.
    """


@generic
def unfold(box, r, v, crossed):
    """The image so many boxes on: what `fold` at this time brought back."""


@generic
def slide(box, r, v, shift):
    """`fold`, where it must be done at every step; the crossings are () where it can wait.

    A periodic image is as good as any other. Under shear it is not: velocities of one cell must be
    those of one image.
    """


@fold.register(Periodic)
def _(box, r, v, shift):
    n = images(box, r, shift)
    for k in range(len(r)):
        r = with_item(r, k, r[k] - n[k] * box.size[k])
    return r, v, n


@fold.register(*SLIDING)
def _(box, r, v, shift):
    up = floor((r[1] + shift[1]) * box.inverse[1])  # first, because it moves x
    r = with_item(r, 0, r[0] - up * box.offset)
    v = with_item(v, 0, v[0] - up * box.speed)
    n = images(box, r, shift)
    for k in range(len(r)):
        r = with_item(r, k, r[k] - n[k] * box.size[k])
    return r, v, n


@unfold.register(Periodic)
def _(box, r, v, crossed):
    for k in range(len(r)):
        r = with_item(r, k, r[k] + crossed[k] * box.size[k])
    return r, v


@unfold.register(*SLIDING)
def _(box, r, v, crossed):
    for k in range(len(r)):
        r = with_item(r, k, r[k] + crossed[k] * box.size[k])
    r = with_item(r, 0, r[0] + crossed[1] * box.offset)
    return r, with_item(v, 0, v[0] + crossed[1] * box.speed)


@slide.register(Periodic)
def _(box, r, v, shift):
    return r, v, ()


@slide.register(*SLIDING)
def _(box, r, v, shift):
    return fold(box, r, v, shift)


@generic
def peculiar(box, r, v):
    """Velocity relative to the imposed flow."""


@peculiar.register(Periodic)
def _(box, r, v):
    return v


@peculiar.register(*SLIDING)
def _(box, r, v):
    return with_item(v, 0, v[0] - box.speed * (r[1] / box.size[1] - 0.5))
