"""Refusal of bad input, with the argument, its value and what was expected."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike


def positive(**values: float) -> None:
    """Raise ValueError unless every named value is a finite number above zero."""
    for name, value in values.items():
        if not (math.isfinite(value) and value > 0):
            raise ValueError(f"{name} = {value!r}: expected a finite number above 0")


def one_of(allowed: Sequence[object], **values: object) -> None:
    """Raise ValueError unless every named value is among those allowed."""
    for name, value in values.items():
        if value not in allowed:
            raise ValueError(f"{name} = {value!r}: expected one of {', '.join(map(repr, allowed))}")


def dimension_two_or_three(dimension: int) -> None:
    """Raise ValueError unless the dimension is 2 or 3."""
    one_of((2, 3), dimension=dimension)


def not_negative(**values: float) -> None:
    """Raise ValueError unless every named value is a finite number of 0 or more."""
    for name, value in values.items():
        if not (math.isfinite(value) and value >= 0):
            raise ValueError(f"{name} = {value!r}: expected a finite number of 0 or more")


def whole(least: int, **values: int) -> None:
    """Raise ValueError unless every named value is a whole number, not below the least."""
    for name, value in values.items():
        if value != int(value) or value < least:
            raise ValueError(f"{name} = {value!r}: expected a whole number of {least} or more")


def none_negative(**values: ArrayLike) -> None:
    """Raise ValueError unless every number of every named array is finite, and 0 or more."""
    for name, value in values.items():
        given = np.atleast_1d(np.asarray(value, float))
        wrong = given[~(np.isfinite(given) & (given >= 0))]
        if wrong.size:
            raise ValueError(f"{name} = {wrong[0]:g}: expected finite numbers of 0 or more")


def all_positive(**values: ArrayLike) -> None:
    """Raise ValueError unless every number of every named array is finite, and above 0."""
    for name, value in values.items():
        given = np.atleast_1d(np.asarray(value, float))
        wrong = given[~(np.isfinite(given) & (given > 0))]
        if wrong.size:
            raise ValueError(f"{name} = {wrong[0]:g}: expected finite numbers above 0")
