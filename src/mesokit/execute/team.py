"""Threads that run one kernel together, each on its share of the blocks."""

from __future__ import annotations

import threading
from collections.abc import Callable
from queue import SimpleQueue
from typing import Any


class Team:
    """A fixed number of threads; the caller is one of them.

    Kernels are compiled with `nogil=True` and take (thread, threads, ...) first.

    Examples
    --------
    >>> seen = []
    >>> Team(2).run(lambda thread, threads, x: seen.append((thread, threads, x)), "a")
    >>> sorted(seen)
    [(0, 2, 'a'), (1, 2, 'a')]
    """

    def __init__(self, size: int) -> None:
        self.size = size
        self._inboxes: list[SimpleQueue] = [SimpleQueue() for _ in range(size - 1)]
        self._done: SimpleQueue = SimpleQueue()
        for thread, inbox in enumerate(self._inboxes, start=1):
            args = (thread, size, inbox, self._done)
            threading.Thread(target=_work, args=args, daemon=True).start()

    def run(self, kernel: Callable, *arguments: Any) -> None:
        """Call kernel(thread, threads, *arguments) in every thread; return when all are done."""
        for inbox in self._inboxes:
            inbox.put((kernel, arguments))
        try:
            kernel(0, self.size, *arguments)
        finally:
            errors = [self._done.get() for _ in self._inboxes]
        for error in errors:
            if error is not None:
                raise error

    def __del__(self) -> None:
        for inbox in self._inboxes:
            inbox.put(None)


def _work(thread: int, size: int, inbox: SimpleQueue, done: SimpleQueue) -> None:
    """Life of a thread; it holds no reference to the team, so that the team can be dropped."""
    while (job := inbox.get()) is not None:
        kernel, arguments = job
        try:
            kernel(thread, size, *arguments)
            done.put(None)
        except BaseException as error:  # handed to the caller
            done.put(error)
        del job, kernel, arguments
