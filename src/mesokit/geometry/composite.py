"""What shapes made of other shapes share."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from mesokit.geometry.shape_protocol import Shape
from mesokit.geometry.surface import Surface

if TYPE_CHECKING:
    from mesokit.geometry.region import Room


def require_plain(parts: Sequence[Shape], whole: str) -> None:
    """Raise ValueError for a part with a surface of its own: the whole has one."""
    for i, part in enumerate(parts):
        require_bare(part, f"parts[#{i + 1}]", whole)


def require_bare(part: Shape, key: str, whole: str) -> None:
    """The same for one part, under its key."""
    if part.surface != Surface():
        raise ValueError(f"{key}.surface: give the surface of the {whole} instead")
    if part.virtual != "extrapolate" or part.name is not None:
        own = "name" if part.name is not None else "virtual"
        raise ValueError(f"{key}.{own}: give that of the {whole} instead")


def middle(parts: Sequence[Shape], room: Room) -> tuple[float, ...]:
    """The mean of their pivots."""
    places = [part.pivot(room) for part in parts]
    return tuple(sum(xs) / len(xs) for xs in zip(*places, strict=True))


def vectors_of(parts: Sequence[Shape]) -> dict[str, Any]:
    """Their parameters that have one number for each axis, by key."""
    return {
        f"parts[#{i + 1}].{key}": value
        for i, part in enumerate(parts)
        for key, value in part.vectors().items()
    }
