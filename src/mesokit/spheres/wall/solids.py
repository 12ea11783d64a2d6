"""The walls of a case of spheres, as files and pictures know them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mesokit.geometry import shape_protocol
from mesokit.geometry.solids.solids import solids_of

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.geometry.solids.solids import Solids


def closed_axes(case: Case) -> set[int]:
    """Numbers of the axes that walls close."""
    return {case.box.axes.index(axis) for axis in shape_protocol.closed_axes(case.walls)}


def solids(case: Case) -> Solids | None:
    """The solids that pictures show, None without any."""
    return solids_of(case) if case.walls else None
