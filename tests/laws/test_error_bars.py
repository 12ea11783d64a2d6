"""Error bars against the scatter of seeds (all: validation/error_bars.py)."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import chi2

from mesokit import (
    Box,
    Case,
    CollisionRate,
    EquationOfState,
    Fluid,
    HardSpheres,
    Harmonic,
    MeanSquareDisplacement,
    Polymer,
    RadialDistribution,
    Run,
    Simulation,
    Solutes,
    VelocityAutocorrelation,
    VelocityCumulant,
)

pytestmark = pytest.mark.long

SEEDS = 12
CHANCE = 1e-4  # of a number that is outside although its error bar is right
HONEST = 0.85, 1.15  # scatter over error bar that runs of this length may have
OBSERVE = (
    EquationOfState(every=2), CollisionRate(every=2), VelocityCumulant(every=2),
    MeanSquareDisplacement(every=2, max_lag=100), VelocityAutocorrelation(every=1, max_lag=100),
    RadialDistribution(every=5, bins=20),
)  # fmt: skip


def seen(seed: int) -> dict[str, tuple[float, float]]:
    """Every number of a run, with its error bar."""
    case = Case(
        run=Run(1500, warmup=50, seed=seed, method="event-driven"),
        box=Box([6, 6, 6]),
        spheres=HardSpheres(packing_fraction=0.2, timestep=0.1),
        observe=OBSERVE,
    )
    simulation = Simulation(case, threads=1)
    simulation.run()
    return {
        f"{o.label} {c.key}": (c.measured, c.error)
        for o in OBSERVE
        for c in simulation[o.label].comparisons
        if c.error > 1e-12 * abs(c.measured) and "lower bound" not in c.note
    }


def test_they_are_the_scatter_of_seeds():
    """Chi-square of each number, and in the mean the root that is asked for.

    Numbers of one observable are not independent, so that of the mean three errors of half as many
    are allowed.
    """
    runs = [seen(seed) for seed in range(1, SEEDS + 1)]
    names = set.intersection(*map(set, runs))
    assert len(names) >= 8
    low, high = np.sqrt(chi2.ppf([CHANCE, 1 - CHANCE], SEEDS - 1) / (SEEDS - 1))
    squares = []
    for name in names:
        value, error = np.array([run[name] for run in runs]).T
        root = value.std(ddof=1) / np.sqrt(np.mean(error**2))
        assert HONEST[0] * low < root < HONEST[1] * high, f"{name}: {root:.2f}"
        squares.append(root**2)
    known = 1 / np.sqrt((SEEDS - 1) * len(names))
    assert HONEST[0] * (1 - 3 * known) < np.sqrt(np.mean(squares)) < HONEST[1] * (1 + 3 * known)


def scatter(case: Case, seeds: int, wanted: dict[str, str]) -> dict[str, tuple[float, float]]:
    """Scatter of the seeds of some numbers, by observable, and what they quote in the mean."""
    found: dict[str, list[tuple[float, float]]] = {name: [] for name in wanted}
    for seed in range(1, seeds + 1):
        simulation = Simulation(replace(case, run=replace(case.run, seed=seed)), threads=1)
        simulation.run()
        for name, what in wanted.items():
            number = simulation[name][what]
            found[name].append((number.measured, number.error))
    every = {name: np.array(rows).T for name, rows in found.items()}
    return {
        name: (value.std(ddof=1), np.sqrt(np.mean(error**2)))
        for name, (value, error) in every.items()
    }


@pytest.mark.parametrize(("size", "length"), [([9, 9, 9], 3), ([20, 20], 5)])
def test_neighbours_that_hardly_move(size, length):
    """Blocks of a run in which molecules stay near saw a third of the scatter."""
    case = Case(
        run=Run(1200, warmup=20),
        box=Box(size),
        fluid=Fluid(),
        solutes=Solutes([Polymer(24, length)], bond=Harmonic(K=1.0), solvent="random"),
        observe=[RadialDistribution(every=20, reach=3)],
    )
    seen, quoted = scatter(case, 24, {"radial-distribution": "neighbours"})["radial-distribution"]
    assert 0.6 < seen / quoted < 1.5
