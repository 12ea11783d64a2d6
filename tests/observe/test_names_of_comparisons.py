"""A comparison is found by its words, its key, or what only its name begins with."""

from __future__ import annotations

import pytest

from mesokit.observe import Comparison, Result
from mesokit.seam.named import find, key_of, keyed

WORDS = (
    "viscosity from curvature",
    "drag coefficient of first",
    "drag along x on first",
    "slip at the wall",
    "slip at the wall of the pipe",
)


@pytest.fixture
def result():
    found = tuple(Comparison(what, float(i), 0.1) for i, what in enumerate(WORDS))
    return Result("forces", "forces", {}, 1.0, 0.1, "force", {}, comparisons=found)


@pytest.mark.parametrize("number", range(len(WORDS)))
def test_words_and_keys_both_name_it(result, number):
    assert result[WORDS[number]].measured == number
    assert result[key_of(WORDS[number])].measured == number
    assert result.comparisons[number].key == list(keyed(result.comparisons))[number]


def test_a_beginning_is_enough_where_only_one_begins_so(result):
    assert result["viscosity"].measured == 0
    assert result["Drag Coefficient"].measured == 1
    assert result["slip at the wall"].measured == 3  # a whole name, though another begins with it
    assert "visc" in result and "wall" not in result


def test_an_unknown_name_is_told_what_is_near(result):
    with pytest.raises(KeyError, match="may be drag-coefficient-of-first or drag-along-x-on-first"):
        result["drag"]
    with pytest.raises(KeyError, match="did you mean viscosity-from-curvature"):
        result["viscsity from curvture"]
    with pytest.raises(KeyError, match="there are none"):
        find((), "drag")
    for name in ("", 3, "-"):
        with pytest.raises(KeyError, match="no comparison"):
            result[name]


def test_equal_names_are_numbered():
    same = [Comparison("slip", float(i), 0.1) for i in range(3)]
    assert list(keyed(same)) == ["slip", "slip-2", "slip-3"]
    assert find(same, "slip").measured == 0 and find(same, "slip-3").measured == 2


def test_a_result_is_not_a_list_of_comparisons(result):
    with pytest.raises(TypeError, match="not iterable"):
        list(result)
