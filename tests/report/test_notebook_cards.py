"""What notebooks show of the objects that users hold: sound small tables."""

from __future__ import annotations

import pytest

import mesokit
from mesokit import Simulation, derive
from tests.helpers.html_page import Page


@pytest.fixture(scope="module")
def files(run_folder):
    return mesokit.open(run_folder(True))


def shown(thing):
    return " ".join(Page(thing._repr_html_()).texts)


def test_a_run(files, run_folder):
    text = shown(files)
    assert "mesokit run" in text and files.case.title in text and "slip at the walls" in text
    assert "has not ended" in shown(mesokit.open(run_folder(False)))


def test_a_case_shows_what_differs_from_the_defaults(files):
    text, _, folded = shown(files.case).partition("all defaults")
    assert "steps = 60" in text and 'shape = "plates"' in text
    assert "grid_shift" not in text and "grid_shift = 1.0" in folded


def test_a_result(files):
    text = shown(files["velocity-profile"])
    assert "velocity-profile" in text and files["velocity-profile"]["slip"].what in text


def test_derived_numbers(files):
    numbers = derive(files.case, threads=1)
    assert "kinematic viscosity" in shown(numbers)
    lines = repr(numbers).splitlines()
    assert (
        len(lines) > 5 and max(map(len, lines)) < 200 and lines[0].split() == ["particles", "240"]
    )


def test_a_simulation(files):
    simulation = Simulation(files.case)
    assert "step 0 of 60" in shown(simulation) and "measured" not in shown(simulation)
    assert "step 0 of 60" in repr(simulation)
