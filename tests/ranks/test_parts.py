"""No rank holds all particles: starts and files are made in parts, to the same bits."""

from __future__ import annotations

import numpy as np
import pytest

from tests.helpers.rank_runs import on_ranks

CASES = "bulk", "solid", "dimers"


@pytest.fixture(scope="module")
def carried(once):
    """A folder in which every case was begun by one process and by four ranks; the run of the one
    process has gone on with these ranks."""
    return once("carried", lambda folder: on_ranks(4, "program.py", folder, "carry"))


@pytest.fixture(scope="module")
def resumed(carried, once):
    """The same folder after the runs of four ranks have gone on with two, or with one process."""
    once("resumed", lambda _: on_ranks(2, "program.py", carried, "go_on"))
    return carried


@pytest.mark.parametrize("case", CASES)
def test_files_are_those_of_one_rank_byte_by_byte(case, carried):
    one, some = carried / f"{case}-one", carried / f"{case}-some"
    names = sorted(p.relative_to(one) for p in one.rglob("*.npz") if p.name != "checkpoint.npz")
    assert len(names) == 3
    for name in names:
        assert (one / name).read_bytes() == (some / name).read_bytes(), name


@pytest.mark.parametrize("case", CASES)
def test_a_checkpoint_goes_on_with_any_number_of_ranks(case, resumed):
    one, some = (resumed / f"{case}-{who}" / "checkpoint.npz" for who in ("one", "some"))
    assert one.read_bytes() == some.read_bytes()


def test_memory_of_a_rank_is_that_of_its_share(carried):
    some, one = (np.loadtxt(carried / f"bytes-{ranks}") for ranks in (4, 1))
    assert some < 0.25 * 1.2 * one
