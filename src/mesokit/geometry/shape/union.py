"""Several shapes as one solid."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

from mesokit.case.component import component, param, tag
from mesokit.case.describe.hints import Many
from mesokit.geometry import region
from mesokit.geometry.composite import middle, require_plain, vectors_of
from mesokit.geometry.shape_protocol import Joinable, Repeatable

if TYPE_CHECKING:
    from mesokit.geometry.region import Room


@component
class Union(Repeatable):
    """Everything that is in any of its parts, with one surface."""

    shape: Literal["union"] = tag("union")
    parts: Many[Joinable] = param(doc="shapes, of which each says where its fluid is", min_length=1)

    def __post_init__(self) -> None:
        require_plain(self.parts, "union")

    def body(self, room: Room) -> region.Region:
        return region.union(part.sided(part.body(room), room) for part in self.parts)

    def pivot(self, room: Room) -> tuple[float, ...]:
        return middle(self.parts, room)

    def vectors(self) -> dict[str, Any]:
        return vectors_of(self.parts)
