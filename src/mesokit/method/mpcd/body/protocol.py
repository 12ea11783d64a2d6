"""Rigid bodies that move in the fluid: equal ones of a kind, and what acts on them."""

from __future__ import annotations

import functools
import math
import numbers
import re
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any, ClassVar, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import field_validator, model_validator
from pydantic_core import ArgsKwargs

from mesokit.case.component import component, name_of, option, param, show
from mesokit.case.describe.hints import Either, Many
from mesokit.case.given.file import FileName
from mesokit.case.registry import family
from mesokit.geometry.region import Region

if TYPE_CHECKING:
    from mesokit.method.mpcd.body.inertia import Solid

Floats = NDArray[np.float64]
Direction = Literal["x", "y", "z", "orientation"]
NEARLY_UNIT = 1e-3  # error of the length of a quaternion, which rows of three digits have
RANDOM, LATTICE, GIVEN, RUN, FILE = "random", "lattice", "given", "run", "file"


@component
class GapPotential:
    """Repulsion of two surfaces, or of a surface and a wall, by the gap between them.

    It is the potential of Weeks, Chandler and Andersen (1971) of the gap: it diverges at contact
    and ends at `range`."""

    depth: float = param(1.0, doc="energy scale; 0 for no repulsion", unit="kT", ge=0, le=1e6)
    range: float = param(0.5, doc="gap at which it ends", unit="a", ge=0.25, le=10)


@component
class BodyTrap:
    """Springs that hold each body of a kind: to a place, to an orientation, or to both."""

    k: float = param(0.0, doc="stiffness of the spring to a place", unit="kT/a^2", ge=0, le=1e9)
    centre: Many[float] | None = param(
        None, doc="that place (where each body starts unless said)", unit="a"
    )
    angular: float = param(
        0.0,
        doc="stiffness of the spring that turns the body's axis x to a direction",
        unit="kT",
        ge=0,
        le=1e9,
    )
    direction: Many[float] | None = param(None, doc="that direction (axis x of the box)")

    def __post_init__(self) -> None:
        if self.k == 0 and self.angular == 0:
            raise ValueError("k: missing; a trap needs k, angular or both")
        for key, needed in (("centre", "k"), ("direction", "angular")):
            if getattr(self, key) is not None and getattr(self, needed) == 0:
                raise ValueError(f"{key} = {show(getattr(self, key))}: needs {needed}, a stiffness")
        if self.direction is not None and not any(self.direction):
            raise ValueError(f"direction = {show(self.direction)}: expected a vector other than 0")


@component
class Squirming:
    """Velocity of a surface along itself, by which a body swims.

    At an angle theta from the body's axis x it is B1 sin theta + B2 sin theta cos theta on a
    sphere, B1 sin theta + B2 sin 2 theta on a disk, towards larger angles. On a spheroid it is
    (B1 + B2 x/a) t_x along the tangent t, on an ellipse (B1 + 2 B2 x/a) t_x, at the height x
    along an axis of half length a (Lighthill 1952, Blake 1971, Keller and Wu 1977, Theers et al.
    2016). A pusher has a B2 of the other sign than B1."""

    B1: float = param(0.0, doc="first mode, which moves the body", unit="a/time", ge=-1e3, le=1e3)
    B2: float = param(0.0, doc="second mode, which stirs the fluid", unit="a/time", ge=-1e3, le=1e3)
    tumble_rate: float = param(
        0.0, doc="mean number of turns in a unit of time (run and tumble)", unit="1/time", ge=0
    )

    def __post_init__(self) -> None:
        if self.B1 == 0 and self.B2 == 0:
            raise ValueError("B1 = 0: a squirmer needs B1, B2 or both other than 0")


@component
class CounterForce:
    """Where the fluid nearby takes the opposite of the constant force and torque on a body, so that
    the momentum of both stays: the force in a ball, the torque in a shell around the body."""

    at: Many[float] | None = param(
        None, doc="middle of the ball, in the body's frame; the counter-force acts there", unit="a"
    )
    radius: float = param(1.0, doc="of this ball", unit="a", ge=0.5, le=100)
    shell: float = param(
        0.0, doc="thickness of the shell that takes the counter-torque; 0 for none", unit="a", ge=0
    )

    def __post_init__(self) -> None:
        if self.at is None and self.shell == 0:
            raise ValueError("at: missing; a counter needs at, a shell above 0, or both")

    def volume(self, solid: Solid, dimension: int) -> float:
        """Of ball and shell, at most."""
        unit = math.pi if dimension == 2 else 4.0 / 3.0 * math.pi
        ball = 0.0 if self.at is None else unit * self.radius**dimension
        outer = unit * (solid.radius + self.shell) ** dimension - solid.volume
        return ball + (outer if self.shell else 0.0)


