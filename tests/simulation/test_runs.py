"""What a run is: its start, its warm-up, and its independence of who looks."""

import dataclasses

import numpy as np
import pytest

from mesokit import Box, Fluid, MaxwellBoltzmann, NoThermostat, Run, Uniform
from mesokit.errors import CaseError, RunError
from mesokit.method.mpcd.start.section import Start
from mesokit.run.simulation import Simulation


def replaced(case, **parts):
    return dataclasses.replace(case, **parts)


def state(simulation):
    fluid = simulation.engine
    return fluid.positions(), fluid.velocities(), fluid.images()


def assert_same(one, other):
    for a, b in zip(one, other, strict=True):
        np.testing.assert_array_equal(a, b)


def test_looking_changes_nothing(case, uninterrupted):
    """Other intervals, other outputs, other checkpoints, or none: the same particles."""
    blind = replaced(case, observe=(), trajectory=None)
    often = replaced(
        case,
        observe=tuple(dataclasses.replace(o, every=1) for o in case.observe),
        run=dataclasses.replace(case.run, checkpoint_every=None),
        trajectory=None,
    )
    for other in (blind, often):
        simulation = Simulation(other, threads=2)
        simulation.run()
        assert_same(state(simulation), state(uninterrupted))


def test_warm_up_is_seen_by_no_observer(case):
    """Samples come only where it ends, and the wall's first one holds nothing from before."""
    steps, warmup, every = 10, 37, 5
    run = dataclasses.replace(case.run, steps=steps)
    observe = tuple(dataclasses.replace(o, every=every) for o in case.observe)
    simulation = Simulation(replaced(case, run=run, observe=observe), threads=1)
    simulation.run()
    for name, result in simulation.results.items():  # the stress on walls is summed up in steps
        assert result.samples == steps // every + (name != "wall-stress"), name
    seen = simulation["conservation"].extra["step"]
    np.testing.assert_array_equal(seen, [warmup, warmup + 5, warmup + 10])

    # the same particles, started where the warm-up ends
    only_warm = Simulation(replaced(case, run=dataclasses.replace(run, steps=0)), threads=1)
    only_warm.run()
    for name, result in only_warm.results.items():
        assert result.samples == (name != "wall-stress"), name
    fluid = only_warm.engine
    before = fluid.wall_impulse
    fluid.advance(steps)
    area, dt = case.box.size[0], case.fluid.timestep
    np.testing.assert_allclose(
        simulation["wall-stress"].value,
        (fluid.wall_impulse - before)[:, :2] / (steps * dt * area),
        atol=1e-9,
    )


def test_no_warm_up_and_no_steps(case):
    run = dataclasses.replace(case.run, steps=0, warmup=0)
    simulation = Simulation(replaced(case, run=run), threads=1)
    simulation.run()
    assert simulation.step == 0


@pytest.fixture
def arrays(case):
    random = np.random.default_rng(4)
    n, size = case.particles, np.array(case.box.size)
    return random.random((n, 2)) * size, random.standard_normal((n, 2))


def test_start_from_arrays_by_particle_id(case, arrays, tmp_path):
    simulation = Simulation(case, positions=arrays[0], velocities=arrays[1], threads=1)
    np.testing.assert_allclose(simulation.engine.positions(), arrays[0], atol=1e-14)
    np.testing.assert_array_equal(simulation.engine.velocities(), arrays[1])
    simulation.run()
    for name, array in zip(("positions", "velocities"), arrays, strict=True):
        np.save(tmp_path / f"{name}.npy", array)
    files = Start(
        positions=str(tmp_path / "positions.npy"), velocities=str(tmp_path / "velocities.npy")
    )
    from_files = replaced(case, fluid=dataclasses.replace(case.fluid, start=files))
    other = Simulation(from_files, threads=1)
    other.run()
    assert_same(state(other), state(simulation))


def test_arrays_survive_a_crash_before_the_first_checkpoint(case, arrays, tmp_path, crash_at):
    whole = Simulation(case, positions=arrays[0], velocities=arrays[1], threads=1)
    whole.run()
    simulation = Simulation(
        case, positions=arrays[0], velocities=arrays[1], output=tmp_path / "run", threads=1
    )
    with pytest.raises(crash_at.error):
        simulation.run(progress=crash_at(1))
    again = Simulation.resume(tmp_path / "run", threads=2)
    again.run()
    assert_same(state(again), state(whole))


def test_wrong_arrays_are_refused(case, arrays):
    r, v = arrays
    for bad in ({"positions": r[:-1]}, {"velocities": v * np.nan}, {"positions": r + [0, 9]}):
        with pytest.raises(CaseError, match=r"fluid\.start"):
            Simulation(case, **bad)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda a: [["a", "b"]], ", not of str"),
        (lambda a: a.astype(str), ", not of str"),
        (lambda a: a.astype(complex), ", not of complex128"),
        (lambda a: a > 0, ", not of bool"),
        (lambda a: a.astype(object), ", not of object"),
        (lambda a: a.astype("datetime64[s]"), ", not of datetime64"),
        (lambda a: np.ma.masked_less(a, 0.5), " without a mask"),
        (lambda a: [[1, 2], [3]], ""),
        (lambda a: {"x": a}, ", not of object"),
    ],
)
@pytest.mark.parametrize("name", ["positions", "velocities"])
def test_arrays_of_no_numbers_are_refused(case, arrays, name, change, words):
    match = rf"^fluid\.start\.{name}: expected an array of numbers{words}"
    with pytest.raises(CaseError, match=match):
        Simulation(case, **{name: change(arrays[0])})


