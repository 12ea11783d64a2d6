"""Figures of theory alone, from the command line."""

import math

import numpy as np
import pytest

from mesokit import theory
from mesokit.cli import chain_figures
from mesokit.cli.chains import Beads, chains_of

BEADS = Beads(3, 1.0, 10.0, 10.0, viscosity=0.8705, stirring=0.0587)


@pytest.fixture
def ax():
    from matplotlib.figure import Figure

    return Figure().subplots()


def test_velocity_modes_are_those_of_theory(ax):
    """Numbers of docs/theory-polymers.md, at k = 2 pi/30."""
    chains = chains_of(BEADS, (2, 10), (), (26.8,))
    chain_figures.velocity_modes(ax, chains, BEADS, 30.0, 100.0)
    dimers, decamers = (line.get_xydata().T for line in ax.lines)
    assert np.interp([5, 20], *dimers) == pytest.approx([0.60954, 0.46270], abs=2e-3)
    assert np.interp([5, 20], *decamers) == pytest.approx([0.63330, 0.09251], abs=2e-3)


def test_springs_hold_the_bonds_of_trimers(ax):
    beads = Beads(3, 1.0, 10.0, 10.0, viscosity=0.87, stirring=0.0587)
    chain_figures.spring_constants(ax, (3,), 2.0, beads, [0.3])
    rate, K = ax.lines[0].get_xydata().T
    assert np.interp(np.log([0.1, 10]), np.log(rate), K) == pytest.approx(
        [0.816861, 14.465371], rel=1e-3
    )


def test_bonds_in_shear_grow(ax):
    beads = Beads(3, 1.0, 10.0, 10.0, viscosity=0.87, stirring=0.0587)
    chain_figures.bond_lengths(ax, chains_of(beads, (3,), (1.0,), ()), beads, [0.3])
    rate, length = ax.lines[0].get_xydata().T
    assert np.interp(math.log(0.1), np.log(rate), length) == pytest.approx(1.665299, rel=1e-3)
    assert length[0] == pytest.approx(math.sqrt(theory.mean_square_bond(K=1.0)), rel=1e-4)
