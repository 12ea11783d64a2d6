"""Particles, beads or molecules of an observable, and whether they are independent of others."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.bodies import every_kind, followed
from mesokit.method.mpcd.molecule import FLUID, Molecule
from mesokit.statistics import spread_ids

KIND = (
    "which molecules: name or number, from 1, of solutes.polymers; 'fluid': those of the fluid, "
    "which are also 1 where there are no solutes"
)


def of_fluid(case: Case, kind: int | str | None) -> bool:
    """Whether a kind of molecules is that of the fluid: named so, or there is no other."""
    return case.solutes is None or (kind == FLUID and case.fluid.molecule is not None)


def molecule_of(case: Case, quantity: str = "this", kind: int | str = 1) -> Molecule:
    """The molecule of the fluid, or a kind of solutes. Raises CaseError if there is no such."""
    solutes = case.solutes
    if solutes is None or of_fluid(case, kind):
        if case.fluid.molecule is None:
            raise CaseError(f"{quantity} needs molecules; give fluid.molecule or solutes")
        if kind not in (1, FLUID):
            raise CaseError(
                f"kind = {show(kind)}: expected 1 or {show(FLUID)} in a fluid of molecules"
            )
        return case.fluid.molecule
    place = solutes.index_of(kind)
    molecule = solutes.molecule(place)
    if molecule is None:
        raise CaseError(f"{quantity} needs molecules; solutes.polymers[#{place + 1}] are monomers")
    return molecule


class Group(NamedTuple):
    """Particles of one kind: the id of the first, beads of a molecule, molecules, what they are."""

    first: int
    length: int
    number: int
    molecule: Molecule | None

    def beads(self, wanted: int | None = None) -> NDArray[np.int64]:
        """Ids (molecules, length) of all molecules, or of some that are evenly spread."""
        chosen = np.arange(self.number) if wanted is None else spread_ids(wanted, self.number)
        return self.first + chosen[:, None] * self.length + np.arange(self.length)


def group_of(case: Case, of: str, kind: int | str | None = 1) -> Group:
    """The group of an observable of "particles" (of the fluid), "bodies", "beads", "centres" or
    "ends".

    Of particles `kind` is the number of a species, None all of them; of others None is the first of
    solutes, or in a fluid of molecules alone these.
    Raises CaseError if there are none.
    """
    if of == "bodies":
        chosen = followed(case, "of = 'bodies'", 1 if kind is None else kind)
        before = sum(group.number for group in case.groups) - sum(b.number for b in case.bodies)
        return Group(before + chosen.rows.start, 1, chosen.number, None)
    molecule, solutes = case.fluid.molecule, case.solutes
    if of == "particles" and (solutes is None or solutes.solvent == "fluid"):
        if case.fluid.species and kind is not None:
            kinds = case.groups[0].kinds
            if not isinstance(kind, int) or not 1 <= kind <= len(kinds):
                raise CaseError(f"kind = {show(kind)}: expected 1 to {len(kinds)} (fluid.species)")
            before = sum(one.number for one in kinds[: kind - 1])
            return Group(before, 1, kinds[kind - 1].number, None)
        if kind not in (None, 1, FLUID):
            raise CaseError(
                f"kind = {show(kind)}: only with of = 'beads', 'centres' or 'ends', or with "
                "fluid.species"
            )
        length = molecule.length if molecule else 1
        return Group(0, length, case.particles // length, molecule)
    kind = 1 if kind is None else kind
    if solutes is None or of_fluid(case, kind):
        found = molecule_of(case, f"of = {of!r}", kind)
        return Group(0, found.length, case.particles // found.length, found)
    if of == "particles":
        raise CaseError("of = 'particles': a random solvent has none; expected 'beads'")
    place = solutes.index_of(kind)
    polymer = solutes.polymers[place]
    if of == "ends":
        molecule_of(case, f"of = {of!r}", kind)
    first = case.particles + solutes.first_bead(place)
    return Group(first, polymer.length, polymer.number, solutes.molecule(place))


def kind_of(case: Case, group: Group) -> int | str:
    """The kind whose molecules are a group."""
    if case.solutes is None or group.first < case.particles:
        return FLUID
    kinds = range(len(case.solutes.polymers))
    starts = [case.particles + case.solutes.first_bead(kind) for kind in kinds]
    return 1 + starts.index(group.first)


def beads_of(case: Case, wanted: int | None = None, kind: int | str = 1) -> NDArray[np.int64]:
    """Ids of the beads (molecules, length) of all molecules, or of some that are evenly spread.

    Beads of solutes are numbered after the particles of the fluid.
    """
    molecule_of(case, kind=kind)
    return group_of(case, "beads", kind).beads(wanted)


def bonds_of(case: Case, kind: int | str = 1) -> slice:
    """Where the bonds of a kind are among all `bond_vectors`, of which the fluid's come first."""
    own, count, first = case.fluid.molecule, 0, 0
    if own is not None:
        first = len(own.bonds) * (case.particles // own.length)
    if case.solutes is None or of_fluid(case, kind):
        return slice(0, first)
    for k in range(case.solutes.index_of(kind) + 1):
        molecule, first = case.solutes.molecule(k), first + count
        count = len(molecule.bonds) * case.solutes.polymers[k].number if molecule else 0
    return slice(first, first + count)


def kinds_of_molecules(case: Case) -> list[int | str]:
    """The molecules of the fluid, and each kind of solutes that are molecules."""
    kinds: list[int | str] = [FLUID] if case.fluid.molecule is not None else []
    if case.solutes is not None:
        polymers = range(len(case.solutes.polymers))
        kinds += [1 + k for k in polymers if case.solutes.molecule(k) is not None]
    return kinds


def default_of(case: Case, of: str | None) -> str:
    """`of` if given; else "beads" of a case with solutes or molecules, "particles" of others."""
    if of is not None:
        return of
    beads = case.solutes is not None or case.fluid.molecule is not None
    return "beads" if beads else "particles"


def groups_of(case: Case, of: str, kind: int | str | None = None) -> list[Group]:
    """Groups of one kind, or of all kinds. Raises CaseError if there are none.

    Beads of all kinds of solutes are a group for each, as bodies are; particles of all species are
    one.
    """
    if kind is None and of == "bodies":
        return [group_of(case, of, one.place + 1) for one in every_kind(case, "of = 'bodies'")]
    if kind is None and of != "particles" and case.solutes is not None:
        kinds = range(1, len(case.solutes.polymers) + 1)
        return [group_of(case, of, number) for number in kinds]
    return [group_of(case, of, kind)]


def independent(case: Case, of: str, groups: list[Group]) -> bool:
    """Whether particles, or molecules as wholes, are independent of all others.

    They are not where walls, a driving force or demixing make the density uneven, nor where solutes
    interact. Bodies have a size, which also beads feel.
    """
    solutes = case.solutes
    if of == "bodies" or case.walls or setting.driven(case) or setting.gathered(case):
        return False
    if solutes is not None and solutes.solvent_pair is not None:
        return False
    if of == "particles" or solutes is None:
        return True
    if case.bodies:
        return False
    beads = [kind for kind in (kind_of(case, group) for group in groups) if kind != FLUID]
    return all(solutes.ideal(solutes.index_of(kind)) for kind in beads)
