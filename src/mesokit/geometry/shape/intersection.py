"""The common part of several shapes as one solid."""

from typing import Literal

from mesokit.case.component import component, param, tag
from mesokit.case.describe.hints import Many
from mesokit.geometry.composite import Composite
from mesokit.geometry.region import Region, Room, intersection
from mesokit.geometry.shape_protocol import Joinable, Simple


@component
class Intersection(Composite, Joinable):
    """Everything that is in all of its parts, with one surface."""

    shape: Literal["intersection"] = tag("intersection")
    parts: Many[Simple] = param(doc="shapes, of which each says where its fluid is", min_length=1)

    def body(self, room: Room) -> Region:
        return intersection(part.sided(part.body(room), room) for part in self.parts)
