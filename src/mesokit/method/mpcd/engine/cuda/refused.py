"""What devices cannot do yet: refused before a run, never done by the processor in silence."""

from collections.abc import Iterator

from mesokit.case.case import Case


def refused(case: Case, ranks: int = 1) -> Iterator[str]:
    """For each thing in a case that devices cannot do, what is said of the device."""
    if ranks > 1:
        yield f"not on {ranks} ranks yet; expected one rank, or --device cpu"
    if case.bodies:
        yield "no bodies that move yet; expected --device cpu"
