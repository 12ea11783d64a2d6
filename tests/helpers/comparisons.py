"""Comparisons of a result, for tests: what is not there fails, and is not passed over."""

import math


def comparisons(result, words=""):
    """Those whose names have the words in them. Raises AssertionError where there are none."""
    found = [comparison for comparison in result.comparisons if words in comparison.what]
    assert found, f"{result.name}: no comparison {words!r} among {result.comparisons}"
    return found


def comparison(result, words):
    """The only one whose name has the words in it; it must expect a number."""
    (found,) = comparisons(result, words)
    assert math.isfinite(found.expected), f"{result.name}: nothing is expected of {found.what}"
    return found


def by_name(result):
    """All of them, by what they compare."""
    return {found.what: found for found in comparisons(result)}
