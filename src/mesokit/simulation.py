"""A simulation: build it, run it, resume it, look at what it measured."""

from __future__ import annotations

import contextlib
import signal
import warnings
from collections.abc import Sequence
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

from mesokit.case.case import Case
from mesokit.case.kind import note_run
from mesokit.case.outside import blaming
from mesokit.case.trajectory import written
from mesokit.errors import CheckpointError, RunError
from mesokit.io import h5md
from mesokit.io.frames import NONE_YET, require_frames
from mesokit.io.measured import keep, take_up
from mesokit.io.one_writer import alone
from mesokit.io.run_directory import RunDirectory, provenance
from mesokit.io.trajectory import TrajectoryWriter
from mesokit.method.protocol import method_of
from mesokit.ranks.order import Coming, Order
from mesokit.ranks.world import world
from mesokit.report.document.progress import reporter_for
from mesokit.report.progress import Reporter
from mesokit.running import record
from mesokit.running.callbacks import Callback, Callbacks
from mesokit.running.compiling import telling
from mesokit.running.given import case_and_arrays, threads_of, told
from mesokit.running.log import RunLog
from mesokit.running.longer import longer, require_steps
from mesokit.running.on_ranks import require_ranks, shared_work
from mesokit.running.pace import Pace
from mesokit.running.replicas import Replicas
from mesokit.running.results import write_results
from mesokit.running.schedule import Leg, Schedule
from mesokit.running.seen import Seen
from mesokit.running.signals import Stopped, catching
from mesokit.running.until import Goal, limit_of, next_length

if TYPE_CHECKING:
    from mesokit.observe.shared.result import Result


def _existing(output: str | Path, held: contextlib.ExitStack) -> RunDirectory:
    """A run that can go on, and in whose folder nobody else writes as long as that is held."""
    directory = RunDirectory.existing(output)
    held.enter_context(alone(directory))
    if not directory.checkpoint_file.exists() and "merged" in record.earlier(directory):
        raise RunError(
            f"{directory.path}: holds merged runs; go on with those and merge them again"
        )
    if directory.data_file.exists() and not directory.checkpoint_file.exists():
        raise CheckpointError(
            f"{directory.checkpoint_file}: no such checkpoint, though the run had come to "
            f"{directory.data_file.name}; to run it anew: {directory.again}"
        )
    return directory


