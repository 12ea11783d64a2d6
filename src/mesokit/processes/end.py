"""End of all ranks after an error in one: one rank prints the reason, and none is left running."""

import os
import sys
import threading
import time
from collections.abc import Callable
from typing import Any

PATIENCE = 4.0  # seconds in which others may come to the same end
LISTEN = 0.3  # seconds in which those that fail too can say so
KILLED = 10.0  # seconds in which the one that speaks ends this rank
FAILED = 2  # tag of the message that a rank fails


def all_come(comm: Any) -> bool:
    """Whether all ranks have come here within a short time."""
    return _within(PATIENCE, comm.Ibarrier().Test)


def first_of_those(comm: Any) -> bool:
    """Whether this is the lowest rank of those that have come here; others wait for its word."""
    sent = [comm.isend(comm.rank, other, FAILED) for other in range(comm.rank + 1, comm.size)]
    if _within(LISTEN, lambda: comm.Iprobe(tag=FAILED)):
        time.sleep(KILLED)
    del sent
    return True


def _within(seconds: float, come: Callable[[], bool]) -> bool:
    until = time.monotonic() + seconds
    while not come():
        if time.monotonic() > until:
            return False
        time.sleep(0.005)
    return True


def speak(say: Callable[[], Any]) -> None:
    """Say something even where this rank is to be silent."""
    sys.stderr = sys.__stderr__ or sys.stderr
    say()


def abort(comm: Any, status: int) -> None:
    """End all ranks. The library would say so as well: it is not heard."""
    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    comm.Abort(status)


def watch(here: Any) -> None:
    """An exception that is not caught ends all ranks, as `here.leave` does."""
    earlier = sys.excepthook

    def hook(kind: type[BaseException], value: BaseException, trace: Any) -> None:
        def say(rank_name: str) -> None:
            print(rank_name and f"mesokit: {rank_name}", end="", file=sys.stderr)
            earlier(kind, value, trace)

        status = getattr(value, "status", 130) if issubclass(kind, KeyboardInterrupt) else 1
        here.leave(say, status)
        here.ended(status)  # after Ctrl-C Python would send itself the signal again

    sys.excepthook = hook


def leave_orderly(status: int) -> None:
    """End this process without a word more."""
    from mpi4py import MPI

    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    # the library waits for the others, of whom one may have gone without a word
    late = threading.Timer(KILLED, os._exit, (status,))
    late.daemon = True
    late.start()
    MPI.Finalize()
    os._exit(status)
