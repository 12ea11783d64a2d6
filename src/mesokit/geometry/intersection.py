"""What several shapes have in common, as one solid."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

from mesokit.component import component, param, tag
from mesokit.geometry import region
from mesokit.geometry.capsule import Capsule
from mesokit.geometry.cuboid import Cuboid
from mesokit.geometry.cylinder import Cylinder
from mesokit.geometry.disk import Disk
from mesokit.geometry.half_space import HalfSpace
from mesokit.geometry.rectangle import Rectangle
from mesokit.geometry.shape import Shape
from mesokit.geometry.sphere import Sphere
from mesokit.geometry.together import middle, require_plain

if TYPE_CHECKING:
    from mesokit.geometry.region import Room

Simple = HalfSpace | Disk | Cylinder | Sphere | Rectangle | Cuboid | Capsule


@component
class Intersection(Shape):
    """Everything that is in all of its parts, with one surface."""

    shape: Literal["intersection"] = tag("intersection")
    parts: tuple[Simple, ...] = param(
        doc="shapes, of which each says where its fluid is", min_length=1
    )

    def __post_init__(self) -> None:
        require_plain(self.parts, "intersection")

    def body(self, room: Room) -> region.Region:
        """What lies within the surface."""
        return region.intersection(part.sided(part.body(room), room) for part in self.parts)

    def pivot(self, room: Room) -> tuple[float, ...]:
        """The place about which it turns and torques are taken."""
        return middle(self.parts, room)

    def vectors(self) -> dict[str, Any]:
        """Its parameters that have one number for each axis, by key."""
        return {
            f"parts[#{i + 1}].{key}": value
            for i, part in enumerate(self.parts)
            for key, value in part.vectors().items()
        }
