"""One of several ranks of MPI: their messages, apart from those of particles.

No rank waits here during steps: orders are sent one leg ahead, and signals by messages that rank 0
receives. While all wait for rank 0 to write, they sleep.
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
from mesokit.processes.order import Coming, Order

T = TypeVar("T")
SIGNAL = 1  # tag of a message to rank 0
SOON, LATE = 1e-5, 2e-3  # seconds between two looks, at first and later
LONG = 10.0  # seconds after which those that wait for callbacks of others say so


class Several:
    """This rank among those of a communicator of mpi4py. All make it at the same time."""

    def __init__(self, comm: Any) -> None:
        self.comm = comm.Dup()  # of engines
        self.rank, self.size, self.root = comm.rank, comm.size, comm.rank == 0
        self._own = comm.Dup()
        self._signals = comm.Dup()
        self._last = comm.Dup()
        self._runs = 0  # begun so far
        self._told: list[Any] = []
        self._note: Callable[[str], Any] = _nothing  # what is noted if this rank ends all
        self._said_so = self.rank > 1  # that it waits for callbacks of others; two are enough
        parent.note_rank(self.rank)
        end.watch(self)

    def on_root(self, function: Callable[[], T]) -> T:
        """What a function says that rank 0 alone calls. Raises its MesokitError on all ranks."""
        said = _outcome(function) if self.root else None
        wait(self._own.Ibarrier())
        return _answer(self._own.bcast(said))

    def by_root(self, function: Callable[[], T]) -> T:
        """What a function says that all ranks call: the answer of rank 0, or its MesokitError."""
        said = _outcome(function) if self.root else function()
        wait(self._own.Ibarrier())
        return _answer(self._own.bcast(said if self.root else None))

    def each(self, function: Callable[[], T]) -> T:
        """What a function says that all ranks call, each for its part.

        Raises the MesokitError of one of them, the first that has any, on all ranks.
        """
        answer, error = _outcome(function)
        for wrong in self.gathered(error):
            if wrong is not None:
                raise wrong
        return cast(T, answer)

    def answers(self, function: Callable[[], T]) -> list[T]:
        """What a function of the user says that all ranks call: the answers of all.

        Where it fails, or ends the program, on some ranks, RunError on all names the first of them;
        its own error where it does on all.
        """
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
        """What keeps the others may be that they ask this rank something meanwhile."""
        if not self._said_so:
            self._said_so = True
            print(
                f"warning: rank {self.rank} has waited {LONG:g} seconds for callbacks of other "
                "ranks; what one asks of the fluid, those of all ranks must ask",
                file=sys.stderr,
            )

    def gathered(self, value: T) -> list[T]:
        """What each rank has, on all ranks."""
        wait(self._own.Ibarrier())
        found: list[T] = self._own.allgather(value)
        return found

    def require_same(self, facts: Callable[[], Mapping[str, str]]) -> None:
        """Raise RunError, which names a rank and what differs, if these are not the same on all."""
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
        """Warnings meanwhile are those of rank 0."""
        if self.root:
            yield
            return
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)
            yield

    def again(self, command: str) -> str:
        """The command for as many ranks as there are now."""
        if parent.known():
            return f"{command} --ranks {self.size}"
        return f"mpiexec -n {self.size} {command}"

    # --- how far to go --------------------------------------------------------------------------

    def begin(self) -> None:
        """A run begins: signals told before do not matter any more."""
        self._runs += 1
        self._told, self._note = [], _nothing

    def heard(self, signal: int) -> int:
        """The number of the signal that has come to this rank, or on rank 0 to any; 0 if none."""
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
        """What to do after the steps in hand: decided by rank 0, before them.

        `decide` is given the number of a signal that has come to any rank, `signal` says which has
        come to this one. What is returned must be called, even if it is not needed any more.
        """
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
        """A run fails here: rank 0 notes it, or the first of those that fail if rank 0 does not.

        `note` is given what comes before the reason: the name of the rank, where not all fail.
        """
        if self.root:
            note("")
        else:
            self._note = note

    def leave(self, say: Callable[[str], Any], status: int) -> None:
        """Say why this rank ends with a status, once for all ranks that end so.

        If not all do within a short time, the first of those that do ends all the others.
        """
        if end.all_come(self._last):
            if self.root:
                say("")
        elif end.first_of_those(self._last):
            self._note(f"rank {self.rank}: ")
            parent.note_end(status)
            end.speak(lambda: say(f"rank {self.rank}: "))
            end.abort(self._last, status)

    def ended(self, status: int) -> None:
        """This process ends in order, now: to take its memory apart would take seconds."""
        if self.root:
            parent.note_end(status)
        end.leave_orderly(status)


def _nothing(rank_name: str) -> None:
    """No run fails."""


def wait(request: Any, long: Callable[[], Any] | None = None) -> None:
    """Until a message has come, without taking the core from others; `long` is called if it takes
    that."""
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
    """An error for other ranks: its gist, and where in the user's code it comes from."""
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
    """The first line that differs, in words."""
    mine = (theirs or "").splitlines()
    for k, line in enumerate(text.splitlines()):
        other = mine[k] if k < len(mine) else "nothing"
        if other != line:
            return f"{other} where rank 0 has {line}"
    return f"{mine[len(text.splitlines())]} where rank 0 has nothing"
