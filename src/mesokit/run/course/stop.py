"""How a run is stopped: by a signal to any rank, or by a callback."""

from __future__ import annotations

import signal

from mesokit.processes.signals import Stopped
from mesokit.run.course.held import Held


class Stop(Held):
    """A signal ends the loop after the steps in hand, on all ranks at the same step."""

    @property
    def _stopped(self) -> Stopped:
        """Where the run was stopped, and by what."""
        by, doing = self._stopped_by, ", while compiling," if self._compiling else ""
        assert by is not None
        return Stopped(by, f"stopped at step {self.step}{doing} by {by.name}")

    def _signal(self) -> int:
        """The number of the signal that has come to this rank, or 0."""
        return self._asked_by or 0

    def _asked(self) -> bool:
        """Whether a signal or a callback has asked to end the run, by what rank 0 knows."""
        heard = self.ranks.heard(self._signal())
        by = self.ranks.on_root(lambda: heard)
        self._stopped_by = signal.Signals(by) if by else None
        return self._stopping

    @property
    def _stopping(self) -> bool:
        """Whether a signal or a callback has asked to end the run."""
        return self._stopped_by is not None or self.callbacks.stopped is not None

    def _stop(self, by: signal.Signals) -> None:
        """A signal ends the loop after the steps in hand; a second one stops at once."""
        if self._asked_by is not None:
            raise Stopped(by)
        self._asked_by = by
        if self._compiling:
            self._stopped_by = by
            raise self._stopped
