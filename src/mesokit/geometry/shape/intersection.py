"""What several shapes have in common, as one solid."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

from mesokit.case.component import component, param, tag
from mesokit.case.describe.hints import Many
from mesokit.geometry import region
from mesokit.geometry.composite import middle, require_plain, vectors_of
from mesokit.geometry.shape_protocol import Joinable, Simple

if TYPE_CHECKING:
    from mesokit.geometry.region import Room


@component
class Intersection(Joinable):
    """Everything that is in all of its parts, with one surface."""

    shape: Literal["intersection"] = tag("intersection")
    parts: Many[Simple] = param(doc="shapes, of which each says where its fluid is", min_length=1)

    def __post_init__(self) -> None:
        require_plain(self.parts, "intersection")

    def body(self, room: Room) -> region.Region:
        return region.intersection(part.sided(part.body(room), room) for part in self.parts)

    def pivot(self, room: Room) -> tuple[float, ...]:
        return middle(self.parts, room)

    def vectors(self) -> dict[str, Any]:
        return vectors_of(self.parts)
