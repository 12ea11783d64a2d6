"""Dimers in a shear that starts and ceases: stress in time beside Rouse's theory; the same bits."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import (
    Box,
    Case,
    Fluid,
    Harmonic,
    MaxwellBoltzmann,
    Molecule,
    Run,
    Simulation,
    StartUp,
    StressInTime,
)

pytestmark = pytest.mark.long

CHAOS = 0.15  # friction of beads by molecular chaos, see test_viscoelastic
PERIOD = 240  # steps: some 7 relaxation times of rest, and as many of shear


def dimers(periods, threads=1):
    return Simulation(
        Case(
            run=Run(steps=periods * PERIOD, warmup=PERIOD, seed=4),
            box=Box((8, 8), shear=StartUp(rate=0.3, start=0.05 * PERIOD, period=0.1 * PERIOD)),
            fluid=Fluid(
                density=10, timestep=0.1, thermostat=MaxwellBoltzmann(),
                molecule=Molecule(length=2, bond=Harmonic(K=4.0)),
            ),
            observe=[StressInTime(window=10)],
        ),
        threads=threads,
    )  # fmt: skip


def test_stress_grows_and_relaxes_as_rouse_has_it():
    simulation = dimers(24)
    simulation.run()
    result = simulation["stress-in-time"]
    for name in ("shear stress over", "shear stress of bonds over"):
        c = result[name]
        assert c.error < 0.05 and abs(c.measured - 1) < 4.5 * c.error + CHAOS, c
    # within the period too: bonds alone at the end of rest, and right after shear has begun
    bonds, error, theory = result.value[:, 1], result.error[:, 1], result.expected[:, 1]
    assert (abs(bonds - theory) < 4.5 * error + CHAOS * theory.max()).all()
    assert bonds[13:].mean() > 3 * bonds[6:12].mean()


def test_same_bits():
    one, two = dimers(1), dimers(1, threads=2)
    one.engine.advance(150)
    for _ in range(30):
        two.engine.advance(5)
    np.testing.assert_array_equal(one.engine.positions(), two.engine.positions())
    np.testing.assert_array_equal(one.engine.velocities(), two.engine.velocities())
