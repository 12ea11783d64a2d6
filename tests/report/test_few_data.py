"""Figures of runs of few steps: nothing is said on the screen."""

import warnings

import pytest

from mesokit import Box, Case, MeanSquareDisplacement, Run, Simulation, StressInTime
from mesokit.method.brownian.section import Brownian
from mesokit.report import plot, save_all
from tests.helpers.fake_fluid import FakeFluid


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


def test_stress_in_less_than_a_period_has_no_figure(make_case, tmp_path):
    """A line says so; a period later there is one."""
    from mesokit.case.shear.two_ramps import StartUp

    shear = StartUp(rate=0.1, start=1.0, period=2.0)
    case = make_case((4, 4), [StressInTime(window=5)], shear=shear)
    accumulator, fluid = StressInTime(window=5).accumulator(case), FakeFluid(case)
    for steps in (15, 10):
        for _ in range(steps):
            fluid.advance(1)
            accumulator.observe(fluid)
        if steps == 15:
            with pytest.warns(UserWarning, match="stress-in-time: no figure, as no number"):
                assert save_all([accumulator.result()], tmp_path) == []
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(save_all([accumulator.result()], tmp_path)) == 1
