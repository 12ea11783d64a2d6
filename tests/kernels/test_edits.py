"""An edit remakes what contains it, and nothing else."""

from __future__ import annotations

import pytest

from tests.helpers.module_with_kernels import NOTHING_MADE, Place


def test_a_second_process_makes_nothing(place: Place) -> None:
    assert place.run().items() >= NOTHING_MADE.items()


@pytest.mark.parametrize(
    ("before", "after", "kernels", "parts", "factor"),
    [
        # twice, what was chosen for reduced, and the bodies of both kernels; 2 is there twice
        ("return 2.0 * same(x)", "return 4.0 * same(x)", 2, 4, 4.0),
        ("return FACTOR * x", "return x * FACTOR * 2.0", 1, 2, 2.0),
        ("FACTOR = 3.0", "FACTOR = 6.0", 1, 2, 2.0),
        ("return shape.slope * x", "return shape.slope * x * 2.0", 1, 2, 2.0),
        ("len(rows) > 1", "len(rows) > 2", 1, 2, 0.5),  # only what chooses has changed
        ("out[i] = twice(out[i])", "out[i] = twice(twice(out[i]))", 1, 1, 2.0),  # a kernel itself
        ("x + 0.0", "x + x", 2, 4, 4.0),  # of a function of numba's own kind
        ("return x + 1.0", "return x + 2.0", 0, 0, 1.0),
        ("return x**shape.power", "return x**shape.power + 1.0", 0, 0, 1.0),
        ("'''Height of a shape at x.'''", "'''Height.'''\n    # of what", 0, 0, 1.0),
    ],
)
def test_an_edit_remakes_what_contains_it_and_nothing_else(
    place: Place, before: str, after: str, kernels: int, parts: int, factor: float
) -> None:
    place.edit(before, after)
    found = place.run()
    assert found["kernels_made"] == kernels and found["parts_made"] == parts
    assert found["sum"] == 72.0 * factor
    assert place.run().items() >= NOTHING_MADE.items()


def test_both_states_of_a_source_are_kept(place: Place) -> None:
    """As when branches of a repository are changed back and forth."""
    place.edit("FACTOR = 3.0", "FACTOR = 6.0")
    assert place.run()["kernels_made"] == 1
    place.edit("FACTOR = 6.0", "FACTOR = 3.0")
    assert place.run().items() >= NOTHING_MADE.items()
