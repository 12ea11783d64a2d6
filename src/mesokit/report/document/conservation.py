"""What was conserved, as a table: a row for each quantity that was followed in time."""

from collections.abc import Iterable

import numpy as np

from mesokit.seam.result import Result

SERIES = "conservation"  # the quantity that is a series of such numbers


def changes(results: Iterable[Result]) -> list[tuple[str, ...]]:
    """Name with unit, first, mean and last value, and largest change since the first sample."""
    found = []
    for result in results:
        if result.quantity != SERIES or not len(result.value):
            continue
        for name, column in zip(result.x["component"], result.value.T, strict=True):
            unit = result.units.get(str(name), "")
            words = f"{str(name).replace('_', ' ')}{f', {unit}' if unit else ''}"
            largest = np.max(np.abs(column - column[0]))
            numbers = (column[0], column.mean(), column[-1], largest)
            found.append((words, *(f"{x:.6g}" for x in numbers)))
    return found
