"""End of all ranks after an error in one: one rank prints the reason, and none is left running."""

import atexit
import contextlib
import os
import sys
import threading
import time
from collections.abc import Callable
from typing import Any

PATIENCE = 4.0  # seconds in which other ranks may come to the same end
LISTEN = 0.3  # seconds for messages of other ranks that fail
KILLED = 10.0  # seconds in which the rank that prints the reason ends this one
FAILED = 2  # tag of the message that a rank fails


def all_come(comm: Any) -> bool:
    """True if all ranks come here within a short time."""
    return _within(PATIENCE, comm.Ibarrier().Test)


def first_of_those(comm: Any) -> bool:
    """True on the lowest of the ranks that have come here; others wait to be ended by it."""
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


def abort(comm: Any, status: int) -> None:
    """End all ranks, without the message of the library."""
    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    comm.Abort(status)


def watch(here: Any) -> None:
    """Let an exception that is not caught end all ranks, as `here.leave` does."""
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
    """End this process at once: freeing its memory would take seconds."""
    from mpi4py import MPI

    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    # MPI waits for all ranks, one of which may have been killed
    late = threading.Timer(KILLED, os._exit, (status,))
    late.daemon = True
    late.start()
    MPI.Finalize()
    os._exit(status)


def leave_at_once(status: int) -> None:
    """End this process after a signal, which may have come anywhere.

    Nothing is freed that another thread, or a compiler that was interrupted, may still use.
    """
    atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError):  # a full disk, or a reader that has gone
            stream.flush()
    os._exit(status)
