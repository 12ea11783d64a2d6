"""Contacts that bear a load, and sums over them by groups of grains, for error bars.

A packing at rest is the same in all samples, so blocks of time say nothing of its error. Groups of
grains, by their numbers, do: each is like a small packing of its own.
"""

from typing import ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import component, param, show
from mesokit.errors import CaseError
from mesokit.method.spheres.common.observe.protocol import OfSpheres
from mesokit.seam.engine import ContactsNow, TouchingSpheres
from mesokit.seam.estimate import Array, Estimate, of_ratio
from mesokit.seam.observable import BlockAccumulator
from mesokit.statistics import Blocks

GROUPS = 16  # of grains


@component
class OfContacts(OfSpheres):
    """Something measured of contacts that last."""

    methods: ClassVar[tuple[str, ...]] = ("soft-spheres", "contact-dynamics")
    least: float = param(
        1e-6, doc="normal force of a contact that counts, over the mean, at least", unit="", ge=0
    )

    def check(self, case: Case) -> None:
        """Raise CaseError for spheres without lasting contacts."""
        if not case.spheres.touching:
            rule = show(getattr(getattr(case.spheres, "pair", None), "rule", "none"))
            raise CaseError(f"spheres.pair = {{ rule = {rule} }}: expected a law of contact")


class Bearing(NamedTuple):
    """Contacts that bear a load at one time: pairs (m, 2), normals (m, d), and their forces along
    the normals and along the surfaces (m,); pulled: how many others pull."""

    pairs: NDArray[np.int64]
    normals: Array
    normal: Array
    tangential: Array
    pulled: int

    @property
    def at_walls(self) -> NDArray[np.bool_]:
        """Which of them are with a wall."""
        return self.pairs[:, 1] < 0


def bearing(contacts: ContactsNow, least: float, walls: bool = True) -> Bearing:
    """The contacts whose normal force is above `least` of the mean of those that push."""
    kept = np.ones(len(contacts.gaps), bool) if walls else ~contacts.at_walls
    normal = contacts.normal_forces
    pushing = normal[kept & (normal > 0)]
    limit = least * float(pushing.mean()) if len(pushing) else 0.0
    chosen = kept & (normal > limit)
    return Bearing(
        contacts.pairs[chosen],
        contacts.normals[chosen],
        normal[chosen],
        contacts.tangential_forces[chosen],
        int((kept & (normal < -limit)).sum()),
    )


class GroupAccumulator(BlockAccumulator):
    """Block sums of numbers (width) by group of grains."""

    width: int

    def prepare(self) -> None:
        """Make the blocks; a subclass sets `width` first."""
        self.blocks = Blocks((GROUPS, self.width))

    def add(self, group: NDArray[np.int64], rows: Array) -> None:
        """Take one sample: rows (m, width) of grains or contacts, and the group (m,) of each."""
        sums = [np.bincount(group % GROUPS, column, GROUPS) for column in rows.T]
        self.blocks.add(np.stack(sums, axis=1))

    def contacts_of(self, spheres: TouchingSpheres, walls: bool = True) -> Bearing:
        """The contacts that count."""
        return bearing(spheres.contacts(), self.observable.least, walls)

    def ratio(self, above: slice, below: int) -> Estimate:
        """Sums of the columns `above` over that of the column `below`.

        A network at rest outlasts the run, so the error is the larger of those of groups and time.
        """
        sums, _ = self.blocks.sums()
        found = []
        for one in (sums.sum(axis=0), sums.sum(axis=1)):  # of groups, and of blocks of time
            part = one[:, above]
            found.append(of_ratio(part, np.broadcast_to(one[:, [below]], part.shape)))
        whole = np.ones(found[1].value.shape)  # parts of the run over which values are the same
        return found[0]._replace(in_time=found[1]._replace(spans=whole))
