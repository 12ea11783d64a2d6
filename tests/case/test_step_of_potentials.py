"""The step of spheres with a potential knows how hot they start, from arrays, files and runs."""

import dataclasses
import math

import numpy as np
import pytest

from mesokit import WCA, Box, Case, LennardJones, Run, Simulation, SoftSpheres
from mesokit.method.spheres.common.start.from_file import RunStart
from mesokit.method.spheres.soft.scales import timestep_of
from mesokit.seam.method import method_of

USUAL = 0.005


def case(pair=None, **parts) -> Case:
    return Case(
        run=Run(steps=3, method="soft-spheres"),
        box=Box([9.0, 9.0, 9.0]),
        spheres=SoftSpheres(number=60, pair=pair or LennardJones(), **parts),
    )


def speeds(kT: float, number: int = 60) -> np.ndarray:
    return np.random.default_rng(4).normal(0, math.sqrt(kT), (number, 3))


def step(of: Case, **arrays) -> float:
    return timestep_of(method_of(of).initial.prepared(of, arrays))


@pytest.mark.parametrize("pair", [LennardJones(), WCA()])
@pytest.mark.parametrize("kT", [30.0, 400.0])
def test_hot_arrays_make_it_shorter(pair, kT):
    assert step(case(pair), velocities=speeds(kT)) == pytest.approx(USUAL / kT**0.5, rel=0.1)


def test_usual_starts_keep_it():
    assert step(case()) == step(case(), velocities=speeds(1.1)) == USUAL
    warm = step(case(kT=25.0))
    assert step(case(kT=25.0), velocities=speeds(25.0)) == warm == USUAL / 5
    assert step(case(timestep=0.004), velocities=speeds(90.0)) == 0.004


def test_one_that_is_shot_makes_it_shorter():
    one = np.zeros((60, 3))
    one[7, 0] = 80.0
    assert step(case(), velocities=one) < USUAL / 10


def test_an_earlier_run_is_known(tmp_path):
    first = Simulation(case(kT=64.0, timestep=1e-4), output=tmp_path / "hot")
    first.run()
    start = RunStart(run=str(tmp_path / "hot"))
    after = dataclasses.replace(case(), spheres=dataclasses.replace(case().spheres, start=start))
    assert step(after) == pytest.approx(USUAL / 8, rel=0.25)
