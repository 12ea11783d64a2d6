"""Threads that run one kernel together, and the gate at which they wait for one another."""

from __future__ import annotations

import threading
from collections.abc import Callable
from queue import SimpleQueue
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from mesokit.scalar import scalar

SPINS = 1_000  # some ten microseconds; a thread that waits longer lets others have the core

# The gate: how many threads have come, and how often it has opened; each on its own cache line.
ARRIVED, OPENED, GATE_SIZE = 0, 8, 16

_yield_core = types.ExternalFunction("sched_yield", types.int32())


@intrinsic
def _add_atomic(typing_context: Any, pointer: Any, value: Any) -> Any:
    """Add to an int64 in memory; gives what it was."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        place = builder.inttoptr(arguments[0], ir.IntType(64).as_pointer())
        return builder.atomic_rmw("add", place, arguments[1], "seq_cst")

    return types.int64(types.uintp, types.int64), generate


@scalar
def wait(gate, threads):
    """Go on when all threads have come here: what each wrote before, all can read after."""
    if threads > 1:
        arrived = np.uint64(gate.ctypes.data + 8 * ARRIVED)
        opened = np.uint64(gate.ctypes.data + 8 * OPENED)
        now = _add_atomic(opened, np.int64(0))
        if _add_atomic(arrived, np.int64(1)) == threads - 1:
            _add_atomic(arrived, np.int64(-threads))
            _add_atomic(opened, np.int64(1))
        spins = 0
        while _add_atomic(opened, np.int64(0)) == now:
            spins += 1
            if spins > SPINS:
                _yield_core()


class Team:
    """A fixed number of threads; the caller is one of them.

    Kernels are compiled with `nogil=True` and take (thread, threads, gate, ...) first.

    Examples
    --------
    >>> seen = []
    >>> Team(2).run(lambda thread, threads, gate, x: seen.append((thread, threads, x)), "a")
    >>> sorted(seen)
    [(0, 2, 'a'), (1, 2, 'a')]
    """

    def __init__(self, size: int) -> None:
        self.size = size
        self._gate = np.zeros(GATE_SIZE, np.int64)
        self._inboxes: list[SimpleQueue] = [SimpleQueue() for _ in range(size - 1)]
        self._done: SimpleQueue = SimpleQueue()
        for thread, inbox in enumerate(self._inboxes, start=1):
            args = (thread, size, self._gate, inbox, self._done)
            threading.Thread(target=_work, args=args, daemon=True).start()

    def run(self, kernel: Callable, *arguments: Any) -> None:
        """Call kernel(thread, threads, gate, *arguments) in every thread; return when all are done.

        A kernel that is still to be compiled is compiled before any thread starts it.
        """
        if self.size > 1 and hasattr(kernel, "signatures"):
            _compile(kernel, (0, self.size, self._gate, *arguments))
        for inbox in self._inboxes:
            inbox.put((kernel, arguments))
        kernel(0, self.size, self._gate, *arguments)
        errors = [self._done.get() for _ in self._inboxes]
        for error in errors:
            if error is not None:
                raise error

    def __del__(self) -> None:
        for inbox in self._inboxes:
            inbox.put(None)


def _work(thread: int, size: int, gate: Any, inbox: SimpleQueue, done: SimpleQueue) -> None:
    """Life of a thread; it holds no reference to the team, so that the team can be dropped."""
    while (job := inbox.get()) is not None:
        kernel, arguments = job
        error: BaseException | None = None
        try:
            kernel(thread, size, gate, *arguments)
        except BaseException as raised:  # handed to the caller
            error = raised
        del job, kernel, arguments
        done.put(error)


def _compile(kernel: Any, arguments: tuple[Any, ...]) -> None:
    from numba import typeof

    kernel.compile(tuple(typeof(argument) for argument in arguments))
