"""A run that is stopped and resumed, in whatever way, ends with the bits of one that was not."""

import errno
import functools
import signal
import threading

import numpy as np
import pytest

import mesokit
from mesokit.errors import CheckpointError, RunError
from mesokit.io import atomic
from mesokit.report.progress import Reporter
from mesokit.run.simulation import Simulation


def resumed(folder, threads=1):
    simulation = Simulation.resume(folder, threads=threads)
    simulation.run()
    return simulation


@pytest.mark.parametrize("threads", [2, 3])
def test_threads_do_not_matter(case, ends_alike, tmp_path, threads):
    simulation = Simulation(case, output=tmp_path / "run", threads=threads)
    simulation.run()
    ends_alike(simulation)


@pytest.mark.parametrize("seed", range(8))
def test_a_crash_at_any_step(case, ends_alike, tmp_path, crash_at, seed):
    """Several crashes, at steps and with threads drawn from the seed."""
    random = np.random.default_rng(seed)
    steps = np.sort(random.integers(1, 437, size=random.integers(1, 4)))
    simulation = Simulation(case, output=tmp_path / "run", threads=int(random.integers(1, 4)))
    for step in steps:
        with pytest.raises(crash_at.error):
            simulation.run(progress=crash_at(step))
        simulation = Simulation.resume(tmp_path / "run", threads=int(random.integers(1, 4)))
        assert simulation.step <= step + 20
    simulation.run()
    ends_alike(simulation)


def test_results_so_far(case, tmp_path, crash_at):
    """A run that goes on shows what it has measured by its last checkpoint."""
    simulation = Simulation(case, output=tmp_path / "run", threads=1)
    with pytest.raises(crash_at.error):
        simulation.run(progress=crash_at(200))
    files = mesokit.open(tmp_path / "run")
    early = dict(files.results)
    assert not files.ended and 0 < files["velocity-profile"].samples < 200 / 3
    assert repr(files["conservation"]).splitlines()[0] in repr(files)
    resumed = Simulation.resume(tmp_path / "run")
    assert resumed.results == early
    resumed.run()
    assert files.results == resumed.results and files.results != early


def test_lost_frames_are_missed(case, tmp_path, crash_at):
    simulation = Simulation(case, output=tmp_path / "run", threads=1)
    with pytest.raises(crash_at.error):
        simulation.run(progress=crash_at(200))
    assert "its last checkpoint is at step" in repr(mesokit.open(tmp_path / "run"))
    with pytest.raises(RunError, match=r"has not ended.* of 437.*mesokit resume"):
        _ = mesokit.open(tmp_path / "run").trajectory
    segments = simulation._folder.writer.segments()
    lost = segments[1]
    lost.unlink()
    step = int(lost.stem.split("-")[1])
    with pytest.raises(RunError, match=rf"trajectory: .* frames are missing, .* step {step};"):
        Simulation.resume(tmp_path / "run")
    assert simulation._folder.writer.segments() == [s for s in segments if s != lost]


def test_a_finished_run_can_be_resumed(case, ends_alike, tmp_path, monkeypatch):
    """It takes no step, and so compiles nothing."""
    Simulation(case, output=tmp_path / "run", threads=1).run()
    simulation = Simulation.resume(tmp_path / "run", threads=1)
    monkeypatch.setattr(simulation.engine, "advance", pytest.fail)
    simulation.run()
    ends_alike(simulation)


def test_checkpoints_do_not_depend_on_when_they_are_written(case, ends_alike, tmp_path):
    simulation = Simulation(case, output=tmp_path / "run", threads=1)
    simulation.checkpoint()
    ends_alike(resumed(tmp_path / "run", threads=2))


STOPS = [
    getattr(signal, name)
    for name in ("SIGINT", "SIGTERM", "SIGHUP", "SIGUSR1")
    if hasattr(signal, name)
]


@pytest.mark.parametrize("number", STOPS)
def test_a_signal_writes_a_checkpoint(case, ends_alike, tmp_path, number, request):
    simulation = Simulation(case, output=tmp_path / "run", threads=1)
    request.addfinalizer(functools.partial(signal.signal, number, signal.getsignal(number)))
    before = signal.default_int_handler  # nohup has SIGHUP ignored, and so would a run
    signal.signal(number, before)

    class Press(Reporter):
        def update(self, step):
            if step > 150 and simulation._stop.by is None:
                signal.raise_signal(number)

    with pytest.raises(KeyboardInterrupt, match=number.name) as stop:
        simulation.run(progress=Press(quiet=True))
    assert stop.value.status == 128 + number
    assert signal.getsignal(number) is before
    again = Simulation.resume(tmp_path / "run", threads=1)
    assert again.step == simulation.step > 150
    again.run()
    ends_alike(again)


