"""The same case gives the same bits: for any threads, any division of the steps, and any stops."""

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

import mesokit
from mesokit import (
    AT,
    FENE,
    WCA,
    AngularNoise,
    Bending,
    Box,
    Capsule,
    Case,
    Cohesion,
    Disk,
    EquationOfState,
    Flock,
    Fluid,
    Forces,
    HardCollision,
    HardSpheres,
    Harmonic,
    MaxwellBoltzmann,
    MeanSquareDisplacement,
    Molecule,
    Plates,
    PolarOrder,
    Polymer,
    RandomStart,
    Run,
    Simulation,
    Solutes,
    SphereKind,
    SpringDashpot,
    SquareWell,
    StartUp,
    Surface,
    Trajectory,
    Uniform,
    VectorialNoise,
    Viscoelastic,
)  # fmt: skip
from mesokit.method.brownian import Brownian
from mesokit.method.flock.engine import flocks
from mesokit.method.flock.engine.flocks import Flocks
from mesokit.method.mpcd.engine.cpu.engine import CPU
from mesokit.method.spheres.hard.engine import system
from tests.helpers.flocks import ANY_WALLS
from tests.helpers.flocks import case as flock
from tests.helpers.hard_spheres import gas
from tests.helpers.kinds_of_fluid import (
    AMONG_MOLECULES,
    DISSOLVED,
    EMBEDDED,
    MOLECULES,
    PARTICLES,
    SEVERAL_KINDS,
    everything,
)  # fmt: skip
from tests.helpers.shapes import EVERY, fluid_between, walls_in
from tests.helpers.small_fluids import assert_same, make_case, make_fluid
from tests.helpers.soft_spheres import lennard_jones, pile, soft

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


class Row(NamedTuple):
    """A case. `make(threads, reach)` is its engine at the start; how far lists reach, or how large
    cells are, changes no bit, and `reaches` are tried in turn: the first by the reference."""

    make: Callable
    steps: int
    seen: Callable = lambda engine: list(engine.state().values())  # what is compared
    ways: Sequence = ((2, 7), (3, 1))  # threads, and steps at a time
    stops: Sequence = (30,)
    reaches: Sequence = (None,)
    patches: Sequence = ()  # sizes of the machinery that change no bit either
    bare: Callable | None = None  # an engine that is not begun: it takes any state
    holds: Callable = lambda engine: True  # that there is something to forget
    long: bool = False


def of_fluid(case, steps=STEPS, long=False):
    """A row of a fluid of many kinds."""
    unmeasured = {key: value for key, value in case.items() if key != "measures"}
    return Row(
        make=lambda threads, _: make_fluid(**case, threads=threads),
        bare=lambda threads, _: CPU(make_case(**unmeasured), threads, case.get("measures", ())),
        steps=steps, seen=everything, ways=((2, 1), (3, 7), (7, 100)), stops=(0, 33, 100),
        long=long,
    )  # fmt: skip


def of_shape(number):
    """A row of a fluid among solids of a shape."""
    case = EVERY[number]
    steps = {2: 40, 3: 15}[case[1]]

    def make(threads, _):
        walls = walls_in(case, Path(tempfile.mkdtemp()))
        return fluid_between(
            walls, case[1], ("no-slip", "slip", "diffuse")[number % 3], 0.3, threads
        )

    def seen(fluid):
        taken = fluid.wall_impulse, fluid.memory.wall_rates
        return fluid.positions(), fluid.velocities(), fluid.images(), *taken

    return Row(make, steps, seen, ways=((2, steps), (3, 7)), stops=(), long=True)


def of_beads(**shear):
    """A row of polymers whose lists reach near or far."""

    def make(threads, skin):
        solutes = Solutes(
            (Polymer(4, length=10), Polymer(1, length=7, topology="star", arms=3), Polymer(10)),
            mass=5.0, bond=FENE(), bending=Bending(kappa=2.0), pair=WCA(), substeps=50, skin=skin,
        )  # fmt: skip
        return make_fluid((9, 8, 7), solutes=solutes, density=4, threads=threads, **shear)

    return Row(make, 60, everything, ways=((2, 60), (1, 60)), stops=(), reaches=(0.05, 0.4, 1.5))


def of_birds(size, walls=(), **birds):
    """A row of a flock, whose cells are smaller or larger."""

    def make(threads, side):
        given = flock(size, walls=walls, density=6, **birds)
        engine = Flocks(given, threads, side)
        engine.restore(Simulation(given).engine.state())
        assert engine.threads == threads
        return engine

    fewest = ((flocks, "FEWEST", 50),)
    return Row(make, 60, reaches=(None, 1.7, 2.9), patches=fewest)