ROWS = "expected a list of rows, one for each body, {}of finite numbers, or a file in quotes"
Rows = Either[FileName | None, tuple[float, ...]]


def _finite(given: Any) -> float:
    """A finite number. Raises TypeError for anything else."""
    if not isinstance(given, numbers.Real) or isinstance(given, bool):
        raise TypeError
    try:
        number = float(given)
    except OverflowError:
        raise TypeError from None
    if not math.isfinite(number):
        raise TypeError
    return number


def _one_row(given: Any) -> str:
    """Numbers that stand without the brackets of their row, with these, as an example."""
    try:
        row = [_finite(x) for x in given]
    except TypeError:
        return ""
    return f"such as {show([row])}, " if row else ""


@component
class BodyStart:
    """First places and orientations: drawn without overlap, on a lattice, given, or those of an
    earlier run or of a file.

    Rows are lists, or files .npy or .npz with an array of as many rows as there are bodies."""

    rule: Literal["random", "lattice", "given", "run", "file"] = param(
        "random", doc="'random' draws places without overlap, 'lattice' is a square or cubic one"
    )
    positions: Rows = param(None, doc="a row for each body, with rule = 'given'", unit="a")
    orientations: Rows = param(
        None,
        doc="a row for each body: quaternion w, x, y, z, in 2D the angle in degrees (drawn; on a "
        "lattice, and with given positions, those of the box)",
    )
    velocities: Rows = param(None, doc="a row for each body (drawn unless said)", unit="a/time")
    spins: Rows = param(
        None,
        doc="angular velocities, a row for each body: 3 numbers along the axes of the box, in 2D 1 "
        "number (drawn unless said)",
        unit="1/time",
    )
    run: FileName | None = param(None, doc="folder of an earlier run: its last state")
    file: FileName | None = param(None, doc="GSD file: its last frame unless said")
    frame: int | None = param(None, doc="number of the frame, from 0", ge=0)
    kind: str | None = param(None, doc="name of these bodies there (the same unless said)")
    moving: bool = param(
        True, doc="with the velocities and spins of the run or file; if not, drawn ones"
    )

    @field_validator("positions", "orientations", "velocities", "spins", mode="before")
    @classmethod
    def _of_rows(cls, given: Any) -> Any:
        if given is None or isinstance(given, str):
            return given
        try:
            rows = [[_finite(x) for x in row] for row in given]
        except TypeError:
            raise ValueError(ROWS.format(_one_row(given))) from None
        return tuple(map(tuple, rows))

    def __post_init__(self) -> None:
        for key, rule in (("positions", GIVEN), ("run", RUN), ("file", FILE)):
            there = getattr(self, key) is not None
            if there != (self.rule == rule):
                if there:
                    raise ValueError(f"{key}: only with rule = '{rule}'")
                what = "them" if key == "positions" else "it"
                raise ValueError(f"{key}: missing; rule = '{rule}' needs {what}")
        for key in ("orientations", "velocities", "spins") if self.known_elsewhere else ():
            if getattr(self, key) is not None:
                raise ValueError(f"{key}: not with rule = {show(self.rule)}, which has them")
        if self.frame is not None and self.rule != FILE:
            raise ValueError(f"frame = {self.frame}: only with rule = 'file'")
        if self.kind is not None and not self.known_elsewhere:
            raise ValueError(f"kind = {show(self.kind)}: only with rule = 'run' or 'file'")
        if not (self.moving or self.known_elsewhere):
            raise ValueError("moving = false: only with rule = 'run' or 'file'")
        rows = self.orientations
        for i, row in enumerate(() if rows is None or isinstance(rows, str) else rows, start=1):
            if len(row) == 4 and abs(math.hypot(*row) - 1.0) > NEARLY_UNIT:
                raise ValueError(
                    f"orientations[#{i}] = {show(row)}: expected a unit quaternion, not one of "
                    f"length {math.hypot(*row):.4g}"
                )

    @property
    def known_elsewhere(self) -> bool:
        """Whether an earlier run or a file has the bodies."""
        return self.rule in (RUN, FILE)


