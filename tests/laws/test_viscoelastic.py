"""A fluid of dimers: sizes, relaxation, velocity modes and moduli beside Rouse's theory."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import (
    FENE,
    BondCorrelation,
    BondLength,
    Box,
    Case,
    DynamicModuli,
    Fluid,
    Harmonic,
    MaxwellBoltzmann,
    Molecule,
    MoleculeSize,
    NormalModes,
    Run,
    Simulation,
    Stress,
    TransverseModes,
)
from tests.helpers.comparisons import comparisons

pytestmark = pytest.mark.long

# Beads are taken to have the friction of free particles, with what these stir up; that beads of a
# molecule drag one another along, and those of others screen it, is left out of relaxation times.
CHAOS = 0.15
SPRING = Harmonic(K=0.5)  # mean square length 3


def dimers(observe, steps, length=2, bond=SPRING, size=(8, 8, 8), substeps=None, **box):
    """Run it."""
    simulation = Simulation(
        Case(
            run=Run(steps=steps, warmup=400, seed=4),
            box=Box(size, **box),
            fluid=Fluid(
                density=10, timestep=0.1, thermostat=MaxwellBoltzmann(),
                molecule=Molecule(length=length, bond=bond, substeps=substeps),
            ),
            observe=observe,
        )
    )  # fmt: skip
    simulation.run()
    return simulation


def of(result, what):
    """One comparison."""
    return comparisons(result, what)[0]


@pytest.mark.parametrize("length", [2, 5])
def test_at_rest(length):
    """Equipartition of modes and sizes; the slowest mode relaxes as Rouse has it."""
    observe = [NormalModes(every=5, max_lag=1500), MoleculeSize(every=20)]
    simulation = dimers(observe, 8000, length)
    modes, size = simulation["normal-modes"], simulation["molecule-size"]
    for c in (*comparisons(size), *comparisons(modes, "square")):
        assert abs(c.measured - c.expected) < 4.5 * c.error, c
    slowest = of(modes, "time 1")
    assert slowest.error < 0.1 * slowest.expected
    assert abs(slowest.measured - slowest.expected) < (
        4 * slowest.error + CHAOS * slowest.expected
    ), slowest


def test_velocity_modes_swing():
    """As long as the correlation is above noise it is within noise of theory at finite k."""
    waves = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    simulation = dimers([TransverseModes(waves=waves, every=2, max_lag=400)], 12_000)
    result = simulation["transverse-modes"]
    lowest = result.value[:, 0].argmin()  # a simple fluid's would never fall below 0
    assert result.value[lowest, 0] < -4 * result.error[lowest, 0]
    worst = of(result, "finite k")
    assert abs(worst.measured) < 0.04 + 4 * worst.error, worst


OFTEN = {"every": 190}
SIZES = (  # of all molecules, at the same moments: images are then anywhere
    BondLength(**OFTEN),
    MoleculeSize(molecules=3000, **OFTEN),
    NormalModes(molecules=3000, max_lag=1900, **OFTEN),
)


@pytest.fixture(scope="module")
def oscillating():
    return dimers([DynamicModuli(), *SIZES], 8000, shear_rate=0.1, shear_frequency=0.2)


@pytest.fixture(scope="module")
def sheared():
    bonds = BondCorrelation(every=20, molecules=1000, max_lag=400)
    return dimers([Stress(), bonds, *SIZES], 6000, shear_rate=0.05)


def test_springs_store_what_they_should(oscillating):
    result = oscillating["dynamic-moduli"]
    for name in ("storage", "loss"):
        c = of(result, name)
        assert abs(c.measured - c.expected) < 4.5 * c.error + CHAOS * c.expected, c


def test_springs_carry_most_of_the_stress(sheared):
    result = sheared["stress"]
    for name in ("viscosity", "first normal-stress"):
        c = of(result, name)
        assert abs(c.measured - c.expected) < 4.5 * c.error + 2 * CHAOS * c.expected, c
    assert result.value[2, 0, 1] > 2 * result.value[1, 0, 1]  # bonds over collisions


def test_bonds_turn_towards_the_flow(sheared):
    """Each component of their correlation in time is that of theory; xy and yx differ."""
    result = sheared["bond-correlation"]
    for c in comparisons(result):
        assert c.error < 0.1 and abs(c.measured - 1) < 4.5 * c.error + CHAOS, c
    xy, yx = result.value[:, 3], result.value[:, 4]
    later = 6
    assert xy[later] > yx[later] + 4.5 * np.hypot(*result.error[later, 3:])
    assert xy[0] == pytest.approx(yx[0], rel=1e-12)


@pytest.mark.parametrize("run", ["sheared", "oscillating"])
def test_a_dimer_is_its_bond_where_images_slide(run, request):
    """Its end-to-end vector R is the bond, and its first mode R/sqrt(2)."""
    simulation = request.getfixturevalue(run)
    bond, size = simulation["bond-length"].value[0], simulation["molecule-size"].value
    np.testing.assert_allclose(size[1], bond, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(size[0], bond / 4, rtol=1e-9, atol=1e-12)
    mode = of(simulation["normal-modes"], "mean square of mode 1")
    assert mode.measured == pytest.approx(np.trace(bond) / 2, rel=1e-9)


@pytest.mark.parametrize(("length", "size"), [(2, (8, 8, 8)), (3, (6, 8, 8))])
def test_flow_stretches_bonds(length, size):
    """Beyond their length at rest as Rouse has it, trimers as with hydrodynamic interaction."""
    bond = dimers([BondLength()], 4000, length, size=size, shear_rate=0.2)["bond-length"]
    c, at_rest = of(bond, "mean square"), 3.0
    assert c.expected > 1.3 * at_rest
    # the elongation goes as the square of a relaxation time
    assert abs(c.measured - c.expected) < 4.5 * c.error + 2 * CHAOS * (c.expected - at_rest), c


def test_finitely_extensible_dumbbells_thin():
    """Slow flow as theory has it at zero shear rate; less in fast flow."""
    bond = FENE(k=0.5, R0=5.0)
    slow, fast = (  # fast flow draws bonds to where they are stiffer than heat alone would
        of(
            dimers([Stress(every=10)], steps, bond=bond, shear_rate=rate, substeps=substeps)[
                "stress"
            ],
            "bond part",
        )
        for steps, rate, substeps in ((8000, 0.03, None), (2000, 0.3, 6))
    )
    assert abs(slow.measured - slow.expected) < 4.5 * slow.error + CHAOS * slow.expected, slow
    assert fast.measured + 4.5 * fast.error < 0.8 * slow.measured
