"""What a run holds while it goes on, by name."""

from __future__ import annotations

import signal
from abc import abstractmethod
from typing import TYPE_CHECKING

from mesokit.run.seen import Seen

if TYPE_CHECKING:
    from mesokit.io.trajectory import TrajectoryWriter
    from mesokit.processes.world import World
    from mesokit.run.callbacks import Callbacks
    from mesokit.run.log import RunLog
    from mesokit.run.replicas import Replicas
    from mesokit.run.schedule import Schedule
    from mesokit.seam.observable import Accumulator
    from mesokit.seam.result import Result


class Held(Seen):
    """Case and particles are in memory; `directory` is None where nothing is written."""

    ranks: World
    threads: int
    replicas: Replicas
    accumulators: dict[str, Accumulator]
    schedule: Schedule
    callbacks: Callbacks
    log: RunLog
    writer: TrajectoryWriter | None
    _looked: bool  # whether the state that the run begins with has been sampled
    _asked_by: signal.Signals | None  # a signal that came to this rank
    _stopped_by: signal.Signals | None  # one that all ranks have stopped by
    _compiling: bool

    @abstractmethod
    def __getitem__(self, name: str) -> Result:
        """What an observable says so far."""

    @property
    @abstractmethod
    def timings(self) -> dict[str, float]:
        """Seconds spent in each stage and observable since this process began the run."""

    @abstractmethod
    def lengthen(self, steps: int) -> None:
        """Let the run last so many steps after its warm-up, also on record."""

    @abstractmethod
    def checkpoint(self) -> None:
        """Write a checkpoint now."""