@family("body", "shape", "mesokit.body")
@component
class Body(ABC):
    """A kind of rigid bodies that move in the fluid."""

    dimensions: ClassVar[tuple[int, ...]] = (2, 3)
    squirms: ClassVar[bool] = False  # whether its surface may have a `swim`
    tumbles: ClassVar[bool] = False  # whether that may turn it at once, for which it must be round

    number: int = option(default=1, doc="bodies of this kind", kw_only=True, ge=1, le=2**24)
    name: str | None = option(
        default=None,
        doc="name in the results (shape and number unless said)",
        kw_only=True,
        min_length=1,
    )
    density: float | None = option(
        default=None,
        doc="mass per volume of the body (that of the fluid unless said)",
        kw_only=True,
        unit="m/a^d",
        gt=0,
        le=1e9,
    )
    mass: float | None = option(
        default=None,
        doc="mass of the body, instead of a density",
        kw_only=True,
        unit="m",
        gt=0,
        le=1e15,
    )
    surface: Literal["no-slip", "slip"] = option(
        default="no-slip",
        doc="'no-slip' bounces particles back, 'slip' reflects them like a mirror",
        kw_only=True,
    )
    virtual: Literal["fill", "none"] = option(
        default="fill",
        doc="virtual particles in the cells that the surface cuts: 'fill' the inside with a gas at "
        "the body's velocity, or 'none', as always with a slip surface",
        kw_only=True,
    )
    force: Many[float] | None = option(
        default=None, doc="constant force on each", kw_only=True, unit="kT/a"
    )
    torque: Either[float | None, float] = option(
        default=None,
        doc="constant torque on each: a number in 2D, a vector in 3D",
        kw_only=True,
        unit="kT",
    )
    frame: Literal["box", "body"] = option(
        default="box", doc="whose axes force and torque are along", kw_only=True
    )
    counter_force: bool = option(
        default=False,
        doc="accelerate all fluid and bodies uniformly so that their momentum stays",
        kw_only=True,
    )
    counter: CounterForce | None = option(
        default=None,
        doc="where the fluid nearby takes the opposite of force and torque (a swimmer)",
        kw_only=True,
    )
    fixed: Many[Direction] = option(
        default=(),
        doc="what does not move: any of 'x', 'y', 'z' (its place), 'orientation'",
        kw_only=True,
    )
    hinge: Many[float] | None = option(
        default=None, doc="axis of the box about which alone it turns", kw_only=True
    )
    trap: BodyTrap | None = option(default=None, doc="springs that hold it", kw_only=True)
    interaction: GapPotential = option(
        default=GapPotential(),
        doc="repulsion of bodies and walls by the gap; depth = 0 for none",
        kw_only=True,
    )
    swim: Squirming | None = option(
        default=None, doc="velocity of its surface, by which it swims", kw_only=True
    )
    start: BodyStart = option(
        default=BodyStart(), doc="first places, orientations, velocities", kw_only=True
    )

    @model_validator(mode="before")
    @classmethod
    def _empty_beside_slip(cls, given: Any) -> Any:
        """A slip surface has no virtual particles, which it may say as well."""
        values = given.kwargs if isinstance(given, ArgsKwargs) else given
        if not isinstance(values, dict) or values.get("surface") != "slip":
            return given
        if values.get("virtual") == "fill":
            raise ValueError(
                "virtual = 'fill': not with surface = 'slip', which has no virtual particles; "
                "expected 'none'"
            )
        values = {"virtual": "none", **values}
        return ArgsKwargs(given.args, values) if isinstance(given, ArgsKwargs) else values

    @field_validator("name")
    @classmethod
    def _one_word(cls, name: str | None) -> str | None:
        if name is not None and name.isdigit():
            raise ValueError("expected a name that is no number: kinds have numbers as well")
        if name is not None and not re.fullmatch(r"[\w.+-]+", name):
            raise ValueError(
                "expected letters, digits, '-', '_', '+' and '.' alone: files of "
                "trajectories have it as one word"
            )
        return name

    @field_validator("fixed")
    @classmethod
    def _each_once(cls, fixed: tuple[str, ...]) -> tuple[str, ...]:
        return tuple(name for name in ("x", "y", "z", "orientation") if name in fixed)

    def __post_init__(self) -> None:
        if self.mass is not None and self.density is not None:
            given = f"density = {show(self.density)}"
            raise ValueError(f"{given}: not with mass = {show(self.mass)}; give one of them")
        if self.hinge is not None and not any(self.hinge):
            raise ValueError(f"hinge = {show(self.hinge)}: expected a vector other than 0")
        if self.hinge is not None and "orientation" in self.fixed:
            raise ValueError("hinge: not with fixed = 'orientation', which never turns")
        if self.frame == "body" and self.force is None and self.torque is None:
            raise ValueError("frame = 'body': needs a force or a torque, whose axes it says")
        if self.counter is not None:
            self._check_counter(self.counter)
        if self.swim is not None and not self.squirms:
            raise ValueError("swim: only of a sphere, disk, spheroid or ellipse")
        if self.swim is not None and self.surface == "slip":
            raise ValueError("swim: not with surface = 'slip', which drags no fluid along")
        turned = self.surface == "slip" and np.any(self.torque or 0.0)
        if turned and all(self.solid(d).ball for d in self.dimensions):
            raise ValueError(
                f"torque = {show(self.torque)}: not on a ball with surface = 'slip', whose spin "
                "nothing slows"
            )
        if self.swim is not None and self.swim.tumble_rate:
            held = "a hinge" if self.hinge is not None else "fixed = 'orientation'"
            if self.hinge is not None or "orientation" in self.fixed:
                rate = show(self.swim.tumble_rate)
                raise ValueError(f"swim.tumble_rate = {rate}: not with {held}; leave one out")

    def _check_counter(self, counter: CounterForce) -> None:
        if self.counter_force:
            raise ValueError("counter: not with counter_force = true; give one of them")
        if counter.at is not None and not (self.force is not None and any(self.force)):
            raise ValueError(f"counter.at = {show(counter.at)}: needs a force, whose opposite acts")
        if counter.at is not None and self.frame != "body":
            raise ValueError(
                f"counter.at = {show(counter.at)}: needs frame = 'body', as the place turns with it"
            )
        if counter.shell and not np.any(self.torque or 0.0):
            raise ValueError(
                f"counter.shell = {show(counter.shell)}: needs a torque, whose opposite acts there"
            )

    @abstractmethod
    def region(self) -> Region:
        """Its parts in its own frame, each a convex primitive."""

    @property
    def half_axis(self) -> float:
        """From the centre of a squirmer to an end of its axis."""
        return 1.0

    @property
    def aspect(self) -> float:
        """Of a squirmer: its axis over its width."""
        return 1.0

    def solid(self, dimension: int) -> Solid:
        """Volume, inertia and parts about the centre of mass, in 2D or 3D."""
        return _solid(self.region(), dimension == 2)

    def forward(self, dimension: int) -> tuple[float, ...]:
        """From its centre to its front, in cells, along its own axes (d,); () without a front.

        The front is the end towards which it swims, or towards which a force along its own axes
        drives it; that is as far as its radius.
        """
        if self.swim is not None and self.swim.B1:
            return (math.copysign(self.half_axis, self.swim.B1), *(0.0,) * (dimension - 1))
        if self.force is None or self.frame != "body" or not any(self.force):
            return ()
        size = self.solid(dimension).radius / math.hypot(*self.force)
        return tuple(size * component for component in self.force)

    @property
    def balanced(self) -> bool:
        """Whether something takes the opposite of its force."""
        return self.counter_force or (self.counter is not None and self.counter.at is not None)

    def mass_in(self, dimension: int, fluid_density: float) -> float:
        """Its mass, in a fluid of this mass per volume."""
        if self.mass is not None:
            return self.mass
        return (self.density or fluid_density) * self.solid(dimension).volume


@functools.lru_cache(maxsize=64)
def _solid(region: Region, planar: bool) -> Solid:
    from mesokit.method.mpcd.body.inertia import solid_of

    return solid_of(region, planar)


class Named(NamedTuple):
    """A kind of bodies and its name."""

    name: str
    kind: Any


def named(bodies: tuple[Any, ...]) -> list[Named]:
    """All kinds with their names: given, or shape and number."""
    numbers: dict[str, int] = {}
    found = []
    for kind in bodies:
        shape = name_of(kind)
        number = numbers[shape] = numbers.get(shape, 0) + 1
        found.append(Named(kind.name or f"{shape}-{number}", kind))
    return found
