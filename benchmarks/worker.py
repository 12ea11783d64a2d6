"""A process that measures on demand: a line in, a line of numbers out, "ready" before the first."""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


class Worker:
    """A process of its own, of whichever Python."""

    def __init__(self, command: Sequence[str]) -> None:
        pipe = subprocess.PIPE
        self.process = subprocess.Popen(
            command, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL, text=True, cwd=ROOT
        )
        while self._line() != "ready":
            pass

    def _line(self) -> str:
        line = self.process.stdout.readline()
        if not line:
            raise RuntimeError(f"{' '.join(map(str, self.process.args))}: it ended")
        return line.strip()

    def numbers(self) -> list[float]:
        """What it prints for a line."""
        self.process.stdin.write("\n")
        self.process.stdin.flush()
        return [float(word) for word in self._line().split()]

    def end(self) -> None:
        """End the process."""
        self.process.stdin.close()
        self.process.wait()


def in_turn(workers: Sequence[Worker | None], rounds: int) -> list[list[list[float]]]:
    """Numbers of each, a list for a round; nan of one that is not there."""
    nan = [float("nan")] * 2
    found = [[one.numbers() if one else nan for one in workers] for _ in range(rounds)]
    for one in filter(None, workers):
        one.end()
    return found
