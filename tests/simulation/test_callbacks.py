"""Functions of the user inside a run: when they are called, and what they may do."""

import dataclasses

import numpy as np
import pytest

import mesokit
from mesokit import StopRun, every
from mesokit.errors import CaseError, RunError
from mesokit.run.simulation import Simulation


@pytest.fixture
def short(case):
    """Fewer steps, and nothing written but checkpoints."""
    run = dataclasses.replace(case.run, steps=63)  # 100 with the warm-up
    return dataclasses.replace(case, run=run, trajectory=None)


def recorder(steps, n):
    return every(n, lambda simulation: steps.append(simulation.step))


def test_called_from_step_0_on_and_only_once_at_each(short):
    tens, sevens = [], []
    Simulation(short, callbacks=[recorder(tens, 10), recorder(sevens, 7)], threads=1).run()
    assert tens == [*range(0, 101, 10)]
    assert sevens == [*range(0, 101, 7)]


def test_reading_changes_no_bits(case, ends_alike):
    def read(simulation):
        engine = simulation.engine
        assert engine.positions().shape == (case.particles, 2)
        assert simulation.time == pytest.approx(0.1 * simulation.step)
        seen.append((engine.totals(), engine.velocities(), simulation.results))

    seen = []
    simulation = Simulation(case, callbacks=[every(13, read)], threads=2)
    simulation.run()
    assert len(seen) == 437 // 13 + 1
    ends_alike(simulation, files=False)


def test_stop_and_go_on(short, tmp_path):
    def stop(simulation):
        if simulation.step in (0, 30):
            raise StopRun("enough")

    calls = []
    callbacks = [every(5, stop), recorder(calls, 10)]
    simulation = Simulation(short, output=tmp_path / "run", callbacks=callbacks, threads=1)
    simulation.run()
    assert simulation.step == 0
    assert simulation.callbacks.stopped == "enough"
    simulation.run()
    assert simulation.step == 30
    assert not (tmp_path / "run" / "run.h5").exists()
    again = Simulation.resume(tmp_path / "run", callbacks=[recorder(calls, 10)], threads=1)
    again.run()
    assert calls == [*range(0, 101, 10)]
    assert again.callbacks.stopped is None
    whole = Simulation(short, threads=1)
    whole.run()
    np.testing.assert_array_equal(again.engine.velocities(), whole.engine.velocities())
    assert again.results == whole.results


def test_a_failure_ends_the_run_and_leaves_the_checkpoint(short, tmp_path):
    def fail(simulation):
        if simulation.step == 50:
            raise ZeroDivisionError("no\nway")

    simulation = Simulation(short, output=tmp_path / "run", callbacks=[every(25, fail)], threads=1)
    with pytest.raises(RunError, match=r"^callback fail at step 50: ZeroDivisionError: no way$"):
        simulation.run()
    assert "callback fail" in mesokit.open(tmp_path / "run").provenance["failed"]
    assert Simulation.resume(tmp_path / "run", threads=1).step == 40


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: every(0, print), r"steps = 0: expected a whole number of at least 1"),
        (lambda: every(2.5, print), r"steps = 2\.5: expected a whole number"),
        (lambda: every(5, "f"), r"call = 'f': expected a function"),
        (lambda: Simulation("no.toml", callbacks=print), r"callbacks = .*: expected a list"),
    ],
)
def test_what_is_no_callback_is_refused(make, words):
    with pytest.raises(CaseError, match=words):
        make()


def test_a_function_alone_is_told_how_to_say_when(short):
    with pytest.raises(CaseError, match=r"callbacks\[#1\] = .*: expected every\(n, function\)"):
        Simulation(short, callbacks=[print])
