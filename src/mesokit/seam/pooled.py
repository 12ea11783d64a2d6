"""Samples of several runs as one."""

from mesokit.case.component import show
from mesokit.errors import RunError
from mesokit.seam.observable import Accumulator


def pool(name: str, accumulator: Accumulator, other: Accumulator) -> None:
    """Add the samples of another run to those of an observable.

    Raises RunError where they cannot be pooled.
    """
    if not hasattr(accumulator, "pool"):
        raise RunError(
            f"observable {show(name)}: its runs cannot be pooled; {type(accumulator).__name__} has "
            "no method pool"
        )
    try:
        accumulator.pool(other)
    except ValueError as error:
        raise RunError(f"observable {show(name)}: {error}") from None
