"""The same case gives the same bits: for any threads, and however the steps are divided."""

import os
import subprocess
import sys

import numpy as np
import pytest
from laboratory import assert_same, fingerprint, make_case, make_fluid

from mesokit import SRD, MaxwellBoltzmann, Plates, Surface, Uniform
from mesokit.execute.cpu.engine import CPU
from mesokit.method.mpcd.species import Species

CASES = {
    "slit with an odd number of particles": {
        "size": (13, 7), "density": 9.527, "collision": SRD(angle=90),
        "thermostat": MaxwellBoltzmann(), "force": Uniform(acceleration=(0.05, -0.02)),
        "walls": [Plates(axis="y", upper=Surface(velocity=(0.3, 0.0)))], "measures": ("walls",),
    },
    "sheared box": {
        "size": (5, 11, 6), "density": 7.01, "thermostat": MaxwellBoltzmann(), "shear_rate": 0.2,
    },
    "mixture": {
        "size": (11, 6), "species": (Species(mass=1, density=4), Species(mass=5, density=3)),
    },
}  # fmt: skip
STEPS = 130  # more than one re-sorting


@pytest.fixture(scope="module", params=CASES.values(), ids=CASES.keys())
def case(request):
    return request.param


@pytest.fixture(scope="module")
def reference(case):
    fluid = make_fluid(**case, threads=1)
    assert fluid.n % 2 == 1 or "species" in case
    fluid.advance(STEPS)
    return fingerprint(fluid)


@pytest.mark.parametrize("threads", [1, 2, 3, 5])
def test_for_any_number_of_threads(case, reference, threads):
    fluid = make_fluid(**case, threads=threads)
    fluid.advance(STEPS)
    assert_same(fingerprint(fluid), reference)


@pytest.mark.parametrize("cut", [1, 7, 49, 100, 101])
def test_however_the_steps_are_divided(case, reference, cut):
    fluid = make_fluid(**case)
    while fluid.step < STEPS:
        fluid.advance(min(cut, STEPS - fluid.step))
        fluid.totals()  # looking changes nothing
    assert_same(fingerprint(fluid), reference)


@pytest.mark.parametrize("step", [0, 33, 100, 129])
def test_from_a_state(case, reference, step):
    fluid = make_fluid(**case)
    fluid.advance(step)
    parts = {key: value for key, value in case.items() if key not in ("size", "measures")}
    other = CPU(make_case(case["size"], **parts), 3, case.get("measures", ()))
    other.restore(fluid.state())
    other.advance(STEPS - step)
    assert_same(fingerprint(other), reference)


def test_another_seed_gives_another_run(case, reference):
    fluid = make_fluid(**case, seed=2)
    fluid.advance(STEPS)
    assert not np.array_equal(fluid.positions(), reference[0])


def test_nothing_is_ever_outside(case):
    closed = [axis == "y" and "walls" in case for axis in "xyz"]
    fluid = make_fluid(**case)
    for _ in range(40):
        fluid.advance(1)
        r = fluid.positions()
        assert (r >= 0).all() and (r <= fluid.box).all()
        for k, shut in enumerate(closed[: fluid.dimension]):
            assert not shut or (fluid.images()[:, k] == 0).all()


def test_the_start_does_not_depend_on_the_threads_of_blas():
    """Large enough that OpenBLAS would share out a scalar product."""
    script = (
        "import hashlib, mesokit as m\n"
        "case = m.Case(run=m.Run(steps=1), box=m.Box([40, 40]), fluid=m.Fluid(density=10))\n"
        "fluid = m.Simulation(case).engine\n"
        "print(hashlib.sha256(fluid.velocities().tobytes()).hexdigest())\n"
    )
    seen = set()
    for threads in ("1", "2"):
        env = os.environ | {"OPENBLAS_NUM_THREADS": threads, "OMP_NUM_THREADS": threads}
        command = [sys.executable, "-c", script]
        done = subprocess.run(command, env=env, capture_output=True, text=True, check=True)
        seen.add(done.stdout)
    assert len(seen) == 1
