"""Particles or beads that an observable selects, and whether they are independent of others."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.molecules import Group, group_of, kind_of
from mesokit.method.mpcd.molecule import FLUID

if TYPE_CHECKING:
    from mesokit.case.case import Case


def default_of(case: Case, of: str | None) -> str:
    """`of` if given; else "beads" of a case with solutes or molecules, "particles" of others."""
    if of is not None:
        return of
    beads = case.solutes is not None or case.fluid.molecule is not None
    return "beads" if beads else "particles"


def groups_of(case: Case, of: str, kind: int | str | None = None) -> list[Group]:
    """Groups of one kind, or of all kinds. Raises CaseError if there are none.

    Beads of all kinds of solutes are a group for each, particles of all species are one.
    """
    if kind is None and of != "particles" and case.solutes is not None:
        kinds = range(1, len(case.solutes.polymers) + 1)
        return [group_of(case, of, number) for number in kinds]
    return [group_of(case, of, kind)]


def independent(case: Case, of: str, groups: list[Group]) -> bool:
    """Whether particles, or molecules as wholes, are independent of all others.

    They are not where walls, a driving force or demixing make the density uneven, nor where solutes
    interact.
    """
    solutes = case.solutes
    if case.walls or setting.driven(case) or setting.gathered(case):
        return False
    if solutes is not None and solutes.solvent_pair is not None:
        return False
    if of == "particles" or solutes is None:
        return True
    beads = [kind for kind in (kind_of(case, group) for group in groups) if kind != FLUID]
    return all(solutes.ideal(solutes.index_of(kind)) for kind in beads)
