"""One of several ranks of MPI, and its messages other than those of particles.

No rank waits here during steps: orders are sent one leg ahead, and signals by messages to rank 0.
While all ranks wait for rank 0 to write, they sleep.
"""

import contextlib
import hashlib
import sys
import time
import traceback
import warnings
from collections.abc import Callable, Iterator, Mapping
from typing import Any, TypeVar, cast

import numpy as np

from mesokit.errors import MesokitError, RunError
from mesokit.processes import end, parent
from mesokit.processes.alone import Alone, Coming, Order

T = TypeVar("T")
SIGNAL = 1  # tag of a message to rank 0
SOON, LATE = 1e-5, 2e-3  # seconds between two looks, at first and later
LONG = 10.0  # seconds of waiting for callbacks of other ranks before a warning


class Several(Alone):
    """One rank of a communicator of mpi4py. All ranks construct it at the same time."""

    def __init__(self, comm: Any) -> None:
        self.comm = comm.Dup()  # of engines
        self.rank, self.size, self.root = comm.rank, comm.size, comm.rank == 0
        self._own = comm.Dup()
        self._signals = comm.Dup()
        self._last = comm.Dup()
        self._runs = 0  # begun so far
        self._told: list[Any] = []
        self._note: Callable[[str], Any] = _nothing  # for the record, if this rank ends all ranks
        self._warned = self.rank > 1  # of a long wait for callbacks; two ranks are enough
        parent.note_rank(self.rank)
        end.watch(self)

    def on_root(self, function: Callable[[], T]) -> T:
        said = _outcome(function) if self.root else None
        wait(self._own.Ibarrier())
        return _answer(self._own.bcast(said))

    def by_root(self, function: Callable[[], T]) -> T:
        said = _outcome(function) if self.root else function()
        wait(self._own.Ibarrier())
        return _answer(self._own.bcast(said if self.root else None))

    def each(self, function: Callable[[], T]) -> T:
        answer, error = _outcome(function)
        for first in filter(None, self.gathered(error)):
            raise first
        return cast(T, answer)

    def answers(self, function: Callable[[], T]) -> list[T]:
        answer, error = None, None
        try:
            answer = function()
        except (MesokitError, SystemExit) as wrong:
            error = wrong
        wait(self._own.Ibarrier(), self._waits_long)
        said = self._own.allgather((answer, None if error is None else _told(error)))
        failed = [rank for rank, (_, wrong) in enumerate(said) if wrong is not None]
        if not failed:
            return [answer for answer, _ in said]
        if error is not None and len(failed) == self.size:
            raise error
        first, (gist, trace) = failed[0], said[failed[0]][1]
        known = RunError(f"rank {first}: {gist}")
        if first == self.rank:
            raise known from error
        if trace:
            known.add_note(trace)
        raise known

    def _waits_long(self) -> None:
        """Warn: other ranks may wait in a callback for readings that need this rank."""
        if not self._warned:
            self._warned = True
            print(
                f"warning: rank {self.rank} has waited {LONG:g} seconds for callbacks of other "
                "ranks; what one reads of the fluid, those of all ranks must read",
                file=sys.stderr,
            )

    def gathered(self, value: T) -> list[T]:
        wait(self._own.Ibarrier())
        return cast(list[T], self._own.allgather(value))

    def require_same(self, facts: Callable[[], Mapping[str, str]]) -> None:
        own = dict(facts())
        if len(set(self.gathered(hashlib.sha256(repr(own).encode()).digest()))) == 1:
            return
        every = self.gathered(own)
        for rank, theirs in enumerate(every):
            for what, text in every[0].items():
                if theirs.get(what) != text:
                    raise RunError(f"rank {rank}: {what}: {_difference(theirs.get(what), text)}")

    @contextlib.contextmanager
    def quietly(self) -> Iterator[None]:
        if self.root:
            yield
            return
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)
            yield

    def again(self, command: str) -> str:
        if parent.known():
            return f"{command} --ranks {self.size}"
        return f"mpiexec -n {self.size} {command}"

    # --- how far to go --------------------------------------------------------------------------

    def begin(self) -> None:
        self._runs += 1
        self._told, self._note = [], _nothing

    def heard(self, signal: int) -> int:
        if not self.root:
            if signal and not self._told:
                words = np.array([self._runs, signal], np.int64)
                self._told = [words, self._signals.Isend(words, 0, SIGNAL)]
            return signal
        words = np.zeros(2, np.int64)
        while self._signals.Iprobe(tag=SIGNAL):
            self._signals.Recv(words, tag=SIGNAL)
            if words[0] == self._runs and not signal:
                signal = int(words[1])
        return signal

    def ahead(self, decide: Callable[[int], Order], signal: Callable[[], int]) -> Coming:
        by = self.heard(signal())
        words = np.array(decide(by) if self.root else (0, 0, 0), np.int64)
        request = self._own.Ibcast(words)
        self._coming = words  # kept: MPI writes there, whatever becomes of this run

        def come() -> Order:
            wait(request)
            target, save, stop = words.tolist()
            return Order(target, bool(save), stop)

        return come

    # --- the end --------------------------------------------------------------------------------

    def failed(self, note: Callable[[str], Any]) -> None:
        if self.root:
            note("")
        else:
            self._note = note

    def leave(self, say: Callable[[str], Any], status: int) -> None:
        if end.all_come(self._last):
            if self.root:
                say("")
        elif end.first_of_those(self._last):
            self._note(f"rank {self.rank}: ")
            parent.note_end(status)
            sys.stderr = sys.__stderr__ or sys.stderr  # ranks other than 0 are silent otherwise
            say(f"rank {self.rank}: ")
            end.abort(self._last, status)

    def ended(self, status: int) -> None:
        if self.root:
            parent.note_end(status)
        end.leave_orderly(status)


def _nothing(rank_name: str) -> None:
    """Nothing is noted: no run fails."""


def wait(request: Any, long: Callable[[], Any] | None = None) -> None:
    """Wait for a message without using the core; after LONG seconds call `long`."""
    pause, until = SOON, time.monotonic() + LONG
    while not request.Test():
        time.sleep(pause)
        pause = min(2 * pause, LATE)
        if long is not None and time.monotonic() > until:
            long()
            long = None


def _outcome(function: Callable[[], T]) -> tuple[T | None, MesokitError | None]:
    try:
        return function(), None
    except MesokitError as error:
        return None, error


def _told(error: MesokitError | SystemExit) -> tuple[str, str]:
    """An error for other ranks: its message, and its traceback in the user's code."""
    if isinstance(error, SystemExit):
        return f"sys.exit({'' if error.code is None else error.code})", ""
    cause = error.__cause__
    return str(error), "" if cause is None else "".join(traceback.format_exception(cause)).rstrip()


def _answer(said: Any) -> Any:
    answer, error = said
    if error is not None:
        raise error
    return answer


def _difference(theirs: str | None, text: str) -> str:
    """The first line that differs from that of rank 0, in words."""
    mine = (theirs or "").splitlines()
    for k, line in enumerate(text.splitlines()):
        other = mine[k] if k < len(mine) else "nothing"
        if other != line:
            return f"{other} where rank 0 has {line}"
    return f"{mine[len(text.splitlines())]} where rank 0 has nothing"
