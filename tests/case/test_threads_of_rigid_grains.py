"""How many threads a run of grains has unless said: no more than make it faster."""

from __future__ import annotations

import pytest

from mesokit import Box, Case, GaussSeidel, RigidSpheres, Run, SoftSpheres
from mesokit.processes.world import world
from mesokit.run import given
from mesokit.seam.method import method_of

RANDOM = GaussSeidel(order="random")


def case(number, solver=None):
    """Rigid grains, or soft ones without a solver."""
    rigid = solver is not None
    spheres = RigidSpheres(number=number, solver=solver) if rigid else SoftSpheres(number=number)
    method = "contact-dynamics" if rigid else "soft-spheres"
    return Case(run=Run(10, method=method), box=Box((200, 200)), spheres=spheres)


@pytest.mark.parametrize(
    ("given_case", "expected"),
    [(case(300, GaussSeidel()), 1), (case(5000, GaussSeidel()), 2), (case(20_000, RANDOM), 1),
     (case(20_000, GaussSeidel()), 4), (case(300), 4)],
)  # fmt: skip
def test_no_more_than_make_it_faster(monkeypatch, given_case, expected):
    monkeypatch.setattr(given, "usable_cores", lambda: 4)
    assert given.threads_of(None, world(), given_case) == expected
    assert given.threads_of(3, world(), given_case) == 3


def test_check_says_so():
    rows = method_of(few := case(300, GaussSeidel())).summary(few, 2).rows
    (note,) = [row[2] for row in rows if row[0] == "run time"]
    assert "2 threads, no faster than 1: few grains" in note