def test_a_second_signal_stops_at_once(case):
    simulation = Simulation(case, threads=1)

    class Press(Reporter):
        def update(self, step):
            signal.raise_signal(signal.SIGINT)
            signal.raise_signal(signal.SIGTERM)
            raise AssertionError("went on")

    with pytest.raises(KeyboardInterrupt) as stop:
        simulation.run(progress=Press(quiet=True))
    assert stop.value.status == 128 + signal.SIGTERM


@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="the system has no such signal")
def test_nohup_is_respected(case):
    """A terminal that is closed stops no run that was told to ignore it."""
    simulation, before = Simulation(case, threads=1), signal.signal(signal.SIGHUP, signal.SIG_IGN)

    class Press(Reporter):
        def update(self, step):
            signal.raise_signal(signal.SIGHUP)

    try:
        simulation.run(progress=Press(quiet=True))
        assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGHUP, before)
    assert simulation.step == simulation.last_step


def test_a_signal_after_the_last_step_stops_nothing(case, ends_alike, tmp_path):
    simulation = Simulation(case, output=tmp_path / "run", threads=1)

    class Press(Reporter):
        def update(self, step):
            if step == simulation.last_step:
                signal.raise_signal(signal.SIGINT)

    simulation.run(progress=Press(quiet=True))
    ends_alike(simulation)


def test_a_signal_stops_a_run_without_a_folder(case):
    """As in a notebook; `run` then goes on to the same bits."""
    simulation, whole = Simulation(case, threads=1), Simulation(case, threads=1)

    class Press(Reporter):
        def update(self, step):
            if step > 150 and simulation._stop.by is None:
                signal.raise_signal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt, match="SIGINT"):
        simulation.run(progress=Press(quiet=True))
    assert 150 < simulation.step < simulation.last_step
    simulation.run()
    whole.run()
    assert simulation.results == whole.results


def stops_on(monkeypatch, function):
    def refuse(*arguments, **keywords):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(atomic.os, function, refuse)


@pytest.mark.parametrize("function", ["fsync", "replace"])
def test_a_full_disk_leaves_the_old_checkpoint(
    case, ends_alike, tmp_path, crash_at, monkeypatch, function
):
    simulation = Simulation(case, output=tmp_path / "run", threads=1)
    with pytest.raises(crash_at.error):
        simulation.run(progress=crash_at(100))
    file = simulation.directory.checkpoint_file
    whole = file.read_bytes()
    with monkeypatch.context() as patch:
        stops_on(patch, function)
        with pytest.raises(RunError, match=r"checkpoint\.npz.*no space left"):
            simulation.checkpoint()
    assert file.read_bytes() == whole
    assert not list(file.parent.glob(".*.tmp"))
    ends_alike(resumed(tmp_path / "run"))


def test_a_checkpoint_that_breaks_off_leaves_the_old_one(case, ends_alike, tmp_path, crash_at):
    """A real partial write: the system lets files grow to a few thousand bytes only."""
    simulation = Simulation(case, output=tmp_path / "run", threads=1)
    with pytest.raises(crash_at.error):
        simulation.run(progress=crash_at(100))
    file = simulation.directory.checkpoint_file
    whole = file.read_bytes()
    resource = pytest.importorskip("resource")
    old = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (5000, old[1]))
    try:
        with pytest.raises(RunError, match=r"cannot write .*: file too large"):
            simulation.checkpoint()
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, old)
    assert file.read_bytes() == whole
    ends_alike(resumed(tmp_path / "run"))


def test_a_damaged_checkpoint_is_refused(case, tmp_path, crash_at):
    simulation = Simulation(case, output=tmp_path / "run", threads=1)
    with pytest.raises(crash_at.error):
        simulation.run(progress=crash_at(100))
    file = simulation.directory.checkpoint_file
    whole = file.read_bytes()
    for damaged in (whole[: len(whole) // 2], b"", whole[:3000] + b"\0\1\2" + whole[3003:]):
        file.write_bytes(damaged)
        with pytest.raises(CheckpointError):
            Simulation.resume(tmp_path / "run")


def test_in_a_thread_that_is_not_the_main_one(case, ends_alike, tmp_path):
    simulation = Simulation(case, output=tmp_path / "run", threads=2)
    errors = []

    def work():
        try:
            simulation.run()
        except BaseException as error:
            errors.append(error)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert not errors
    ends_alike(simulation)
