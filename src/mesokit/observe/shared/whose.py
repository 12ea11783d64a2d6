"""Whose places are looked at: groups of particles or beads, and whether others matter to them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.molecules import Group, group_of, kind_of
from mesokit.method.mpcd.molecule import FLUID

if TYPE_CHECKING:
    from mesokit.case.case import Case

KIND = "which of spheres.kinds: name, or number from 1 (all spheres unless said)"
OF = "what is looked at (beads where there are any, those of solutes before those of molecules)"


def default_of(case: Case, of: str | None) -> str:
    """What was asked for, or else beads where there are any."""
    if of is not None:
        return of
    if case.particles_have("diameter"):
        return "particles"
    beads = case.solutes is not None or case.fluid.molecule is not None
    return "beads" if beads else "particles"


def groups_of(case: Case, of: str, kind: int | str | None = None) -> list[Group]:
    """Those of a kind, or all. Raises CaseError if there are none.

    Beads of all kinds of solutes are a group for each, particles of all species are one.
    """
    if case.particles_have("diameter"):
        return [_spheres(case, of, kind)]
    if kind is None and of != "particles" and case.solutes is not None:
        kinds = range(1, len(case.solutes.polymers) + 1)
        return [group_of(case, of, number) for number in kinds]
    return [group_of(case, of, kind)]


def _spheres(case: Case, of: str, kind: int | str | None) -> Group:
    """Spheres of a kind, by number or name, or all."""
    if of != "particles":
        raise CaseError(f"of = {show(of)}: expected 'particles'; there are no molecules")
    counts = case.spheres.counts(case.box)
    if kind is None:
        return Group(0, 1, sum(counts), None)
    names = [one.name for one in case.spheres.kinds]
    place = names.index(kind) if kind in names else kind - 1 if isinstance(kind, int) else -1
    if not 0 <= place < len(counts):
        named = "".join(f" or {show(name)}" for name in names if name)
        numbers = "1" if len(counts) == 1 else f"1 to {len(counts)}"
        raise CaseError(f"kind = {show(kind)}: expected {numbers}{named}")
    return Group(sum(counts[:place]), 1, counts[place], None)


def ids_of_kind(case: Case, kind: int | str | None) -> NDArray[np.int64] | None:
    """Numbers (n,) of the spheres of a kind, None of all. Raises CaseError if there are none."""
    if kind is None:
        return None
    if not case.particles_have("diameter"):
        raise CaseError(f"kind = {show(kind)}: of spheres alone")
    return _spheres(case, "particles", kind).beads().ravel()


def at_rest(case: Case) -> bool:
    """Whether nothing drives or gathers what is there, and no wall is in its way."""
    return not (case.walls or setting.driven(case) or setting.gathered(case))


def strangers(case: Case, of: str, groups: list[Group]) -> bool:
    """Whether particles, or molecules as wholes, are independent of all others."""
    if case.particles_have("diameter"):
        return False
    solutes = case.solutes
    if not at_rest(case) or (solutes is not None and solutes.solvent_pair is not None):
        return False
    if of == "particles" or solutes is None:
        return True
    beads = [kind for kind in (kind_of(case, group) for group in groups) if kind != FLUID]
    return all(solutes.ideal(solutes.index_of(kind)) for kind in beads)


def periodic_all_over(case: Case, what: str) -> None:
    """Raise CaseError for a box with sliding images, open ends or walls."""
    if case.box.sheared:
        raise CaseError(f"{what}: not under box.shear_rate, whose images slide")
    if case.walls:
        raise CaseError(f"{what}: not with walls; expected a box without any")
    if case.box.open:
        raise CaseError(f"{what}: not in an open box; expected a periodic one")
