"""Stop of a run before its end, by a signal to any of its processes or by a callback."""

import contextlib
import signal
from collections.abc import Iterator

from mesokit.processes.signals import Stopped, catching
from mesokit.processes.world import World
from mesokit.run.callbacks import Callbacks


class Stop:
    """State of the stop of a run.

    A signal is first `heard` on the rank to which it comes, which sends it to rank 0. All ranks
    then stop `by` it at the same step. `callbacks.stopped` has the reason of a callback.
    """

    def __init__(self, ranks: World, callbacks: Callbacks) -> None:
        self.ranks, self.callbacks = ranks, callbacks
        self.heard: signal.Signals | None = None
        self.by: signal.Signals | None = None
        self.compiling: int | None = None  # the present step while kernels are compiled

    @contextlib.contextmanager
    def listening(self) -> Iterator[None]:
        """Let signals stop the run meanwhile; earlier signals do not matter."""
        self.heard = self.by = None
        self.ranks.begin()
        with catching(self._hear):
            yield

    def _hear(self, by: signal.Signals) -> None:
        """The first signal stops the run after the present steps, a second one at once."""
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
        """True if all ranks are to stop now."""
        return self.by is not None or self.callbacks.stopped is not None

    def agree(self) -> None:
        """Send a signal that rank 0 has received to all ranks."""
        heard = self.ranks.heard(self.number())
        by = self.ranks.on_root(lambda: heard)
        self.by = signal.Signals(by) if by else None

    def error(self, step: int) -> Stopped:
        """The step and the signal by which the run was stopped."""
        assert self.by is not None
        doing = ", while compiling," if self.compiling is not None else ""
        return Stopped(self.by, f"stopped at step {step}{doing} by {self.by.name}")

    @contextlib.contextmanager
    def at_once(self, step: int) -> Iterator[None]:
        """Let the first signal stop the run at once while kernels are compiled.

        Python drops an exception of a signal handler that is called from the compiler. The compiler
        then goes on, or fails with a RuntimeError about an unfinished kernel. So we check again.
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
