"""Comparisons of a result for tests that loop over them: a loop over none would assert nothing."""


def comparisons(result, words=""):
    """Those whose names have the words in them. Raises AssertionError where there are none."""
    found = [comparison for comparison in result.comparisons if words in comparison.what]
    assert found, f"{result.name}: no comparison {words!r} among {result.comparisons}"
    return found
