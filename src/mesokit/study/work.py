"""A worker, which carries one run of a study after another to its end."""

import contextlib
import importlib
import os
import queue
import signal
import sys
import threading
import time
from collections.abc import Sequence
from pathlib import Path

from mesokit.devices.names import CPU
from mesokit.errors import MesokitError, RunError
from mesokit.io.atomic import write_text
from mesokit.io.run_directory import RunDirectory
from mesokit.processes.signals import Stopped, catching
from mesokit.report.progress import Reporter
from mesokit.run.simulation import Simulation

NOTE_SECONDS = 1.0  # between two notes of how far a run has come


class Note(Reporter):
    """Writes the progress of a run to a file in its folder, for the study."""

    def __init__(self, file: Path) -> None:
        super().__init__(quiet=True)
        self.file, self.noted = file, 0.0

    def update(self, step: int) -> None:
        super().update(step)
        if (now := time.monotonic()) >= self.noted + NOTE_SECONDS:
            self.noted = now
            with contextlib.suppress(RunError):  # a run goes on without this file
                write_text(self.file, str(step))

    def finish(self) -> None:
        self.file.unlink(missing_ok=True)


def carry(path: str, threads: int = 1, modules: Sequence[str] = (), device: str = CPU) -> str:
    """Carry the run in a folder to its end, from its last checkpoint.

    `modules` define parts of its case. Returns "", or why it did not end.
    """
    try:
        with catching(_stop):
            for module in modules:
                importlib.import_module(module)
            simulation = Simulation.resume(path, threads=threads, device=device)
            simulation.run(progress=Note(RunDirectory(Path(path)).progress_file))
    except Stopped as stop:
        return str(stop) or "stopped"
    except MesokitError as error:
        return str(error)
    except (OSError, MemoryError, ImportError) as error:
        return f"{type(error).__name__}: {error}"
    return ""


def _stop(by: signal.Signals) -> None:
    """Stop at a signal before the run has begun."""
    raise Stopped(by, f"stopped before the start by {by.name}")


def serve(threads: int, device: str, modules: Sequence[str]) -> None:
    """Carry out runs from standard input, a folder in each line, and answer each with a line.

    If the study has ended, the present run ends at a checkpoint.
    """
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "w", encoding="utf-8")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # what others print is no answer
    lines: queue.SimpleQueue[str] = queue.SimpleQueue()
    busy = threading.Event()
    threading.Thread(target=_listen, args=(lines, busy), daemon=True).start()
    while path := lines.get():
        busy.set()
        said = carry(path, threads, modules, device)
        busy.clear()
        with contextlib.suppress(OSError):
            print(" ".join(said.split()), file=answers, flush=True)


def _listen(lines: queue.SimpleQueue[str], busy: threading.Event) -> None:
    for line in sys.stdin:
        lines.put(line.rstrip("\n"))
    lines.put("")
    if busy.is_set():
        signal.raise_signal(signal.SIGTERM)


if __name__ == "__main__":
    serve(int(sys.argv[1]), sys.argv[2], sys.argv[3:])
