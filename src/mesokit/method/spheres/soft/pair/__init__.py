"""Pair laws of soft spheres. A new law of contact is a file here; potentials are in
`mesokit.potential`."""

from mesokit.case.registry import FAMILIES, parts_in
from mesokit.method.spheres.soft.pair.protocol import ContactLaw, PairLaw
from mesokit.potential import Pair

__getattr__ = parts_in(__name__, CONTACT_LAWS=PairLaw)
for _rule, _potential in FAMILIES[Pair].parts.items():
    FAMILIES[PairLaw].add(_rule, _potential)

__all__ = ["CONTACT_LAWS", "ContactLaw", "PairLaw"]