def of_hard_spheres(collision):
    """A row of hard spheres, whose bins are smaller."""

    def make(threads, _):
        given = {"packing_fraction": 0.45, "start": RandomStart(), "collision": collision}
        return gas([12, 13.5], timestep=1.0, **given).engine

    smaller = {"WANTED": {2: 25.0, 3: 25.0}, "PER_BIN": 0.3, "ROOM": 2}
    patches = [(system, name, value) for name, value in smaller.items()]
    return Row(make, 12, ways=((1, 5),), stops=(5,), patches=patches)


def of_soft_spheres(make, steps, skins, touching=None):
    """A row of soft spheres; `touching`: those of its arrays that remember contacts."""

    def holds(engine):
        return touching is None or touching(engine.state())

    return Row(
        make, steps, ways=((2, steps // 3),), stops=(steps // 2,), reaches=skins, holds=holds
    )


def grains(threads, skin, dimension):
    return soft(
        [8.0, 8.0, 20.0] if dimension == 3 else [16.0, 20.0], walls=[Plates("xyz"[dimension - 1])],
        number=220, kinds=[SphereKind(0.9, spread=0.1)], kT=0.5, skin=skin, threads=threads,
        gravity=[0.0] * (dimension - 1) + [-5.0],
        pair=SpringDashpot(0.5, contact_time=0.05, friction=0.5, rolling=0.1),
    )  # fmt: skip


CHAOS = AngularNoise(2.0)
WALKS = {
    "run": Run(60, method="brownian"), "box": Box([9, 7]),
    "brownian": Brownian(density=50, diffusion=0.7, timestep=0.02),
}  # fmt: skip
ROWS = {
    **{name: of_fluid(case) for name, case in (PARTICLES | MOLECULES).items()},
    **{name: of_fluid(case, FEWER) for name, case in DISSOLVED.items()},
    **{name: of_fluid(case, long=True) for name, case in (OF_SOLUTES | IN_TIME).items()},
    **{f"among molecules: {k}": of_fluid(v, long=True) for k, v in AMONG_MOLECULES.items()},
    **{f"among solids: {'-'.join(map(str, c))}": of_shape(k) for k, c in enumerate(EVERY)},
    "lists of beads": of_beads(),
    "lists of sheared beads": of_beads(shear_rate=0.3, thermostat=MaxwellBoltzmann()),
    "walks": Row(lambda threads, _: Simulation(**WALKS, threads=threads).engine, 60),
    "flock": of_birds((11, 9.5), noise=CHAOS),
    "flock in 3D": of_birds((5, 6.2, 4), noise=AngularNoise(1.0)),
    "flock in the original order": of_birds((11, 9.5), noise=CHAOS, order="original"),
    "flock with vectorial noise": of_birds((11, 9.5), noise=VectorialNoise(0.5)),
    "flock that coheres": of_birds((11, 9.5), noise=VectorialNoise(0.3), cohesion=Cohesion()),
    "flock among walls": of_birds((20, 20), ANY_WALLS, noise=AngularNoise(1.0)),
    "hard spheres": of_hard_spheres(HardCollision()),
    "square wells": of_hard_spheres(SquareWell(width=1.3)),
    "viscoelastic spheres": of_hard_spheres(Viscoelastic(0.05, contact_time=1e-4)),
    **{
        f"grains in {d}D": of_soft_spheres(
            lambda threads, skin, d=d: grains(threads, skin, d), 4000, (None, 0.3, 0.03),
            lambda state: len(state["pairs"]) > 50,
        )
        for d in (2, 3)
    },
    "liquid": of_soft_spheres(
        lambda threads, skin: lennard_jones(threads=threads, skin=skin), 150, (None, 0.7, 0.1)
    ),
    "pile on a solid": of_soft_spheres(
        pile, 6000, (None, 0.3, 0.05), lambda state: (state["solid_terms"] >= 0).sum() > 3
    ),
}  # fmt: skip


def each(what):
    """Every row with every of its ways or stops."""
    return [
        pytest.param(row, k, one, id=f"{name}-{one}", marks=[pytest.mark.long] * row.long)
        for name, row in ROWS.items()
        for k, one in enumerate(getattr(row, what), 1)
    ]


@pytest.fixture(scope="module")
def ends():
    """What is seen at the end of each row on one thread, in one go."""
    return {}


@pytest.fixture
def expected(row, ends, monkeypatch):
    if id(row) not in ends:
        engine = row.make(1, row.reaches[0])
        engine.advance(row.steps)
        assert row.holds(engine)
        ends[id(row)] = row.seen(engine)
    for patch in row.patches:
        monkeypatch.setattr(*patch)
    return ends[id(row)]


def reach(row, number):
    return row.reaches[number % len(row.reaches)]


@pytest.mark.parametrize(("row", "number", "way"), each("ways"))
def test_for_any_threads_lists_and_division_of_the_steps(row, number, way, expected):
    """Looks in between change nothing."""
    threads, cut = way
    engine = row.make(threads, reach(row, number))
    for step in range(0, row.steps, cut):
        engine.advance(min(cut, row.steps - step))
        row.seen(engine)
    assert_same(row.seen(engine), expected)


@pytest.mark.parametrize(("row", "number", "stop"), each("stops"))
def test_from_a_state(row, number, stop, expected):
    stop = min(stop, row.steps - 1)
    first = row.make(2, reach(row, number))
    first.advance(stop)
    second = (row.bare or row.make)(3, reach(row, number + 1))
    second.restore({name: array.copy() for name, array in first.state().items()})
    second.advance(row.steps - stop)
    assert_same(row.seen(second), expected)


# --- runs with files ----------------------------------------------------------------------------

FIELDS = ("position", "velocity", "image")


def among_solids(**fluid):
    """A run that has the forces on solids measured."""
    walls = [
        Plates(axis="y"),
        Disk(centre=[10, 10], radius=4, surface=Surface("diffuse", rotation=0.05)),
        Capsule(start=[18, 3], end=[23.5, 5], radius=1.2),
    ]
    return {
        "run": Run(steps=60, warmup=5, checkpoint_every=17), "box": Box([24, 20]), "walls": walls,
        "fluid": Fluid(**fluid, force=Uniform([0.002, 0])), "observe": [Forces(every=3)],
    }  # fmt: skip


def replicas():
    """Copies of a gas."""
    return {
        "run": Run(40, warmup=5, seed=5, replicas=3, method="event-driven"),
        "box": Box([12.5, 12.5]),
        "spheres": HardSpheres(packing_fraction=0.3, timestep=0.5, start=RandomStart()),
        "observe": [EquationOfState()],
    }  # fmt: skip


CHAINS = Solutes((Polymer(3, length=4),), mass=5.0, bond=Harmonic(K=1.0))
MOVED = MeanSquareDisplacement(every=5, max_lag=20)
FRAMES = {"every": 10, "fields": ["position", "velocity", "image", "id"]}
RUNS = {
    "walks": WALKS | {
        "observe": [MOVED], "trajectory": Trajectory(every=10, fields=["position", "image", "id"]),
    },
    "flock": {
        "run": Run(60, method="flock"), "box": Box([12, 12]), "flock": Flock(density=5),
        "observe": [PolarOrder(every=5), MOVED], "trajectory": Trajectory(**FRAMES),
    },
    "rotations among solids": among_solids(thermostat=MaxwellBoltzmann()),
    "drawn velocities among solids": among_solids(collision=AT()),
    "solutes": {
        "run": Run(12), "box": Box([8, 8, 8]), "fluid": Fluid(density=2), "solutes": CHAINS,
        "observe": [], "trajectory": Trajectory(**FRAMES),
    },
    "replicas": replicas(),
}  # fmt: skip


@pytest.mark.parametrize("name", RUNS)
def test_a_stopped_run_goes_on(name, tmp_path):
    """Its results, its frames and the state of each replica; frames are what the engine has."""
    case = Case(**RUNS[name])
    whole = Simulation(case, output=tmp_path / "whole", threads=1)
    whole.run()
    stopped = Simulation(case, output=tmp_path / "part", threads=2)
    stopped.run(case.run.steps // 2 + 1)
    stopped.checkpoint()
    resumed = Simulation.resume(tmp_path / "part", threads=3)
    assert resumed.step == stopped.step < whole.step
    resumed.run()
    for a, b in zip(engines(whole), engines(resumed), strict=True):
        first, second = a.state(), b.state()
        assert_same(first.values(), [second[key] for key in first])
    one, other = (mesokit.open(tmp_path / folder) for folder in ("whole", "part"))
    assert one.results == other.results == resumed.results == whole.results
    if case.trajectory is None:
        return
    assert len(one.trajectory) == case.run.steps // case.trajectory.every + 1
    fields = [field for field in FIELDS if field in case.trajectory.fields]
    for field in fields:
        np.testing.assert_array_equal(one.trajectory.read(field), other.trajectory.read(field))
    if case.run.steps % case.trajectory.every == 0:
        for field in fields:
            last = getattr(whole.engine, f"{field}s" if field != "velocity" else "velocities")()
            np.testing.assert_allclose(one.trajectory[-1][field], last, atol=1e-5)


def engines(simulation):
    """Those of all replicas."""
    return [one.engine for one in simulation.replicas.all]


# --- what the table stands on -------------------------------------------------------------------


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
    odd = {name for name, case in PARTICLES.items() if make_fluid(**case).n % 2}
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
