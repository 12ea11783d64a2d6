"""Several shapes as one solid."""

from typing import Literal

from mesokit.case.component import component, param, tag
from mesokit.case.describe.hints import Many
from mesokit.geometry.composite import Composite
from mesokit.geometry.region import Region, Room, union
from mesokit.geometry.shape_protocol import Joinable, Repeatable


@component
class Union(Composite, Repeatable):
    """Everything that is in any of its parts, with one surface."""

    shape: Literal["union"] = tag("union")
    parts: Many[Joinable] = param(doc="shapes, of which each says where its fluid is", min_length=1)

    def body(self, room: Room) -> Region:
        return union(part.sided(part.body(room), room) for part in self.parts)
