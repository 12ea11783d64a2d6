"""Starts from files: the bits of one process; no rank but the first reads the whole."""

import json

import pytest

from tests.helpers.rank_runs import on_ranks
from tests.ranks import starts
from tests.ranks.starts import SOURCES

PARTICLES, RANKS = 600, 3
SLICED = {"bulk npy", "bulk half"}  # what each rank reads its share of


@pytest.fixture(scope="module")
def sources(once):
    """A folder with files to start from, and what one process and ranks make of them."""
    pytest.importorskip("gsd.hoomd")
    pytest.importorskip("MDAnalysis")
    return once("sources", begin)


def begin(folder):
    """Make the files, and start from them."""
    starts.make_sources(folder)
    starts.main(folder)
    on_ranks(RANKS, "starts.py", folder)


@pytest.mark.parametrize(("kind", "name"), SOURCES)
def test_every_source_gives_the_bits_of_one_process(sources, kind, name):
    one, some = (sources / f"{kind}-{name}-{n}" / "checkpoint.npz" for n in (1, RANKS))
    assert one.read_bytes() == some.read_bytes()


def test_ranks_read_their_shares(sources):
    read = json.loads((sources / f"read-{RANKS}.json").read_text())
    assert {name for name, rows in read.items() if not any(rows)} == {"bulk given"}
    for name, rows in read.items():
        if name in SLICED:
            assert rows == [PARTICLES // RANKS] * RANKS, name
        elif name == "bulk npz":  # the other array is one of them
            assert rows == [PARTICLES] + [PARTICLES // RANKS] * (RANKS - 1)
        elif name != "bulk given":
            assert rows == [PARTICLES] + [0] * (RANKS - 1), name


def test_one_process_reads_all(sources):
    read = json.loads((sources / "read-1.json").read_text())
    assert {tuple(rows) for name, rows in read.items() if name != "bulk given"} == {(PARTICLES,)}