@pytest.mark.parametrize("kind", ["float32", "int16", "uint8", "longdouble"])
def test_arrays_of_any_real_numbers_are_taken(case, arrays, kind):
    velocities = np.abs(arrays[1]).astype(kind)
    simulation = Simulation(case, velocities=velocities, threads=1)
    np.testing.assert_array_equal(simulation.engine.velocities(), velocities.astype(float))


@pytest.mark.parametrize("thermostat", [NoThermostat(), MaxwellBoltzmann()])
def test_a_fluid_that_is_too_fast_is_refused_at_the_end_as_well(thermostat):
    """Before the first sort, and without a folder."""
    fluid = Fluid(density=5, force=Uniform((1e7, 0.0)), thermostat=thermostat)
    simulation = Simulation(run=Run(5), box=Box([8, 8]), fluid=fluid, threads=1)
    with pytest.raises(RunError, match=r"step 5: a particle moves at .* lower the force") as error:
        simulation.run()
    assert ("add a thermostat" in str(error.value)) == (not thermostat.acts)


def test_what_is_no_number_ends_a_run(case):
    """Wherever it came from: it would be in no cell, and nobody would miss it."""
    simulation = Simulation(case, threads=1)
    memory = simulation.engine.memory
    memory.fluid.particles.data[memory.at(2)[7]] = np.nan  # a velocity
    with pytest.raises(RunError, match=r"a particle moves at inf"):
        simulation.engine.check()


def test_positions_too_far_away_for_counting_boxes_are_refused(case, arrays):
    r = arrays[0].copy()
    r[5, 0] = -12 * (2**30 - 1)
    simulation = Simulation(case, positions=r, threads=1)
    assert simulation.engine.images()[5].tolist() == [1 - 2**30, 0]
    for far in (12.0 * 2**30, -1e300):
        r[5, 0] = far
        with pytest.raises(CaseError, match=r"positions: row 5 = .* 2\^30 boxes away or more"):
            Simulation(case, positions=r)


def test_no_array_is_silently_ignored(case, arrays, uninterrupted, tmp_path):
    np.save(tmp_path / "v.npy", arrays[1])
    for start in (Start(run=str(uninterrupted.directory.path)), Start(velocities=str(tmp_path))):
        other = replaced(case, fluid=dataclasses.replace(case.fluid, start=start))
        with pytest.raises(CaseError, match=r"^fluid\.start\..*: not with an array of velocities"):
            Simulation(other, velocities=arrays[1])
    start = Start(velocities=str(tmp_path / "v.npy"))
    other = replaced(case, fluid=dataclasses.replace(case.fluid, start=start))
    simulation = Simulation(other, positions=arrays[0], threads=1)
    np.testing.assert_allclose(simulation.engine.positions(), arrays[0], atol=1e-14)
    np.testing.assert_array_equal(simulation.engine.velocities(), arrays[1])


def test_a_case_may_be_the_path_of_its_file(case, case_file):
    assert (
        Simulation(case_file, threads=1).case == Simulation(str(case_file), threads=1).case == case
    )
    with pytest.raises(CaseError, match=r"case = 3: expected a case, or the path of its file"):
        Simulation(3)
    with pytest.raises(CaseError, match=r"nowhere\.toml: no such file"):
        Simulation("nowhere.toml")


@pytest.mark.parametrize("threads", [0, -1, 1.5, True, "2", 10**6])
def test_threads_are_a_whole_number(case, uninterrupted, threads):
    with pytest.raises(CaseError, match=r"^threads = .*: expected a whole number from 1 to 1024$"):
        Simulation(case, threads=threads)
    with pytest.raises(CaseError, match=r"^threads = "):
        Simulation.resume(uninterrupted.directory.path, threads=threads)


def test_start_from_an_earlier_run(case, uninterrupted, tmp_path):
    earlier = Start(run=str(uninterrupted.directory.path))
    going_on = replaced(case, fluid=dataclasses.replace(case.fluid, start=earlier))
    simulation = Simulation(going_on, threads=1, output=tmp_path / "on")
    assert simulation.step == 0
    assert_same(state(simulation)[:2], state(uninterrupted)[:2])
    simulation.run()
    assert simulation.step == 437


def test_two_simulations_in_one_process(case, uninterrupted):
    """In turns, with another seed beside: neither disturbs the other."""
    one = Simulation(case, threads=2)
    two = Simulation(replaced(case, run=dataclasses.replace(case.run, seed=9)), threads=1)
    while one.step < 437:
        one.engine.advance(min(23, 437 - one.step))
        two.engine.advance(11)
    assert_same(state(one), state(uninterrupted))
