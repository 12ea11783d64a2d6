"""Several shapes as one body that moves in the fluid."""

from dataclasses import fields
from typing import ClassVar, Literal

from mesokit.case.component import component, param, show, tag
from mesokit.case.describe.hints import Many
from mesokit.geometry import region
from mesokit.geometry.primitive import MOVABLE
from mesokit.geometry.region import Region, Room
from mesokit.geometry.shape_protocol import Movable
from mesokit.method.mpcd.body.protocol import Body

OF_WALLS = ("surface", "virtual", "opens", "name")  # what a shape has as a wall alone


@component
class UnionBody(Body):
    """Everything that is in any of its parts: a dumbbell, an L, a rotor.

    Parts are shapes of walls, placed in a frame of the body. They are moved so that the centre of
    mass is the origin. Where they overlap, volume and inertia are sampled."""

    dimensions: ClassVar[tuple[int, ...]] = (2, 3)
    shape: Literal["union"] = tag("union")
    parts: Many[Movable] = param(doc="shapes, each in the body's frame", min_length=1)

    def __post_init__(self) -> None:
        super(UnionBody, self).__post_init__()  # noqa: UP008  the decorator makes a new class
        for i, part in enumerate(self.parts, start=1):
            if part.fluid == "inside":
                raise ValueError(f"parts[#{i}].fluid = 'inside': expected a solid")
            for field in fields(part):
                value = getattr(part, field.name)
                if field.name in OF_WALLS and value != getattr(
                    field.default, "default", field.default
                ):
                    raise ValueError(
                        f"parts[#{i}].{field.name} = {show(value)}: not of a part; parts have only "
                        "a shape, and the body has the rest"
                    )
            if part in self.parts[: i - 1]:
                first = self.parts.index(part) + 1
                raise ValueError(f"parts[#{i}]: the same as parts[#{first}]; expected another part")

    def region(self) -> Region:
        return region.union(region_of_part(part) for part in self.parts)


def region_of_part(part: Movable) -> Region:
    """A shape as part of a body."""
    d = 2 if part.dimensions == (2,) else 3
    return part.body(Room((1,) * d, (False,) * d))


def moves(part: Movable) -> bool:
    """Whether a shape can be part of a body: it is convex, and has an end."""
    return all(len(term) == 1 and MOVABLE[term[0].code] for term in region_of_part(part))
