"""Carries out the runs of a study, and reports progress."""

import signal
import time
from collections.abc import Sequence
from concurrent.futures import Future
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

from mesokit.case.amounts import duration_text
from mesokit.case.kind import has_run, kind_of
from mesokit.errors import CaseError
from mesokit.processes.signals import Stopped, catching
from mesokit.report.document.progress import NotebookReporter, in_notebook
from mesokit.report.progress import Reporter
from mesokit.study.plan import Planned

POLL_SECONDS = 0.2
LOOK_SECONDS = 1.0  # between two looks into the folders of the runs in hand


class Workers(Protocol):
    """Processes, this process, or a cluster, which carry out runs."""

    @property
    def places(self) -> int:
        """The number of runs at once."""

    def submit(self, path: Path) -> Future[str]:
        """Carry the run in a folder to its end; the result is "", or why it did not end."""

    def stop(self) -> None:
        """Let the present runs end at a checkpoint."""

    def close(self) -> None:
        """Wait for the present runs, and end."""


class StudyReporter(Reporter):
    """Progress of a study, in steps times particles of all runs."""

    def __init__(self, quiet: bool = False, **options: Any) -> None:
        super().__init__(quiet, **options)
        self.runs = self.ended = 0

    def update(self, step: int) -> None:
        """Report progress; while there is none, runs compile and there is no rate."""
        self.fresh = self.fresh or step == self.first
        super().update(step)

    def amount(self, steps: int) -> str:
        return f"{self.runs - self.ended} of {self.runs} runs to do"

    def count(self) -> str:
        return f"{self.ended} of {self.runs} runs"

    def words(self, step: int) -> str:
        rate, ended = self.rate(), f"{self.count()} have ended"
        if step >= self.total:
            return f"{ended}, the last results and figures are being written"
        if not rate:
            return ended
        left = duration_text((self.total - step) / rate)
        return f"{ended}, {rate / 1e6:.3g} M {self.what}-steps/s, {left} left"


class NotebookStudyReporter(NotebookReporter, StudyReporter):
    """Tells it by a bar below the cell of a notebook."""


def reporter_for(progress: StudyReporter | bool | None) -> StudyReporter:
    """The reporter of a study, as `mesokit.report.document.progress.reporter_for` of a run.

    Raises CaseError for a reporter without runs.
    """
    if isinstance(progress, StudyReporter):
        return progress
    if not isinstance(progress, bool | None):
        raise CaseError(
            f"progress = {type(progress).__name__}: expected True, False or a StudyReporter "
            "(mesokit.study.drive)"
        )
    if progress is not False and in_notebook():
        return NotebookStudyReporter()
    return StudyReporter(quiet=not progress)


@dataclass
class _Work:
    """A run and its work: steps times particles."""

    run: Planned
    particles: int
    steps: int
    kind: str
    compiled: bool
    future: Future[str] | None = None
    seen: int = field(default=0)  # steps done

    @property
    def total(self) -> int:
        return self.particles * self.steps


def drive(
    runs: Sequence[Planned], workers: Workers, progress: StudyReporter
) -> list[tuple[Planned, str]]:
    """Carry the runs that have not ended to their ends; returns those that fail, with reasons.

    Raises Stopped after a signal, once the present runs have ended at their checkpoints.
    """
    works = []
    for run, case in ((run, run.files.case) for run in runs):
        particles = sum(group.number for group in case.groups)
        steps = case.run.warmup + case.run.steps
        works.append(_Work(run, particles, steps, kind_of(case), has_run(case)))
    waiting = [work for work in works if not work.run.ended]
    progress.runs, progress.ended = len(works), len(works) - len(waiting)
    if not waiting:
        workers.close()
        return []
    done = sum(work.total for work in works if work.run.ended)
    for work in waiting:
        work.seen = work.run.step
    stopped: list[signal.Signals] = []
    failed: list[tuple[Planned, str]] = []
    total, noun = sum(work.total for work in works), waiting[0].run.files.case.noun
    progress.start(total, 1, "study", done + _seen(waiting), noun)
    in_hand: list[_Work] = []
    looked = 0.0
    try:
        with catching(lambda by: _stop(stopped, by, workers)):
            # Polled: the steps of runs are read from their folders. After a signal no more runs
            # start; those in hand write their checkpoints first. Of a kind that is not compiled,
            # one run starts alone, and the others use its kernels.
            while in_hand or (waiting and not stopped):
                if not stopped:
                    _hand_out(waiting, in_hand, workers)
                for work in [w for w in in_hand if w.future is not None and w.future.done()]:
                    in_hand.remove(work)
                    why = _answer(work, stopped)
                    done += work.total if work.run.ended else _seen([work])
                    for other in waiting:  # they find its kernels, or cannot be helped
                        other.compiled = other.compiled or other.kind == work.kind
                    if why:
                        failed.append((work.run, why))
                    progress.ended += work.run.ended
                if (now := time.monotonic()) >= looked + LOOK_SECONDS:
                    looked = now
                    for work in in_hand:
                        work.seen = work.run.step
                progress.update(done + _seen(in_hand) + _seen(waiting))
                if in_hand:
                    time.sleep(POLL_SECONDS)
    finally:
        workers.close()
        progress.finish()
    if stopped:
        by = stopped[0]
        raise Stopped(by, f"stopped by {by.name}: {progress.ended} of {len(works)} runs have ended")
    return failed


def _seen(works: Sequence[_Work]) -> int:
    """Work that is known to be done of runs that have not ended."""
    return sum(work.particles * work.seen for work in works)


def _hand_out(waiting: list[_Work], in_hand: list[_Work], workers: Workers) -> None:
    """Submit runs while there are places; of a kind that is not compiled yet only one at first."""
    for work in list(waiting):
        if len(in_hand) >= workers.places:
            return
        first = [w for w in in_hand if w.kind == work.kind and not w.compiled]
        if first and not has_run(first[0].run.files.case):
            continue
        waiting.remove(work)
        in_hand.append(work)
        work.future = workers.submit(work.run.path)


def _answer(work: _Work, stopped: list[signal.Signals]) -> str:
    """Why a run has not ended, "" if it has or was stopped with the others."""
    assert work.future is not None
    try:
        why = str(work.future.result())
    except Exception as error:  # of its worker: a lost node, a missing package
        why = f"{type(error).__name__}: {error}"
    if why.startswith("stopped") and not stopped:
        stopped.append(signal.SIGINT)
    return "" if stopped and not work.run.failed else why


def _stop(stopped: list[signal.Signals], by: signal.Signals, workers: Workers) -> None:
    if stopped:
        raise Stopped(by)
    stopped.append(by)
    workers.stop()
