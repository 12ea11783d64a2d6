"""Spheres as trajectories, files for other programs and pictures know them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mesokit.case.trajectory import Group, Kind

if TYPE_CHECKING:
    from mesokit.case.case import Case

NAME = "spheres"
HAVE = ("position", "velocity", "spin", "image", "id", "mass", "diameter")


def groups(case: Case) -> tuple[Group, ...]:
    """One group, kind after kind."""
    section, box = case.spheres, case.box
    scale = section.scale(box)
    kinds = tuple(
        Kind(kind.mean_mass(box.dimension), number, kind.name or "", kind.diameter * scale)
        for kind, number in zip(section.kinds, section.counts(box), strict=True)
    )
    return (Group(NAME, kinds, HAVE, kT=float(section.kT), picture="disks"),)