class Simulation(Seen):
    """A case in memory, ready to run.

    Parameters
    ----------
    case : Case or path, optional
        What to simulate, or the file of it; or give its parts (`run`, `box`, `fluid`, `walls`,
        ...) by name.
    output : path, optional
        Folder to write to; nothing is written without it.
    threads : int, optional
        Threads to use (all cores unless said). Results do not depend on it.
    positions, velocities, beads, bead_velocities : array (n, d), optional
        Start from these, by particle number, in cells and cells per unit of time; another method
        of simulation than MPCD may have arrays of other names.
    callbacks : sequence of Callback, optional
        Functions to call while it runs: `[every(100, function)]`, see `mesokit.every`.

    Raises
    ------
    CaseError
        For a case that cannot be run.
    RunError
        If the folder cannot be written, or holds something already.

    Examples
    --------
    >>> from mesokit import Box, Conservation, Run, Simulation
    >>> simulation = Simulation(run=Run(steps=20), box=Box([8, 8]), observe=[Conservation(every=1)])
    >>> simulation.run()
    >>> simulation.step
    20
    """

    def __init__(
        self,
        case: Case | str | Path | None = None,
        *,
        output: str | Path | None = None,
        threads: int | None = None,
        callbacks: Sequence[Callback] = (),
        **parts: Any,
    ) -> None:
        self.ranks = world()
        self.callbacks = Callbacks(callbacks)
        self.case, arrays = case_and_arrays(case, parts)
        self.threads = threads_of(threads, self.ranks)
        self.ranks.require_same(lambda: told(self.case, self.callbacks, arrays))
        with blaming(self.case):
            self._build()
            self.replicas.start(arrays)
        self.directory: RunDirectory | None = None
        if output is not None:
            self.write_to(output)
            if arrays:
                self.checkpoint()

    def write_to(self, output: str | Path) -> None:
        """Write to this new folder from now on. Raises RunError if it holds something already."""
        directory = self.ranks.on_root(lambda: RunDirectory.create(output, self.case))
        self.case = Case.from_toml(directory.case_file)  # what `resume` will read
        self._attach(directory)
        origin = provenance(self.case, self.threads, self.ranks.size)
        self.ranks.on_root(lambda: directory.write_provenance(origin))

    @classmethod
    def resume(
        cls,
        output: str | Path,
        threads: int | None = None,
        steps: int | None = None,
        callbacks: Sequence[Callback] = (),
    ) -> Simulation:
        """Go on with the run in a folder, from its last checkpoint (or the start, if none).

        With `steps` it lasts so many after its warm-up, and what has ended goes on, to the bits of
        a run that was as long from the start; the case on record says so. Callbacks are not kept
        with a run: name them again.

        Raises CaseError if it has done more steps than that.
        Raises RunError, CheckpointError if there is none, it is damaged, or another process is
        writing there. A damaged record of where the run comes from is a warning, and begun anew.
        """
        here = world()
        with here.quietly(), contextlib.ExitStack() as held:
            directory = here.on_root(lambda: _existing(output, held))
            return cls._resumed(directory, threads, steps, callbacks)

    @classmethod
    def _resumed(
        cls,
        directory: RunDirectory,
        threads: int | None,
        steps: int | None,
        callbacks: Sequence[Callback],
    ) -> Simulation:
        self = cls.__new__(cls)
        self.ranks = world()
        self.case = Case.from_toml(directory.case_file)
        self.threads = threads_of(threads, self.ranks)
        self.callbacks = Callbacks(callbacks)
        given = {"steps": str(steps)}
        self.ranks.require_same(lambda: told(self.case, self.callbacks, {}) | given)
        self._build()
        self._attach(directory)
        if self.ranks.on_root(directory.checkpoint_file.exists):
            meta = take_up(directory, self.case, self.replicas.parts(), self.ranks.comm)
            self._looked = bool(meta["looked"])
        else:
            self.replicas.start({})
        self.ranks.on_root(self._resume_frames)
        if steps is not None:
            self.lengthen(steps)
        if self.step < self.last_step:  # the case may have been made longer by hand
            self.ranks.on_root(self._take_back)
        self.callbacks.resume(self.step)
        self.ranks.on_root(lambda: self.log.resume(self.step))
        begun = self._looked or self.step > 0
        own = self.threads, self.ranks.size, begun
        self.ranks.on_root(lambda: record.note_resumed(directory, self.case, *own))
        return self

    def _resume_frames(self) -> None:
        """Those that came after the checkpoint are forgotten."""
        if self.writer is not None:
            assert self.directory is not None
            seen = self.step if self._looked else NONE_YET
            require_frames(self.directory, self.case, seen)
            self.writer.resume(self.step)

    def _build(self) -> None:
        require_ranks(self.case, self.ranks.size)
        self.replicas = Replicas(self.case, self.threads)
        self.engine = self.replicas.first.engine
        self.accumulators = self.replicas.first.accumulators
        self.log = RunLog(self.case)
        self.callbacks.given[:0] = self.log.callbacks()  # first: others may write a checkpoint
        self.writer: TrajectoryWriter | None = None
        self.schedule = Schedule(self.case)
        self._looked = False  # whether the state that the run begins with has been sampled
        self._asked_by: signal.Signals | None = None  # a signal that came to this rank
        self._stopped_by: signal.Signals | None = None  # one that all ranks have stopped by
        self._compiling = False

    def _attach(self, directory: RunDirectory) -> None:
        self.directory = directory
        if self.ranks.root:
            self.log.write_to(directory.log_file)
        if self.case.trajectory is not None:
            folder = directory.trajectory_folder
            number, first = written(self.case.trajectory, self.case.groups)
            spheres = method_of(self.case).spheres
            kept = spheres, self.ranks.root
            self.writer = TrajectoryWriter(self.case.trajectory, folder, number, first, *kept)

    @property
    def step(self) -> int:
        """Steps done, the warm-up included."""
        return self.engine.step

    @property
    def time(self) -> float:
        """Time since the start of the warm-up."""
        return self.engine.time

    def __getitem__(self, name: str) -> Result:
        """What an observable says so far."""
        if name not in self.accumulators:
            known = ", ".join(self.accumulators) or "none"
            raise KeyError(f"no observable {name!r}; there are {known}")
        return self.replicas.result(name)

    @property
    def results(self) -> dict[str, Result]:
        """What all observables say so far, by name."""
        return {name: self.replicas.result(name) for name in self.accumulators}

    # --- running --------------------------------------------------------------------------------

    def run(
        self,
        steps: int | None = None,
        *,
        until: str | None = None,
        progress: Reporter | bool | None = None,
    ) -> None:
        """Run to the end of the case, or so many steps on; at the end write results and figures.

        Where `steps` lead beyond the end of the case, the case becomes longer, also on record: the
        bits are those of a case that was as long from the start. With `until`, such as
        "velocity-profile.viscosity=1%", it becomes longer until the standard error of that number
        is so small, by `steps` at most (100 times its length unless said); if that is not enough,
        there is a warning.

        `progress=True` tells how it goes: a bar in a notebook or a terminal, else a line every few
        seconds; False says nothing. Unless said, notebooks alone show a bar. A
        `mesokit.report.progress.Reporter` of one's own may write to another stream.

        A callback that raises `StopRun` ends it early, with a checkpoint where there is a folder.
        Ctrl-C, SIGTERM, SIGHUP or SIGUSR1 raises KeyboardInterrupt after the steps in hand, with a
        checkpoint where there is a folder; `resume`, or `run` again in the same process, goes on.
        """
        self.ranks.require_same(lambda: {"steps": str(steps), "until": str(until)})
        with self.ranks.quietly(), contextlib.ExitStack() as held:
            self.ranks.on_root(lambda: held.enter_context(alone(self.directory)))
            silent = Reporter(quiet=True)
            self._carry_on(steps, until, reporter_for(progress) if self.ranks.root else silent)

    def _carry_on(self, steps: int | None, until: str | None, progress: Reporter) -> None:
        goal = None if until is None else Goal.parse(until, self.case)
        ended = self._looked and self.step == self.last_step
        if goal is not None and (ended or (self._looked and self[goal.observable].comparisons)):
            goal.found(self[goal.observable])
        limit = None if steps is None else self.step + require_steps(steps) - self.case.run.warmup
        last = self.last_step
        if limit is not None and goal is None:
            last = limit + self.case.run.warmup
            if last > self.last_step:
                self.lengthen(limit)
        self.log.tell = progress.tell
        if self.step < last or not self._looked:
            self._tell_start(progress, last)
        self._stopped_by = self._asked_by = None
        self.ranks.begin()
        try:
            with blaming(self.case), catching(self._stop):
                if self.step < last:
                    self._compile(progress)
                if self.step < last or not self._looked:
                    self._loop(progress, last)
                if goal is not None:
                    self._reach(goal, limit_of(self.case, limit), progress)
                if self.step == self.last_step:
                    self._end()
        except Exception as error:
            reason, directory = str(error) or repr(error), self.directory
            self.ranks.failed(lambda who: record.note_failed(directory, f"{who}{reason}"))
            raise
        finally:
            progress.finish()
        if self._stopped_by is not None and self.step < max(last, self.last_step):
            raise self._stopped

    def _reach(self, goal: Goal, limit: int, progress: Reporter) -> None:
        """Go on until the goal is reached, or so many steps after the warm-up are done."""
        every = next(o.every for o in self.case.observe if o.label == goal.observable)
        while self.step == self.last_step and not self._asked():
            excess, done = goal.excess(self[goal.observable]), self.case.run.steps
            said = f"{goal.said(self[goal.observable])} after {done} steps"
            if excess <= 1:
                return progress.tell(said)
            if done >= limit:
                return warnings.warn(f"{said}: more is needed", stacklevel=4)
            self.lengthen(next_length(excess, done, every, limit))
            if progress.phase:
                progress.lengthen(self.last_step)
            else:
                self._tell_start(progress, self.last_step)
            self._compile(progress)
            self._loop(progress, self.last_step)

    def _tell_start(self, progress: Reporter, last: int) -> None:
        particles = sum(group.number for group in self.case.groups)
        progress.start(last, particles, "running", self.step)

    def reached(self, until: str) -> bool:
        """Whether a number is known as well now as `run(until=...)` asks. Raises CaseError."""
        goal = Goal.parse(until, self.case)
        return goal.excess(self[goal.observable]) <= 1

    def lengthen(self, steps: int) -> None:
        """Let the run last so many steps after its warm-up, also on record.

        Raises CaseError if it has done more.
        """
        if steps == self.case.run.steps:
            return
        self.case = longer(self.case, steps, self.step)
        self.schedule = Schedule(self.case)
        if self.directory is not None:
            self.ranks.on_root(self._write_longer)

    def _write_longer(self) -> None:
        assert self.directory is not None
        self._take_back()
        self.directory.write_case(self.case)
        record.note_longer(self.directory, self.case, self.step)

    def _take_back(self) -> None:
        """A run that goes on has no results yet: its frames come back out of the data file."""
        assert self.directory is not None
        if self.writer is not None and self.directory.data_file.exists():
            file = self.directory.data_file
            self.writer.take_back(h5md.frames(file), h5md.own(file))
        self.directory.data_file.unlink(missing_ok=True)

    @property
    def last_step(self) -> int:
        """The step at which the run ends, the warm-up included."""
        return self.schedule.last_step

    @property
    def _stopped(self) -> Stopped:
        """Where the run was stopped, and by what."""
        by, doing = self._stopped_by, ", while compiling," if self._compiling else ""
        assert by is not None
        return Stopped(by, f"stopped at step {self.step}{doing} by {by.name}")

    def _compile(self, progress: Reporter) -> None:
        """Load or compile the kernels; say so if it takes long. A signal ends it at once.

        Rank 0 does so first, and the others find what it has kept.
        """
        self._compiling = True
        try:
            with telling(progress.compiling):
                self.ranks.on_root(lambda: self.engine.advance(0))
                self.engine.advance(0)
        finally:
            self._compiling = False
        with contextlib.suppress(OSError):  # kernels are then not kept either
            note_run(self.case)

    def _loop(self, progress: Reporter, last: int) -> None:
        if self.step == self.case.run.warmup and not self._looked:
            self._go([self.schedule.leg(0, self.step)])
        self.callbacks.stopped = None
        self._call_back()
        pace = Pace(self.case.run)
        coming = self._ahead(pace, self.step, last)
        while self.step < last and not self._stopping:
            order, began, step = coming(), perf_counter(), self.step
            if order.stop:
                self._stopped_by = signal.Signals(order.stop)
                break
            coming = self._ahead(pace, order.target, last)
            self._go(self.schedule.legs(step, order.target))
            pace.went(self.step - step, perf_counter() - began)
            self._call_back()
            if self._checkpoint_due(order):
                self.checkpoint()
                pace.kept()
            progress.update(self.step)
        else:
            coming()
        if self.step < self.last_step and self.directory is not None:
            self.checkpoint()

    def _ahead(self, pace: Pace, step: int, last: int) -> Coming:
        """What is to be done from a step on."""

        def decide(stop: int) -> Order:
            stops = self.schedule.next_meeting(step), *self.callbacks.next_stops(step)
            return Order(min(step + pace.chunk, last, *stops), pace.save(), stop)

        return self.ranks.ahead(decide, self._signal)

    def _call_back(self) -> None:
        """Let callbacks look, if one is due; whether they stop the run is said by rank 0."""
        if self.callbacks.due(self.step):
            self.callbacks.stopped = self.ranks.by_root(lambda: self.callbacks.call(self))

    def _signal(self) -> int:
        """The number of the signal that has come to this rank, or 0."""
        return self._asked_by or 0

    def _asked(self) -> bool:
        """Whether a signal or a callback has asked to end the run, by what rank 0 knows."""
        heard = self.ranks.heard(self._signal())
        by = self.ranks.on_root(lambda: heard)
        self._stopped_by = signal.Signals(by) if by else None
        return self._stopping

    @property
    def _stopping(self) -> bool:
        """Whether a signal or a callback has asked to end the run."""
        return self._stopped_by is not None or self.callbacks.stopped is not None

    def _go(self, legs: Sequence[Leg]) -> None:
        """Do steps and take samples, and the frame that is due then."""
        self.replicas.go(legs)
        if self.writer and self.schedule.frame_due(self.step):
            self.writer.record(self.engine)
        self._looked = self.step >= self.case.run.warmup

    def _end(self) -> None:
        self.replicas.check()
        if self.directory is None:
            return
        self.checkpoint()
        spent = {"timings": self.timings, "shared_work": shared_work(self.ranks, self.engine)}
        what = self.directory, self.case, self.results, spent, self.writer
        self.ranks.on_root(lambda: write_results(*what))

    @property
    def timings(self) -> dict[str, float]:
        """Seconds spent in each stage and observable since this process began the run."""
        observing = {f"observe {name}": s for name, s in self.replicas.first.seconds.items()}
        return self.engine.seconds | observing

    # --- safety ---------------------------------------------------------------------------------

    def checkpoint(self) -> None:
        """Write a checkpoint now. Raises RunError if there is no folder or it cannot be written."""
        if self.directory is None:
            raise RunError("no checkpoint without an output folder")
        self.ranks.by_root(self._keep)

    def _keep(self) -> None:
        """What came before a checkpoint is as safe as the checkpoint."""
        assert self.directory is not None
        if self.writer is not None:
            self.writer.flush()
        self.log.sync()
        meta = {"step": self.step, "looked": self._looked}
        keep(self.directory, self.case, meta, self.replicas.state(), self.ranks.root)

    def _checkpoint_due(self, order: Order) -> bool:
        if self.directory is None or self._stopping:
            return False
        return order.save or self.schedule.checkpoint_due(self.step)

    def _stop(self, by: signal.Signals) -> None:
        """A signal ends the loop after the steps in hand; a second one stops at once."""
        if self._asked_by is not None:
            raise Stopped(by)
        self._asked_by = by
        if self._compiling:
            self._stopped_by = by
            raise self._stopped
