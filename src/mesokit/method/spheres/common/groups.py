"""Groups and kinds of spheres, for trajectories, files, pictures and observables."""

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.case.trajectory import Group, Kind
from mesokit.errors import CaseError

NAME = "spheres"
HAVE = ("position", "velocity", "spin", "image", "id", "mass", "diameter")


def groups(case: Case) -> tuple[Group, ...]:
    """One group, kind after kind."""
    section, box, scale = case.spheres, case.box, case.spheres.scale(case.box)
    kinds = tuple(
        Kind(kind.mean_mass(box.dimension), number, kind.name or "", kind.diameter * scale)
        for kind, number in zip(section.kinds, section.counts(box), strict=True)
    )
    have = (*HAVE, "contact") if section.touching else HAVE
    kept = () if case.trajectory is None else case.trajectory.fields
    picture = "force-chains" if {"position", "contact"} <= {*kept} else "disks"
    return (Group(NAME, kinds, have, kT=float(section.kT), picture=picture),)


def ids_of_kind(case: Case, kind: int | str | None) -> NDArray[np.int64]:
    """Numbers (n,) of the spheres of a kind, by its number or name; None means all spheres.

    Raises CaseError if there is no such kind.
    """
    counts = case.spheres.counts(case.box)
    if kind is None:
        return np.arange(sum(counts))
    names = [one.name for one in case.spheres.kinds]
    place = names.index(kind) if kind in names else kind - 1 if isinstance(kind, int) else -1
    if not 0 <= place < len(counts):
        named = "".join(f" or {show(name)}" for name in names if name)
        numbers = "1" if len(counts) == 1 else f"1 to {len(counts)}"
        raise CaseError(f"kind = {show(kind)}: expected {numbers}{named}")
    first = sum(counts[:place])
    return np.arange(first, first + counts[place])


def refuse_molecules(of: str) -> None:
    """Raise CaseError where an observable is of anything but spheres."""
    if of != "particles":
        raise CaseError(f"of = {show(of)}: expected 'particles'; there are no molecules")
