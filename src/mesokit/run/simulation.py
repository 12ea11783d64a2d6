"""A simulation: a case in memory that can be run and resumed, and its results."""

from __future__ import annotations

import contextlib
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from mesokit.case import toml
from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.case.describe.shown import Shown
from mesokit.case.outside import blaming
from mesokit.devices.names import CPU
from mesokit.errors import RunError
from mesokit.io.one_writer import alone
from mesokit.io.record_words import shared_work
from mesokit.io.run_directory import RunDirectory
from mesokit.processes.world import world
from mesokit.report.document.progress import reporter_for
from mesokit.report.flow import Film
from mesokit.report.progress import Reporter
from mesokit.run import pictures
from mesokit.run.callbacks import Callback, Callbacks
from mesokit.run.folder import Folder, existing, note_failed
from mesokit.run.given import case_and_arrays, device_of, given_facts, require_ranks, threads_of
from mesokit.run.log import RunLog
from mesokit.run.loop import Loop
from mesokit.run.replicas import Replicas
from mesokit.run.schedule import Schedule
from mesokit.run.stop import Stop
from mesokit.run.until import Goal, limit_of, longer, next_length, require_steps
from mesokit.seam.method import method_of
from mesokit.seam.result import Result


class Simulation(Shown):
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
    device : str, optional
        "cpu", or "cuda" for a card of NVIDIA ("cuda:1" for the second one), with the same bits; see
        the guide on GPUs. "emulated" and "host" show these bits without a card, slowly.
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
        device: str = CPU,
        callbacks: Sequence[Callback] = (),
        **parts: Any,
    ) -> None:
        self.ranks = world()
        self.callbacks = Callbacks(callbacks)
        self.case, arrays = case_and_arrays(case, parts)
        self.threads = threads_of(threads, self.ranks, self.case)
        facts = {"output": str(output)}
        self.ranks.require_same(lambda: given_facts(self.case, self.callbacks, arrays) | facts)
        with blaming(self.case):
            self.case = method_of(self.case).initial.prepared(self.case, arrays)
            self._build(device)
            self.replicas.start(arrays)
        if output is not None:
            self.write_to(output)
            if arrays:
                self.checkpoint()

    def _build(self, device: str) -> None:
        """Make replicas, callbacks, stop and loop."""
        require_ranks(self.case, self.ranks.size)
        self.device = device_of(device, self.case, self.ranks.size)
        self.replicas = Replicas(self.case, self.threads, self.device)
        self.engine = self.replicas.first.engine
        self.accumulators = self.replicas.first.accumulators
        self.log = RunLog(self.case)
        self.callbacks.given[:0] = self.log.callbacks()  # first: others may write a checkpoint
        self._stop = Stop(self.ranks, self.callbacks)
        kept = self.replicas, self.callbacks, self._stop
        self._loop = Loop(self.ranks, Schedule(self.case), *kept, lambda: self.callbacks.call(self))
        self._folder: Folder | None = None

    def write_to(self, output: str | Path) -> None:
        """Write to this new folder from now on. Raises RunError if it holds something already."""
        directory = self.ranks.on_root(lambda: RunDirectory.create(output, self.case))
        self.case = Case.from_toml(directory.case_file)  # what `resume` will read
        self._write_in(directory).begin(self.threads, self.device_name)

    def _write_in(self, directory: RunDirectory) -> Folder:
        """Let the loop write to a folder from now on."""
        self._folder = self._loop.folder = Folder(directory, self.case, self.ranks, self.log)
        return self._folder

    @classmethod
    def resume(
        cls,
        output: str | Path,
        threads: int | None = None,
        steps: int | None = None,
        callbacks: Sequence[Callback] = (),
        device: str = CPU,
    ) -> Simulation:
        """Go on with the run in a folder, from its last checkpoint (or the start, if none).

        With `steps` it lasts so many after its warm-up, also if it had ended, to the bits of a run
        that was as long from the start; the case on record is changed. Callbacks are not kept with
        a run: name them again. The device may be another one than before. A damaged record is a
        warning, and begun anew.

        Raises CaseError if it has done more steps than that.
        Raises RunError, CheckpointError if there is none, it is damaged, or another process is
        writing there.
        """
        here = world()
        here.require_same(lambda: {"output": str(output)})
        with here.quietly(), contextlib.ExitStack() as held:
            directory = here.on_root(lambda: existing(output, held))
            self = cls.__new__(cls)
            self.ranks, self.case = here, Case.from_toml(directory.case_file)
            self.threads = threads_of(threads, here, self.case)
            self.callbacks = Callbacks(callbacks)
            given = {"steps": str(steps)}
            here.require_same(lambda: given_facts(self.case, self.callbacks, {}) | given)
            self._build(device)
            folder = self._write_in(directory)
            folder.take_up(self.replicas)
            if steps is not None:
                self.lengthen(steps)
            self.callbacks.resume(self.step)
            folder.go_on(self.replicas, self.threads, self.device_name)
            return self

    @property
    def device_name(self) -> str:
        """What the steps run on: the name of a card, or "cpu"."""
        return CPU if self.device is None else self.device.name

    @property
    def directory(self) -> RunDirectory | None:
        """The folder that is written to, None if there is none."""
        return None if self._folder is None else self._folder.directory

    @property
    def step(self) -> int:
        """Steps done, the warm-up included."""
        return self.engine.step

    @property
    def time(self) -> float:
        """Time since the start of the warm-up."""
        return self.engine.time

    def __getitem__(self, name: str) -> Result:
        """The result of an observable so far."""
        if name not in self.accumulators:
            known = ", ".join(self.accumulators) or "none"
            raise KeyError(f"no observable {name!r}; there are {known}")
        return self.replicas.result(name)

    @property
    def results(self) -> dict[str, Result]:
        """The results of all observables so far, by name."""
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

        If `steps` lead beyond the end of the case, the case becomes longer, also on record: the
        bits are those of a case that was as long from the start. With `until`, such as
        "velocity-profile.viscosity=1%", it becomes longer until the standard error of that number
        is so small, by `steps` at most (100 times its length unless said); if that is not enough,
        there is a warning.

        `progress=True` shows a bar in a notebook or a terminal, else a line every few seconds;
        False shows nothing, and the default a bar in notebooks alone. Another
        `mesokit.report.progress.Reporter` may write to another stream.

        A callback that raises `StopRun` ends it early, with a checkpoint where there is a folder.
        Ctrl-C, SIGTERM, SIGHUP or SIGUSR1 raises KeyboardInterrupt after the steps in hand, with a
        checkpoint where there is a folder; `resume`, or `run` again in the same process, goes on.
        """
        self.ranks.require_same(lambda: {"steps": str(steps), "until": str(until)})
        with self.ranks.quietly(), contextlib.ExitStack() as held:
            self.ranks.on_root(lambda: held.enter_context(alone(self.directory)))
            silent = Reporter(quiet=True)
            self._run(steps, until, reporter_for(progress) if self.ranks.root else silent)

    def _run(self, steps: int | None, until: str | None, progress: Reporter) -> None:
        """Run to results, to an error on record, or to a checkpoint and a KeyboardInterrupt."""
        looked, warmup = self.replicas.looked, self.case.run.warmup
        goal = None if until is None else Goal.parse(until, self.case)
        if goal is not None and looked:
            result = self[goal.observable]
            if self.step == self.last_step or result.comparisons:
                goal.found(result)  # raises an error if there is no such number
        # `steps` are counted from here, those of a case from the end of its warm-up. The run may
        # end before the case does; with a goal they are a limit.
        limit = None if steps is None else self.step + require_steps(steps) - warmup
        last = self.last_step
        if limit is not None and goal is None:
            last = limit + warmup
            if last > self.last_step:
                self.lengthen(limit)
        self.log.tell = progress.tell
        if self.step < last or not looked:
            self._loop.tell(last, progress)
        try:
            with blaming(self.case), self._stop.listening():
                if self.step < last:
                    self._loop.compile(progress)
                if self.step < last or not looked:
                    self._loop.run(last, progress)
                if goal is not None:
                    self._reach(goal, limit_of(self.case, limit), progress)
                if self.step == self.last_step:
                    self._end()
        except Exception as error:
            reason, directory = str(error) or repr(error), self.directory
            if directory is not None:
                self.ranks.failed(lambda rank_name: note_failed(directory, f"{rank_name}{reason}"))
            raise
        finally:
            progress.finish()
        # A signal that came after the last step has stopped nothing.
        if self._stop.by is not None and self.step < max(last, self.last_step):
            raise self._stop.error(self.step)

    def _reach(self, goal: Goal, limit: int, progress: Reporter) -> None:
        """Go on until the goal is reached, or so many steps after the warm-up are done."""
        every = next(o.every for o in self.case.observe if o.label == goal.observable)
        while self.step == self.last_step:
            self._stop.agree()
            if self._stop.due:
                return
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
                self._loop.tell(self.last_step, progress)
            self._loop.compile(progress)
            self._loop.run(self.last_step, progress)

    def _end(self) -> None:
        """Check that numbers are finite, and write results if there is a folder."""
        self.replicas.check()
        if self._folder is not None:
            self.checkpoint()
            work = shared_work(self.ranks, self.engine)
            spent = {"timings": self.timings, "shared_work": work}
            self._folder.end(self.results, spent | {"absorbed": self.replicas.absorbed})

    def reached(self, until: str) -> bool:
        """True if a number is known as well as `run(until=...)` needs. Raises CaseError."""
        goal = Goal.parse(until, self.case)
        return goal.excess(self[goal.observable]) <= 1

    def lengthen(self, steps: int) -> None:
        """Let the run last so many steps after its warm-up, also on record.

        Raises CaseError if it has done more.
        """
        if steps == self.case.run.steps:
            return
        self.case = longer(self.case, steps, self.step)
        self._loop.schedule = Schedule(self.case)
        if self._folder is not None:
            self._folder.lengthen(self.case, self.step)

    @property
    def last_step(self) -> int:
        """The step at which the run ends, the warm-up included."""
        return self._loop.schedule.last_step

    @property
    def timings(self) -> dict[str, float]:
        """Seconds spent in each stage and observable since this process began the run."""
        observing = {f"observe {name}": s for name, s in self.replicas.first.seconds.items()}
        return self.engine.seconds | observing

    # --- safety ---------------------------------------------------------------------------------

    def checkpoint(self) -> None:
        """Write a checkpoint now. Raises RunError if there is no folder or it cannot be written."""
        if self._folder is None:
            raise RunError("no checkpoint without an output folder")
        self._folder.checkpoint(self.replicas)

    # --- to look at -----------------------------------------------------------------------------

    def __repr__(self) -> str:
        where = f", {self.directory.path}" if self.directory is not None else ""
        title = f" {show(self.case.title)}" if self.case.title else ""
        return f"<Simulation{title}: step {self.step} of {self.last_step}{where}>"

    def _card(self) -> dict[str, Any]:
        rows = [(key, text, "") for key, text in toml.given(self.case, method_of(self.case).keys)]
        return {
            "title": self.case.title or "simulation",
            "words": f"step {self.step} of {self.last_step}",
            "rows": rows,
            "results": self.results.values() if self.step > self.case.run.warmup else (),
        }

    def flow(self, kind: str | None = None, **choices: Any) -> Any:
        """A picture of the flow so far, with the choices of `mesokit.report.flow.picture`.

        `simulation.flow("particles")` works before the first step, too: it shows the solids, the
        molecules and the particles.
        """
        from mesokit.report.flow import State

        now = State(self.case, self.engine)
        return pictures.flow(self.case, self.results, now, self._name, kind, choices)

    @property
    def _name(self) -> str:
        """Its name in pictures: the folder, if there is one."""
        return "" if self.directory is None else self.directory.path.resolve().name

    def animate(self, path: str | Path, kind: str | None = None, **choices: Any) -> Film:
        """Write a film of the flow so far (MP4 or GIF by its ending)."""
        return pictures.film(self.case, self.results, None, self._name, kind, choices, path)
