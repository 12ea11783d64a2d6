"""A simulation: build it, run it, resume it, look at what it measured."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mesokit.case.case import Case
from mesokit.case.outside import blaming
from mesokit.errors import RunError
from mesokit.io.measured import take_up
from mesokit.io.one_writer import alone
from mesokit.io.run_directory import RunDirectory, provenance
from mesokit.processes.world import world
from mesokit.report.document.progress import reporter_for
from mesokit.report.progress import Reporter
from mesokit.run import record
from mesokit.run.callbacks import Callback, Callbacks
from mesokit.run.course.course import Course
from mesokit.run.course.kept import existing
from mesokit.run.given import case_and_arrays, threads_of, told
from mesokit.run.log import RunLog
from mesokit.run.longer import longer
from mesokit.run.on_ranks import require_ranks
from mesokit.run.replicas import Replicas
from mesokit.run.schedule import Schedule
from mesokit.run.until import Goal
from mesokit.seam.method import method_of

if TYPE_CHECKING:
    from mesokit.seam.result import Result


class Simulation(Course):
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
        facts = {"output": str(output)}
        self.ranks.require_same(lambda: told(self.case, self.callbacks, arrays) | facts)
        with blaming(self.case):
            self.case = method_of(self.case).initial.prepared(self.case, arrays)
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
        here.require_same(lambda: {"output": str(output)})
        with here.quietly(), contextlib.ExitStack() as held:
            directory = here.on_root(lambda: existing(output, held))
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

    def _build(self) -> None:
        require_ranks(self.case, self.ranks.size)
        self.replicas = Replicas(self.case, self.threads)
        self.engine = self.replicas.first.engine
        self.accumulators = self.replicas.first.accumulators
        self.log = RunLog(self.case)
        self.callbacks.given[:0] = self.log.callbacks()  # first: others may write a checkpoint
        self.writer = None
        self.schedule = Schedule(self.case)
        self._looked = self._compiling = False
        self._asked_by = self._stopped_by = None

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

    @property
    def last_step(self) -> int:
        """The step at which the run ends, the warm-up included."""
        return self.schedule.last_step

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
