"""The same case gives the same bits: for any threads, any division of the steps, and any stops."""

import os
import subprocess
import sys

import numpy as np
import pytest

from mesokit import Harmonic, MaxwellBoltzmann, Molecule, StartUp
from mesokit.method.mpcd.engine.cpu.engine import CPU
from tests.helpers.kinds_of_fluid import (
    AMONG_MOLECULES,
    DISSOLVED,
    EMBEDDED,
    MOLECULES,
    PARTICLES,
    SEVERAL_KINDS,
    everything,
)
from tests.helpers.small_fluids import assert_same, make_case, make_fluid

STEPS = 110  # more than one re-sorting
FEWER = 40  # of many sub-steps
OF_SOLUTES = {
    "solutes of several kinds": {"size": (12, 12), "density": 4, "solutes": SEVERAL_KINDS},
    "solutes that act by a potential": {"size": (20, 20), "density": 5, "solutes": EMBEDDED},
}
IN_TIME = {
    "a simple fluid whose shear oscillates": {
        "size": (8, 8, 8), "thermostat": MaxwellBoltzmann(), "shear_rate": 0.2,
        "shear_frequency": 0.5,
    },
    "dimers in a shear that starts": {
        "size": (8, 8), "shear": StartUp(rate=0.3, start=5.0, period=24.0),
        "thermostat": MaxwellBoltzmann(), "molecule": Molecule(bond=Harmonic(K=4.0)),
    },
}  # fmt: skip
LONG = OF_SOLUTES | IN_TIME | {f"among molecules: {k}": v for k, v in AMONG_MOLECULES.items()}
CASES = [
    *(pytest.param(case, STEPS, id=name) for name, case in (PARTICLES | MOLECULES).items()),
    *(pytest.param(case, FEWER, id=name) for name, case in DISSOLVED.items()),
    *(pytest.param(case, STEPS, id=k, marks=pytest.mark.long) for k, case in LONG.items()),
]


def unmeasured(case):
    """What the case itself has."""
    return {key: value for key, value in case.items() if key != "measures"}


@pytest.fixture(scope="module")
def references():
    """The end of each case on one thread, in one go."""
    return {}


@pytest.fixture
def reference(case, steps, references):
    if id(case) not in references:
        fluid = make_fluid(**case)
        fluid.advance(steps)
        references[id(case)] = everything(fluid)
    return references[id(case)]


def go(fluid, steps, cut):
    """Advance to that step, so many steps at a time; looks in between change nothing."""
    while fluid.step < steps:
        fluid.advance(min(cut, steps - fluid.step))
        everything(fluid)


@pytest.mark.parametrize(("threads", "cut"), [(2, 1), (3, 7), (7, 100)])
@pytest.mark.parametrize(("case", "steps"), CASES)
def test_for_any_threads_and_division_of_the_steps(case, steps, reference, threads, cut):
    fluid = make_fluid(**case, threads=threads)
    go(fluid, steps, cut)
    assert_same(everything(fluid), reference)


@pytest.mark.parametrize("stop", [0, 33, 100])
@pytest.mark.parametrize(("case", "steps"), CASES)
def test_from_a_state(case, steps, reference, stop):
    fluid = make_fluid(**case, threads=2)
    fluid.advance(min(stop, steps - 1))
    other = CPU(make_case(**unmeasured(case)), 3, case.get("measures", ()))
    other.restore(fluid.state())
    other.advance(steps - other.step)
    assert_same(everything(other), reference)


@pytest.mark.parametrize("case", PARTICLES.values(), ids=PARTICLES)
def test_another_seed_gives_another_run(case):
    one, other = (make_fluid(**case, seed=seed) for seed in (1, 2))
    for fluid in (one, other):
        fluid.advance(STEPS)
    assert not np.array_equal(one.positions(), other.positions())


@pytest.mark.parametrize("case", PARTICLES.values(), ids=PARTICLES)
def test_nothing_is_ever_outside(case):
    closed = [axis == "y" and "walls" in case for axis in "xyz"]
    fluid = make_fluid(**case)
    for _ in range(40):
        fluid.advance(1)
        r = fluid.positions()
        assert (r >= 0).all() and (r <= fluid.box).all()
        for k, shut in enumerate(closed[: fluid.dimension]):
            assert not shut or (fluid.images()[:, k] == 0).all()


def test_numbers_fill_no_whole_strips():
    """An odd number of particles, and of molecules, in some of the cases."""
    odd = {name for name, case in PARTICLES.items() if make_case(**unmeasured(case)).particles % 2}
    assert odd >= {"slit with an odd number of particles", "sheared box"}
    for case in MOLECULES.values():
        assert make_fluid(**case).numbers.filling.molecules % 256


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
