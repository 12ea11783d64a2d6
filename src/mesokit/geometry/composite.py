"""Shapes made of other shapes, which have one surface."""

from typing import Any

from mesokit.geometry.region import Room
from mesokit.geometry.shape_protocol import Shape
from mesokit.geometry.surface import Surface


def require_bare(part: Shape, key: str, whole: str) -> None:
    """Raise ValueError for a part, under its key, with a surface of its own: the whole has one."""
    if part.surface != Surface():
        raise ValueError(f"{key}.surface: give the surface of the {whole} instead")
    if part.virtual != "extrapolate" or part.name is not None:
        own = "name" if part.name is not None else "virtual"
        raise ValueError(f"{key}.{own}: give that of the {whole} instead")


class Composite:
    """Several shapes as one, which turns about the mean of their pivots."""

    shape: Any
    parts: Any

    def __post_init__(self) -> None:
        for i, part in enumerate(self.parts):
            require_bare(part, f"parts[#{i + 1}]", self.shape)

    def pivot(self, room: Room) -> tuple[float, ...]:
        places = [part.pivot(room) for part in self.parts]
        return tuple(sum(xs) / len(xs) for xs in zip(*places, strict=True))

    def vectors(self) -> dict[str, Any]:
        return {
            f"parts[#{i + 1}].{key}": value
            for i, part in enumerate(self.parts)
            for key, value in part.vectors().items()
        }
