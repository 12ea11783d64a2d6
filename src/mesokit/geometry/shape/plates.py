"""Two parallel plates: a slit."""

from __future__ import annotations

from typing import Literal, NamedTuple

from mesokit.case.box import AXES, Axis
from mesokit.case.component import component, param, tag
from mesokit.geometry import protocol
from mesokit.geometry.region import Room, half_space
from mesokit.geometry.shape_protocol import Body, Piece, Wall
from mesokit.geometry.solids.flight import time_to_fall
from mesokit.geometry.surface import Surface
from mesokit.scalar.intrinsics import floor, mul_add, with_item
from mesokit.scalar.jit import by_type, scalar
from mesokit.scalar.vector import added_scaled, scaled


@component
class Plates(Wall):
    """Two plates at the ends of one axis of the box; the other axes stay periodic."""

    shape: Literal["plates"] = tag("plates")
    axis: Axis = param(doc="axis that the plates close")
    lower: Surface = param(Surface(), doc="the plate at 0")
    upper: Surface = param(Surface(), doc="the plate at the far end")

    @property
    def closed_axes(self) -> tuple[Axis, ...]:
        return (self.axis,)

    def surfaces(self) -> dict[str, Surface]:
        return {"lower": self.lower, "upper": self.upper}

    @property
    def diffuse(self) -> bool:
        """Whether a plate sends particles out at random."""
        return "diffuse" in (self.lower.rule, self.upper.rule)

    @property
    def slips(self) -> bool:
        """Whether both plates let the fluid slide along them."""
        return self.lower.rule == self.upper.rule == "slip"

    def bodies(self, room: Room, label: str) -> list[Body]:
        """The solids behind the plates, for a case that has other walls as well."""
        axis, found, rest = AXES.index(self.axis), [], (0.0, 0.0, 0.0)
        for end, surface in (("lower", self.lower), ("upper", self.upper)):
            up = 1.0 if end == "lower" else -1.0
            place = tuple(
                (0.0 if up > 0 else length) if k == axis else 0.5 * length
                for k, length in enumerate(room.size)
            )
            normal = tuple(up * (k == axis) for k in range(room.dimension))
            pieces = [Piece(term, place) for term in half_space(place, normal)]
            found.append(Body(f"{self.name or label}-{end}", surface, self.virtual, pieces, rest))
        return found

    def kernel(self, size: tuple[int, ...]) -> Slit:
        """Parameters for the scalar functions below."""
        axis = AXES.index(self.axis)
        rest = (0.0,) * len(size)
        return SLITS[axis](
            tuple(float(length) for length in size),
            float(size[axis]),
            self.lower.velocity or rest,
            self.upper.velocity or rest,
            1.0 if self.lower.rule == "slip" else 0.0,
            1.0 if self.upper.rule == "slip" else 0.0,
        )


class Slit(NamedTuple):
    """Fluid in 0 <= height <= width; surface 0 is the lower plate, 1 the upper."""

    size: tuple[float, ...]
    width: float
    lower_velocity: tuple[float, ...]
    upper_velocity: tuple[float, ...]
    lower_slips: float
    upper_slips: float


# A class for each axis, so that picking the height out of a position costs nothing.
class SlitX(Slit):
    """Plates across x."""


class SlitY(Slit):
    """Plates across y."""


class SlitZ(Slit):
    """Plates across z."""


SLITS = SlitX, SlitY, SlitZ


@by_type
def across(solid):
    """The axis that plates close, as a literal."""
    axis = SLITS.index(solid.instance_class)
    return lambda solid: axis


@protocol.touches.register(*SLITS)
def _(solid, clear, r, v, a, time):
    k = across(solid)
    h, end = r[k], mul_add(v[k], time, r[k])
    bend = 0.5 * time * time * abs(a[k])  # no parabola is further from its straight line
    return (min(h, end) - bend <= 0.0) | (max(h, end) + bend >= solid.width)


@protocol.unmet.register(*SLITS)
def _(solid):
    return 0


@protocol.first_hit.register(*SLITS)
def _(solid, r, v, a, time, last):
    k = across(solid)
    below = time_to_fall(r[k], v[k], a[k], time)
    above = time_to_fall(solid.width - r[k], -v[k], -a[k], time)
    return (below, 0) if below < above else (above, 1)


@protocol.leaps.register(*SLITS)
def _(solid, displacement):
    return False


@protocol.free.register(*SLITS)
def _(solid, r, v, a, time):
    return False  # `first_hit` is as quick


@protocol.homed.register(*SLITS)
def _(solid, r):
    return r


@protocol.happens.register(*SLITS)
def _(solid, contact):
    return True


@protocol.surface_of.register(*SLITS)
def _(solid, contact):
    return contact


@protocol.lever.register(*SLITS)
def _(solid, contact, r):
    return scaled(0.0, r)


@protocol.rebound.register(*SLITS)
def _(solid, contact, r, v, chance):
    k = across(solid)
    u = solid.lower_velocity if contact == 0 else solid.upper_velocity
    slips = solid.lower_slips if contact == 0 else solid.upper_slips
    back = added_scaled(scaled(2.0, u), -1.0, v)
    mirrored = with_item(v, k, -v[k])
    return between(solid, r), mirrored if slips > 0.5 else back


@scalar
def between(solid, r):
    """The place between the plates that is nearest to r."""
    k = across(solid)
    return with_item(r, k, min(max(r[k], 0.0), solid.width))


@protocol.settled.register(*SLITS)
def _(solid, r):
    return between(solid, r), True


@protocol.exposed.register(*SLITS)
def _(solid):
    return True


@protocol.facing.register(*SLITS)
def _(solid, away, r):
    k, none = across(solid), scaled(0.0, r)
    low = r[k] < 0.5 * solid.width
    distance = r[k] if low else solid.width - r[k]
    return distance, with_item(none, k, 1.0 if low else -1.0), 0 if low else 1, none


@protocol.nearest_surface.register(*SLITS)
def _(solid, r):
    k = across(solid)
    low = r[k] < 0.5 * solid.width
    clear = r[k] if low else solid.width - r[k]
    slips = solid.lower_slips if low else solid.upper_slips
    foot = with_item(r, k, 0.0 if low else solid.width)
    return abs(clear) if slips > 0.5 else clear, 0 if low else 1, foot


@protocol.surface_flow.register(*SLITS)
def _(solid, term, r):
    return solid.lower_velocity if term == 0 else solid.upper_velocity


@protocol.distance_above.register(*SLITS)
def _(solid, term, r):
    h = r[across(solid)]
    return h if term == 0 else solid.width - h


@protocol.is_clear_cell.register(*SLITS)
def _(solid, r):
    h = r[across(solid)]
    return min(h, solid.width - h) >= 0.5


@protocol.unit_cell.register(*SLITS)
def _(solid, r):
    cell, stride = 0, 1
    for k in range(len(r)):
        length = solid.size[k]
        x = r[k] if k == across(solid) else r[k] - length * floor(r[k] / length)
        cell += min(max(int(x), 0), int(length) - 1) * stride
        stride *= int(length)
    return cell


@protocol.surface_and_lever.register(*SLITS)
def _(solid, term, r):
    return term, scaled(0.0, r)
