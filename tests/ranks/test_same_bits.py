"""The bits of a run do not depend on ranks, threads, and where borders are."""

import json

import pytest

from tests.helpers.rank_runs import on_ranks

RUNS = {"channel": (3, 1), "sheared dimers": (4, 1), "long flights": (2, 2)}  # ranks, threads
RUNS |= {"bodies in a channel": (3, 1), "bodies in shear": (4, 2)}
RUNS |= {"beads beside bodies": (3, 2)}
OBSERVED = "past a post", "past a sphere", "two species", "molecules"


@pytest.fixture(scope="module")
def sums(once):
    """What differs for each case and number of ranks, and how much was compared."""
    return compared(once, "sums", 3, "same_sums.py")


def compared(once, name, *command):
    """What ranks print, once for all tests."""
    folder = once(name, lambda folder: (folder / "said").write_text(on_ranks(*command)))
    return json.loads((folder / "said").read_text())


@pytest.mark.long
@pytest.mark.parametrize("name", RUNS)
def test_ranks_have_the_bits_of_one_process(name, once):
    """What differs in each run, and how much was compared: a command for each run."""
    given = json.dumps({name: RUNS[name]})
    found = compared(once, f"bits of {name}", RUNS[name][0], "same_bits.py", given)
    different, arrays = found[name]
    assert not different and arrays > 10


@pytest.mark.long
@pytest.mark.parametrize("ranks", [1, 2, 3])
@pytest.mark.parametrize("name", OBSERVED)
def test_observables_add_up_the_same_bits(name, ranks, sums):
    """Pieces of few particles on ranks, and all in one piece on one process."""
    different, arrays = sums[name][str(ranks)]
    assert not different and arrays
