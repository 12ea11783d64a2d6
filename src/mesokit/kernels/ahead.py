"""Compiling a kernel ahead of its first call, on another core, while this process goes on.

A child of this process compiles it and keeps it in the store, where the first call finds it. This
needs a system that copies processes, a core that is free, and a store that can be written; where
any of these is missing, and among ranks, the first call compiles the kernel as ever.
"""

from __future__ import annotations

import os
import pickle
import select
import signal
import sys
import warnings
from collections.abc import Callable
from typing import Any

from mesokit.kernels.kept import counts, kept

PATIENCE = 300.0  # seconds: a child that hangs holds no run up for ever

_under_way: dict[Any, tuple[int, int]] = {}  # of each kernel: the child, and where it reports


def begin(kernel: Any, compile: Callable[[], Any]) -> None:
    """Compile a kernel in a child of this process, if that can be done."""
    own = kept().own
    if own is None or not own.writes or kernel in _under_way or not _has_a_core():
        return
    with warnings.catch_warnings():
        # Python warns of threads, which the child has not; those of this process hold no lock
        warnings.simplefilter("ignore", DeprecationWarning)
        report, reported = os.pipe()
        child = os.fork()
    if child == 0:
        _compile(compile, reported)
    os.close(reported)
    _under_way[kernel] = child, report
    counts.compiles_ahead += 1


def _has_a_core() -> bool:
    """Whether another process of this user would have a core of its own."""
    if sys.platform != "linux" or "mpi4py.MPI" in sys.modules:
        return False
    return len(os.sched_getaffinity(0)) > 1


def _compile(compile: Callable[[], Any], reported: int) -> None:
    """The whole life of the child."""
    try:
        for number in signal.SIGINT, signal.SIGTERM:
            signal.signal(number, signal.SIG_DFL)
        counts.__init__(counts.explains)  # type: ignore[misc]
        compile()
        with os.fdopen(reported, "wb") as pipe:
            pickle.dump(counts, pipe)
    finally:
        os._exit(0)  # nothing of what the parent has open is flushed, or told that it ends


def end(kernel: Any) -> None:
    """Wait for the child that compiles a kernel, if there is one, and count what it made."""
    if kernel in _under_way:
        child, report = _under_way.pop(kernel)
        with os.fdopen(report, "rb") as pipe:
            if not select.select([pipe], [], [], PATIENCE)[0]:
                os.kill(child, signal.SIGKILL)
            told = pipe.read()
        os.waitpid(child, 0)
        counts.compiles_ahead -= 1
        if told:
            counts.add_made(pickle.loads(told))
