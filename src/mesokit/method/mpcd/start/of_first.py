"""What rank 0 alone reads of a file, of which no part can be read: the others never have it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from mesokit.processes.world import World


class OfFirst:
    """An array (n, d) that is `rows` on rank 0, which deals it to the others; None there."""

    def __init__(self, rows: Any) -> None:
        self.rows = rows


def read_by_first(here: World, read: Callable[[], tuple[Any, ...]]) -> tuple[Any, ...]:
    """Arrays, or None, as one process reads them; of several ranks rank 0 does, and keeps them.

    Raises its MesokitError on all ranks.
    """
    if here.size == 1:
        return read()
    found: list[Any] = []

    def kept() -> list[bool]:
        found.extend(read())
        return [array is not None for array in found]

    there = here.on_root(kept)
    found = found or [None] * len(there)
    return tuple(
        OfFirst(rows) if is_one else None for is_one, rows in zip(there, found, strict=True)
    )


def told_by_first(here: World, read: Callable[[], tuple[Any, ...]]) -> tuple[Any, ...]:
    """The same, where all ranks are to have them whole."""
    return here.on_root(lambda: tuple(None if x is None else np.asarray(x) for x in read()))


def rows_of(array: Any) -> Any:
    """The rows that are here, which is nothing where another rank has them."""
    return array.rows if isinstance(array, OfFirst) else array
