"""Runs one after another in this process: for parts that only a script or a notebook defines."""

from __future__ import annotations

from concurrent.futures import Future
from pathlib import Path

from mesokit.study.work import carry


class Here:
    """No worker but this process; a signal ends the run in hand, and the study with it."""

    places = 1

    def __init__(self, threads: int = 1) -> None:
        self.threads = threads

    def submit(self, path: Path) -> Future[str]:
        """Carry the run in a folder to its end, before this returns."""
        done: Future[str] = Future()
        done.set_result(carry(str(path), self.threads))
        return done

    def stop(self) -> None:
        """Nothing is in hand."""

    def close(self) -> None:
        """Nothing is open."""
