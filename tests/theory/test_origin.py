"""Every coefficient names its source and range, and what was derived here says so."""

import dataclasses
from pathlib import Path

import pytest

from mesokit.theory import Transport, origins

PAGE = (Path(__file__).resolve().parents[2] / "docs/theory.md").read_text()
RULES = ["srd", "srd+a", "at", "at+a"]


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("thermostat", ["none", "maxwell-boltzmann"])
def test_every_coefficient_has_an_origin(rule, thermostat):
    found = origins(rule, 3, thermostat=thermostat)
    assert set(found) == {field.name for field in dataclasses.fields(Transport)}
    assert all(origin.holds for origin in found.values())


@pytest.mark.parametrize("name", ["viscosity_kinetic", "viscosity_collisional", "diffusion"])
def test_what_was_derived_here_says_so(name):
    for rule in ("srd+a", "at+a"):
        source = origins(rule, 2)[name].source
        assert source.startswith("derived for mesokit") and "(4)" in source
    assert origins("srd", 2, "uniform")[name].source.startswith("derived for mesokit")
    assert "Table 1" in origins("srd", 2)[name].source
    assert "Noguchi" in origins("at", 2)[name].source


def test_equation_numbers_are_those_of_the_page():
    for number in range(1, 12):
        assert PAGE.count(f" ({number})$$\n") == 1
