"""What is drawn as theory of sheared molecules is what their numbers are compared with."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import FENE, BondLength, Harmonic, MaxwellBoltzmann, Stress
from mesokit.method.mpcd.molecule import Molecule
from tests.helpers.comparisons import by_name
from tests.helpers.fake_fluid import FakeFluid

RATE = 0.1


def in_shear(make_case, size, observable, **molecule):
    case = make_case(
        size, [observable], density=10, timestep=0.1, shear_rate=RATE,
        thermostat=MaxwellBoltzmann(), molecule=Molecule(**molecule),
    )  # fmt: skip
    accumulator, fluid = observable.accumulator(case), FakeFluid(case)
    shape = (len(size), len(size))
    fluid.stress = {part: np.ones(shape) for part in ("kinetic", "collisional", "bond")}
    bonds = case.particles // molecule["length"] * (molecule["length"] - 1)
    fluid.bond_vectors = lambda: np.ones((bonds, len(size)))
    for _ in range(4):
        accumulator.observe(fluid)
    result = accumulator.result()
    return result, by_name(result)


@pytest.mark.parametrize(("size", "length"), [((4, 4), 2), ((6, 4, 4), 3), ((4, 4, 4), 5)])
def test_stress(make_case, size, length):
    result, found = in_shear(make_case, size, Stress(), length=length, bond=Harmonic(K=0.5))
    bond, total = result.expected[2:]
    scale = 10 * RATE
    assert total[0, 1] / scale == pytest.approx(found["viscosity from the stress"].expected)
    assert bond[0, 1] / scale == pytest.approx(found["bond part from the stress"].expected)
    first = found["first normal-stress difference"].expected
    assert total[0, 0] - total[1, 1] == pytest.approx(first)
    assert bond[0, 0] - bond[1, 1] == pytest.approx(first)
    assert -np.trace(total) / len(size) == pytest.approx(found["pressure"].expected)
    assert np.isnan(result.expected[0, 0, 1]) and first > 0
    assert found["kinetic part from the stress"].note == "no theory of this part"


def test_stress_of_bonds_that_are_no_springs(make_case):
    result, found = in_shear(make_case, (6, 6, 6), Stress(), length=2, bond=FENE(k=1 / 3, R0=6.0))
    expected = found["bond part from the stress"].expected
    assert result.expected[2, 0, 1] == pytest.approx(expected * 10 * RATE)
    assert np.isnan(result.expected[-1, 0, 1])
    assert not found["pressure"].approximate and "no theory" in found["pressure"].note


@pytest.mark.parametrize(("size", "length"), [((4, 4), 2), ((6, 4, 4), 3), ((4, 4, 4), 5)])
def test_bonds(make_case, size, length):
    result, found = in_shear(make_case, size, BondLength(), length=length, bond=Harmonic(K=0.5))
    [products] = result.expected
    at_rest = 1 / (2 * 0.5)  # kT/(2 K) along each axis
    assert np.trace(products) == pytest.approx(found["mean square bond length"].expected)
    assert products[1, 1] == pytest.approx(at_rest) and products[0, 0] > 1.01 * at_rest
    assert products[0, 1] == products[1, 0] > 0
