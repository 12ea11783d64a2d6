"""Ranks on this machine: `mpiexec` starts them, and one line says how they end."""

import contextlib
import importlib.util
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import IO, NamedTuple, TextIO

from mesokit.errors import RunError
from mesokit.processes import parent
from mesokit.processes.signals import catching

# lines of launchers and libraries about a rank that has ended
NOISE = re.compile(
    r"^=+$|^=   (BAD TERMINATION|PID \d|EXIT CODE|CLEANING UP|YOU CAN IGNORE|KILLED BY)"
    r"|^YOUR APPLICATION TERMINATED|^This typically refers to a problem"
    r"|^Please see the FAQ|^Abort\(\d|^application called MPI_Abort"
    r"|^\[(proxy|mpiexec)[:@]|^Primary job  ?terminated|^-{60,}$|^(mpirun|mpiexec|prterun) noticed"
    r"|^a non-zero exit code|^Per user-direction"
)
DIED = re.compile(r"=   PID (?P<process>\d+) |process rank (?P<rank>\d+) with PID")
SIGNAL = re.compile(r"EXIT STRING: .*\(signal (\d+)\)|exited on signal (\d+)")
CURSOR = "\x1b[?25h\n"  # visible again after a bar that was cut off


class End(NamedTuple):
    """How ranks have ended: status, and reason as far as it is known."""

    status: int
    why: str


def start(ranks: int, arguments: Sequence[str]) -> End:
    """Run `mesokit` with these arguments on several ranks, wait, and pass on their output.

    A signal goes to rank 0, which stops all ranks at a checkpoint; a second one ends them at once.
    If this process is killed, they end by themselves.

    Raises RunError without MPI.
    """
    command = [find(), "-n", str(ranks), sys.executable, "-m", "mesokit", *arguments]
    with (
        tempfile.TemporaryDirectory(prefix="mesokit-ranks-") as name,
        parent.alive(folder := Path(name)),
    ):
        environment = os.environ | {parent.FOLDER: name}
        if sys.stderr.isatty() and hasattr(os, "ttyname"):
            environment[parent.TERMINAL] = os.ttyname(sys.stderr.fileno())
        process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=environment,
            encoding="utf-8",
            errors="replace",
            start_new_session=True,  # Ctrl-C comes to this process alone
        )
        received: list[signal.Signals] = []

        def stop(by: signal.Signals) -> None:
            first = parent.number(folder / "rank-0")
            if received or first is None:
                process.terminate()
            else:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(first, by)
            received.append(by)

        with catching(stop):
            said = _pass_on(process)
            status = process.wait()
        ended = parent.number(folder / "ended")
        if ended is not None:
            return End(ended, "")
        if sys.stderr.isatty():
            print(CURSOR, end="", file=sys.stderr)
        if received:
            return End(128 + received[0], f"stopped by {received[0].name}")
        return _what_is_known(folder, said, status)


def find() -> str:
    """The program that starts ranks: that of this environment, or the first on the path.

    Raises RunError without one, or without mpi4py.
    """
    if importlib.util.find_spec("mpi4py") is None:
        raise RunError("--ranks: needs mpi4py: pip install 'mesokit[mpi]'")
    own = Path(sys.executable).parent
    found = shutil.which("mpiexec", path=str(own)) or shutil.which("mpiexec")
    if found is None:
        raise RunError("--ranks: no mpiexec here; expected an MPI: pip install 'mesokit[mpi]'")
    return found


def _pass_on(process: subprocess.Popen[str]) -> list[str]:
    """Print the output of the ranks; the launcher's own lines are returned instead."""
    kept: list[str] = []

    def copy(lines: IO[str], stream: TextIO) -> None:
        for line in lines:
            if NOISE.search(line) or not line.strip():
                kept.append(line)
                continue
            with contextlib.suppress(OSError):  # the reader has left
                stream.write(line)
                stream.flush()

    assert process.stdout is not None and process.stderr is not None
    other = threading.Thread(target=copy, args=(process.stdout, sys.stdout))
    other.start()
    copy(process.stderr, sys.stderr)
    other.join()
    return kept


def _what_is_known(folder: Path, said: list[str], status: int) -> End:
    """Which rank has ended, and how, from the lines of the launcher."""
    text, rank_name = "".join(said), "a rank"
    if found := DIED.search(text):
        rank = found["rank"] or parent.rank_of(folder, int(found["process"]))
        rank_name = "a rank" if rank is None else f"rank {rank}"
    if found := SIGNAL.search(text):
        by = signal.Signals(int(found[1] or found[2]))
        return End(128 + by, f"{rank_name} ended by {by.name}")
    return End(status if 0 < status < 256 else 1, f"{rank_name} ended with status {status}")
