"""Figures of runs of few steps: nothing is said on the screen."""

import warnings

import pytest

from mesokit import Box, Case, MeanSquareDisplacement, Run, Simulation
from mesokit.method.brownian.section import Brownian
from mesokit.report import plot


@pytest.mark.parametrize("steps", [1, 2, 3])
def test_a_displacement_of_few_lags(steps, tmp_path):
    observe = [MeanSquareDisplacement(every=1)]
    case = Case(
        run=Run(steps, method="brownian"), box=Box([9, 8]), brownian=Brownian(), observe=observe
    )
    simulation = Simulation(case, threads=1)
    simulation.run()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        figure = plot(simulation["mean-square-displacement"], case=case)
        figure.savefig(tmp_path / "a.png")
    for ax in figure.axes:
        low, high = ax.get_xlim()
        assert 0 < low < 0.01 < high
