"""What `check` shows of a fluid: lines that have a number, and whose they are."""

from __future__ import annotations

import pytest

from mesokit import AT, SRD, Box, Case, Fluid, Harmonic, Polymer, Run, Solutes, Uniform, derive
from mesokit.method.mpcd.method import METHOD

SOLUTES = Solutes([Polymer(2, length=6)], mass=4, bond=Harmonic(K=1.2))


def rows_of(**parts):
    parts = {"run": Run(steps=10), "box": Box([9, 9, 9])} | parts
    return {name: (value, word) for name, value, word in METHOD.summary(Case(**parts), 1).rows}


@pytest.mark.parametrize("rule", [SRD(angle=115), AT()])
def test_a_fluid_with_solutes_has_the_numbers_of_its_solvent(rule):
    fluid = Fluid(density=7, timestep=0.25, collision=rule)
    alone, among = rows_of(fluid=fluid), rows_of(fluid=fluid, solutes=SOLUTES)
    for name in ("mean free path", "kinematic viscosity", "speed of sound", "Schmidt number"):
        assert among[name][0] == alone[name][0]
    assert among["kinematic viscosity"][1].startswith("without the solutes; kinetic")
    assert "solutes" not in alone["kinematic viscosity"][1]
    assert (
        derive(Case(run=Run(10), box=Box([9, 9, 9]), fluid=fluid, solutes=SOLUTES)).reynolds is None
    )


@pytest.mark.parametrize("fluid", [Fluid(grid_shift=0.5), Fluid(force=Uniform([0.01, 0, 0]))])
def test_no_line_says_that_there_is_no_formula(fluid):
    for solutes in (None, SOLUTES):
        rows = rows_of(fluid=fluid, solutes=solutes)
        assert "no formula" not in [value for value, _ in rows.values()]
        assert rows["mean free path"][0] == "0.1 a"
