"""Compiling a kernel ahead of its first call, on another core, while this process goes on.

A child of this process compiles it and keeps it in the store, where the first call finds it. This
needs a system that copies processes, a core that is free, a store that can be written, and that no
other thread of the user is at work; elsewhere, and among ranks, the first call compiles the kernel.
"""

import atexit
import contextlib
import os
import pickle
import select
import signal
import sys
import threading
import warnings
from collections.abc import Callable
from typing import Any

from numba.core.compiler_lock import global_compiler_lock

from mesokit.kernels.kept import counts, kept

PATIENCE = 300  # seconds: a child that hangs ends, and holds no run up for ever

_in_progress: dict[Any, tuple[int, int]] = {}  # of each kernel: the child, and where it reports


def begin(kernel: Any, compile: Callable[[], Any]) -> None:
    """Compile a kernel in a child of this process, if that can be done."""
    own = kept().own
    if own is None or not own.writes or kernel in _in_progress or not _can_copy():
        return
    with global_compiler_lock, warnings.catch_warnings():
        # Python warns of threads: the child has none, and the locks that it needs are held here
        warnings.simplefilter("ignore", DeprecationWarning)
        report, reported = os.pipe()
        child = os.fork()
        if child == 0:
            _compile(compile, reported)
    os.close(reported)
    _in_progress[kernel] = child, report
    counts.compiles_ahead += 1


def _can_copy() -> bool:
    """Whether a child would have a core of its own, and find no lock of another thread."""
    main = threading.main_thread()
    alone = all(one.daemon for one in threading.enumerate() if one is not main)
    return threading.current_thread() is main and alone and _has_a_core()


def _has_a_core() -> bool:
    if sys.platform != "linux" or "mpi4py.MPI" in sys.modules:
        return False
    return hasattr(os, "sched_getaffinity") and len(os.sched_getaffinity(0)) > 1


def _compile(compile: Callable[[], Any], reported: int) -> None:
    try:
        for number in signal.SIGINT, signal.SIGTERM, signal.SIGALRM:
            signal.signal(number, signal.SIG_DFL)
        signal.alarm(PATIENCE)
        nothing = os.open(os.devnull, os.O_RDWR)
        for stream in range(3):  # a reader of its output does not wait for the child
            os.dup2(nothing, stream)
        counts.__init__(counts.explains)  # type: ignore[misc]
        compile()
        with os.fdopen(reported, "wb") as pipe:
            pickle.dump(counts, pipe)
    finally:
        os._exit(0)  # nothing that the parent has open is flushed or closed


def end(kernel: Any) -> None:
    """Wait for the child that compiles a kernel, if there is one, and count what it made."""
    if kernel not in _in_progress:
        return
    child, report = _in_progress.pop(kernel)
    counted = b""
    try:
        with os.fdopen(report, "rb") as pipe:
            if select.select([pipe], [], [], PATIENCE)[0]:
                counted = pipe.read()
    finally:
        _stop(child)
    if counted:
        counts.add_made(pickle.loads(counted))


def _stop(child: int) -> None:
    counts.compiles_ahead -= 1
    with contextlib.suppress(OSError):  # the user ignores SIGCHLD, or has waited for it
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)


def _forget() -> None:
    """In a copy of this process: the children are those of the other."""
    while _in_progress:
        os.close(_in_progress.popitem()[1][1])
    counts.compiles_ahead = 0


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forget)


@atexit.register
def _stop_all() -> None:
    while _in_progress:
        child, report = _in_progress.popitem()[1]
        os.close(report)
        _stop(child)
