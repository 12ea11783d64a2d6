"""Threads that run one kernel together, and the gate at which they wait for one another."""

import threading
from queue import SimpleQueue
from typing import Any, NamedTuple

import numpy as np
from llvmlite import ir
from numba import typeof, types
from numba.extending import intrinsic

from mesokit.kernels.packing import all_packed, packed
from mesokit.loops.clock import CLOCK_SIZE
from mesokit.scalar.jit import scalar
from mesokit.scalar.system import yield_core

SPINS = 1_000  # some ten microseconds; a thread that waits longer lets others have the core

# The gate: how many threads have come, and how often it has opened; each on its own cache line.
ARRIVED, OPENED, GATE_SIZE = 0, 8, 16


@intrinsic
def _add_atomic(typing_context: Any, pointer: Any, value: Any) -> Any:
    """Add to an int64 in memory; gives what it was."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        place = builder.inttoptr(arguments[0], ir.IntType(64).as_pointer())
        return builder.atomic_rmw("add", place, arguments[1], "seq_cst")

    return types.int64(types.uintp, types.int64), generate


class Worker(NamedTuple):
    """The threads that run a kernel together, as one of them sees it."""

    thread: int
    threads: int
    gate: Any
    clock: Any


@scalar
def barrier(worker):
    """Go on when all threads have come here: what each wrote before, all can read after."""
    if worker.threads > 1:
        arrived = np.uint64(worker.gate.ctypes.data + 8 * ARRIVED)
        opened = np.uint64(worker.gate.ctypes.data + 8 * OPENED)
        now = _add_atomic(opened, np.int64(0))
        if _add_atomic(arrived, np.int64(1)) == worker.threads - 1:
            _add_atomic(arrived, np.int64(-worker.threads))
            _add_atomic(opened, np.int64(1))
        spins = 0
        while _add_atomic(opened, np.int64(0)) == now:
            spins += 1
            if spins > SPINS:
                yield_core()


class Threads:
    """A fixed number of threads; the caller is one of them.

    Kernels are compiled with `nogil=True` and take a `Worker` first.

    Examples
    --------
    >>> seen = []
    >>> Threads(2).run(lambda worker, x: seen.append((worker.thread, worker.threads, x)), "a")
    >>> sorted(seen)
    [(0, 2, 'a'), (1, 2, 'a')]
    """

    def __init__(self, size: int) -> None:
        self.size = size
        self.clock = np.zeros(CLOCK_SIZE, np.int64)
        self._gate = np.zeros(GATE_SIZE, np.int64)
        self._own = self._worker(0)  # of the caller
        self._inboxes: list[SimpleQueue] = [SimpleQueue() for _ in range(size - 1)]
        self._done: SimpleQueue = SimpleQueue()
        for thread, inbox in enumerate(self._inboxes, start=1):
            args = (self._worker(thread), inbox, self._done)
            threading.Thread(target=_work, args=args, daemon=True).start()

    def run(self, kernel: Any, *arguments: Any) -> None:
        """Call kernel(worker, *arguments) in every thread; return when all are done.

        A kernel that is still to be compiled is compiled before any thread starts it.
        """
        arguments = all_packed(arguments)
        if self.size > 1 and hasattr(kernel, "signatures"):
            kernel.compile(tuple(map(typeof, (self._own, *arguments))))
        if self.size == 1:
            kernel(self._own, *arguments)
        else:
            self._call_all(kernel, arguments)

    def _call_all(self, kernel: Any, arguments: tuple) -> None:
        """Call a compiled kernel in every thread; no signal ends this before all are done."""
        for inbox in self._inboxes:
            inbox.put((kernel, arguments))
        kernel(self._own, *arguments)
        errors = [self._done.get() for _ in self._inboxes]
        for error in errors:
            if error is not None:
                raise error

    def compile_ahead(self, kernel: Any, *arguments: Any) -> None:
        """Have another core compile what `run` will call, if there is one."""
        kernel.compile_ahead(self._own, *arguments)

    def _worker(self, thread: int) -> Any:
        return packed(Worker(thread, self.size, self._gate, self.clock))

    def __del__(self) -> None:
        for inbox in self._inboxes:
            inbox.put(None)


def _work(worker: Worker, inbox: SimpleQueue, done: SimpleQueue) -> None:
    """Life of a thread; it holds no reference to `Threads`, so that these can be dropped."""
    while (job := inbox.get()) is not None:
        kernel, arguments = job
        error: BaseException | None = None
        try:
            kernel(worker, *arguments)
        except BaseException as raised:  # handed to the caller
            error = raised
        del job, kernel, arguments
        done.put(error)
