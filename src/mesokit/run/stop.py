"""How a run comes to stop before its end: a signal to any of its processes, or a callback."""

from __future__ import annotations

import contextlib
import signal
from collections.abc import Iterator
from typing import TYPE_CHECKING

from mesokit.processes.signals import Stopped, catching

if TYPE_CHECKING:
    from mesokit.processes.world import World
    from mesokit.run.callbacks import Callbacks


class Stop:
    """Whether a run is to stop, and by what.

    A signal is first `heard` by the rank that it comes to, which tells rank 0. All ranks then stop
    `by` it at the same step, the end of the steps in hand. Why a callback has stopped the run, the
    callbacks know (`stopped`).
    """

    def __init__(self, ranks: World, callbacks: Callbacks) -> None:
        self.ranks, self.callbacks = ranks, callbacks
        self.heard: signal.Signals | None = None
        self.by: signal.Signals | None = None
        self.compiling: int | None = None  # the step at which that is done, if it is

    @contextlib.contextmanager
    def listening(self) -> Iterator[None]:
        """Signals stop the run meanwhile; those that came before do not matter any more."""
        self.heard = self.by = None
        self.ranks.begin()
        with catching(self._hear):
            yield

    def _hear(self, by: signal.Signals) -> None:
        """The first waits for the end of the steps in hand, where there are any; a second stops at
        once."""
        if self.heard is not None:
            raise Stopped(by)
        self.heard = by
        if self.compiling is not None:
            self.by = by
            raise self.error(self.compiling)

    def number(self) -> int:
        """The number of the signal that has come to this rank, or 0."""
        return self.heard or 0

    @property
    def due(self) -> bool:
        """Whether all ranks know that the run is to stop now."""
        return self.by is not None or self.callbacks.stopped is not None

    def agree(self) -> None:
        """Let all ranks know of a signal that rank 0 knows of."""
        heard = self.ranks.heard(self.number())
        by = self.ranks.on_root(lambda: heard)
        self.by = signal.Signals(by) if by else None

    def error(self, step: int) -> Stopped:
        """Where the run was stopped, and by which signal."""
        assert self.by is not None
        doing = ", while compiling," if self.compiling is not None else ""
        return Stopped(self.by, f"stopped at step {step}{doing} by {self.by.name}")

    @contextlib.contextmanager
    def at_once(self, step: int) -> Iterator[None]:
        """Kernels are compiled meanwhile, at this step: the first signal ends that at once.

        The compiler calls back into Python, which drops what a signal raises there. It then goes
        on, or fails with a RuntimeError about what is left of a kernel: so we look afterwards.
        """
        self.compiling = step
        try:
            yield
            if self.by is not None:
                raise self.error(step)
        except RuntimeError:
            if self.by is None:
                raise
            raise self.error(step) from None
        finally:
            self.compiling = None
