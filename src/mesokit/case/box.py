"""The box that holds the fluid."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from pydantic import field_validator

from mesokit.case.component import component, name_of, param, show
from mesokit.case.describe.hints import Many
from mesokit.case.shear import ShearHistory
from mesokit.case.shear.oscillating import OscillatingShear
from mesokit.case.shear.protocol import slid, speed
from mesokit.case.shear.steady import SteadyShear
from mesokit.errors import CaseError
from mesokit.scalar.intrinsics import floor, with_item
from mesokit.scalar.jit import elementwise, generic

Axis = Literal["x", "y", "z"]
AXES: tuple[Axis, ...] = ("x", "y", "z")
if TYPE_CHECKING:
    Length = int  # where a method has cells: the case is checked for whole numbers
else:
    Length = float


@component
class Box:
    """A rectangular box; two sizes make it 2D. Periodic where no wall closes it.

    Sizes are whole numbers of cells for methods that have cells, and numbers of sites for those
    that have a lattice, which may have one axis alone.
    """

    size: Many[Length] = param(doc="length along each axis: two numbers (2D) or three", unit="a")
    shear_rate: float = param(
        0.0,
        doc="Lees-Edwards shear: flow along x, gradient along y",
        symbol=r"\dot\gamma",
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
    open: Many[Axis] = param(
        (), doc="axes along which the box has no bounds, for collision rule 'none' alone"
    )
    shear: ShearHistory | None = param(
        None, doc="how the shear rate changes in time, in place of shear_rate and shear_frequency"
    )

    @field_validator("size")
    @classmethod
    def _up_to_three_lengths(cls, size: tuple[float, ...]) -> tuple[float, ...]:
        if len(size) not in (1, 2, 3):
            raise ValueError("expected two lengths (2D) or three (3D)")
        if not min(size) > 0:
            raise ValueError("expected lengths above 0")
        return tuple(int(length) if length == int(length) else length for length in size)

    @field_validator("open")
    @classmethod
    def _each_axis_once(cls, axes: tuple[Axis, ...]) -> tuple[Axis, ...]:
        return tuple(axis for axis in AXES if axis in axes)

    @property
    def density_unit(self) -> str:
        """Unit of a number of particles in a cell.

        >>> Box([8, 8]).density_unit
        '1/a^2'
        """
        return f"1/a^{self.dimension}"

    @property
    def dimension(self) -> int:
        """2 or 3; 1 for a chain of sites."""
        return len(self.size)

    @property
    def axes(self) -> tuple[Axis, ...]:
        """The names of the axes: x, y and, in 3D, z."""
        return AXES[: self.dimension]

    def index(self, axis: str, key: str = "axis") -> int:
        """0, 1 or 2 for x, y or z. Raises CaseError, which names the key, for z in 2D."""
        index = AXES.index(axis)
        if index >= self.dimension:
            have = "'x'" if self.dimension == 1 else "'x' and 'y'"
            raise CaseError(f"{key} = {axis!r}: a {self.dimension}D box has only {have}")
        return index

    @property
    def volume(self) -> int:
        """Area or volume: the number of cells where there are cells."""
        return math.prod(self.size)

    @property
    def history(self) -> ShearHistory | None:
        """History of the shear rate, whichever keys define it; None without shear.

        >>> Box([8, 8], shear_rate=0.1).history
        SteadyShear(rule='steady', rate=0.1)
        """
        if self.shear_rate and self.shear_frequency:
            return OscillatingShear(self.shear_rate, self.shear_frequency)
        if self.shear_rate:
            return SteadyShear(self.shear_rate)
        return self.shear if self.sheared else None

    @property
    def sheared(self) -> bool:
        """True if images ever move."""
        return bool(self.shear_rate or (self.shear is not None and self.shear.largest))

    @property
    def shear_key(self) -> str:
        """The key of the shear and its value, as messages name it.

        >>> Box([8, 8], shear_rate=0.1).shear_key
        'box.shear_rate = 0.1'
        """
        if self.shear is not None:
            return f"box.shear.rule = {show(name_of(self.shear))}"
        return f"box.shear_rate = {show(self.shear_rate)}"

    @property
    def steady_rate(self) -> float:
        """The shear rate if it is the same at all times; 0 where it changes, or there is none."""
        return self.first_rate if self.history and self.history.steady else 0.0

    @property
    def first_rate(self) -> float:
        """The shear rate at time 0."""
        return self.history.rate_at(0.0) if self.history else 0.0

    @property
    def largest_rate(self) -> float:
        """Largest size of the shear rate."""
        return self.history.largest if self.history else 0.0

    @property
    def oscillation(self) -> OscillatingShear | None:
        """The shear, if it oscillates."""
        return self.history if isinstance(self.history, OscillatingShear) else None

    def kernel(
        self, closed: tuple[bool, ...], time: float = 0.0, timestep: float = 0.0
    ) -> Periodic | Sheared:
        """Parameters for `fold` after a step that ends at a time; walls close the axes `closed`."""
        size = tuple(float(length) for length in self.size)
        inverse = tuple(
            0.0 if shut or axis in self.open else 1.0 / length
            for shut, length, axis in zip(closed, size, self.axes, strict=True)
        )
        history = self.history
        if history is None:
            return Periodic(size, inverse)
        kernel, lag = history.kernel(size[1]), 0.5 * timestep
        offset = slid(kernel, time) % size[0]
        return Sheared(size, inverse, speed(kernel, time - lag), offset, lag, kernel)

    def displacement(self, time: float) -> float:
        """How far the image above has slid since time 0.

        >>> Box([8, 8], shear_rate=0.1).displacement(5.0)
        4.0
        """
        history = self.history
        return 0.0 if history is None else float(slid(history.kernel(float(self.size[1])), time))


class Periodic(NamedTuple):
    """Lengths, and their inverses (0 along an axis that walls close or that is open)."""

    size: tuple[float, ...]
    inverse: tuple[float, ...]


class Sheared(NamedTuple):
    """A box whose images along y slide along x (Lees and Edwards 1972).

    At this time the image above is displaced by `offset`. Its `speed` is that of the middle of the
    step that ends now, a `lag` of half a timestep ago: a step that ends as the shear begins is
    not sheared. `history` is the kernel of both.
    """

    size: tuple[float, ...]
    inverse: tuple[float, ...]
    speed: float
    offset: float
    lag: float
    history: Any


SLIDING = (Sheared,)  # boxes whose images move: what is next to what depends on time


@generic
def at_time(box, time):
    """The box at a time: under shear its images have moved."""


at_time.register(Periodic)(lambda box, time: box)


@at_time.register(Sheared)
def _(box, time):
    offset, fast = slid(box.history, time) % box.size[0], speed(box.history, time - box.lag)
    return Sheared(box.size, box.inverse, fast, offset, box.lag, box.history)


@elementwise
def images(box, r, shift):
    """How many boxes r + shift is away from the primary one, along each axis, as floats."""
    return "floor((r[{k}] + shift[{k}]) * box.inverse[{k}])"


@elementwise
def _boxes_back(box, r, n):
    """The place so many boxes back along each axis."""
    return "r[{k}] - n[{k}] * box.size[{k}]"


@elementwise
def _boxes_on(box, r, n):
    """The place so many boxes on along each axis."""
    return "r[{k}] + n[{k}] * box.size[{k}]"


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
    return _boxes_back(box, r, n), v, n


@fold.register(*SLIDING)
def _(box, r, v, shift):
    up = floor((r[1] + shift[1]) * box.inverse[1])  # first, because it moves x
    r = with_item(r, 0, r[0] - up * box.offset)
    v = with_item(v, 0, v[0] - up * box.speed)
    n = images(box, r, shift)
    return _boxes_back(box, r, n), v, n


@unfold.register(Periodic)
def _(box, r, v, crossed):
    return _boxes_on(box, r, crossed), v


@unfold.register(*SLIDING)
def _(box, r, v, crossed):
    r = _boxes_on(box, r, crossed)
    r = with_item(r, 0, r[0] + crossed[1] * box.offset)
    return r, with_item(v, 0, v[0] + crossed[1] * box.speed)


slide.register(Periodic)(lambda box, r, v, shift: (r, v, ()))


slide.register(*SLIDING)(lambda box, r, v, shift: fold(box, r, v, shift))


@generic
def peculiar(box, r, v):
    """Velocity relative to the imposed flow."""


peculiar.register(Periodic)(lambda box, r, v: v)


@peculiar.register(*SLIDING)
def _(box, r, v):
    return with_item(v, 0, v[0] - box.speed * (r[1] / box.size[1] - 0.5))
