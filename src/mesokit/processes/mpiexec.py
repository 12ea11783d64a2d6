"""Ranks on this machine: they are started by `mpiexec`, and what becomes of them is said once."""

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
from mesokit.processes import lifeline, parent
from mesokit.processes.signals import catching

# what launchers and libraries say about a rank that has ended, each in its way
NOISE = re.compile(
    r"^=+$|^=   (BAD TERMINATION|PID \d|EXIT CODE|CLEANING UP|YOU CAN IGNORE|KILLED BY)"
    r"|^YOUR APPLICATION TERMINATED|^This typically refers to a problem"
    r"|^Please see the FAQ|^Abort\(\d|^application called MPI_Abort"
    r"|^\[(proxy|mpiexec)[:@]|^Primary job  ?terminated|^-{60,}$|^(mpirun|mpiexec|prterun) noticed"
    r"|^a non-zero exit code|^Per user-direction"
)
DIED = re.compile(r"=   PID (?P<process>\d+) |process rank (?P<rank>\d+) with PID")
SIGNAL = re.compile(r"EXIT STRING: .*\(signal (\d+)\)|exited on signal (\d+)")
CURSOR = "\x1b[?25h\n"  # shown again, where a bar has been cut off


class End(NamedTuple):
    """How ranks have ended: the status, and the reason as far as it is known."""

    status: int
    why: str


def start(ranks: int, arguments: Sequence[str]) -> End:
    """Run `mesokit` with these arguments on so many ranks; wait, and pass on what they say.

    A signal goes to rank 0, which stops all at a checkpoint; a second one ends them at once. If
    this process is killed, they end by themselves.

    Raises RunError where there is no MPI.
    """
    command = [find(), "-n", str(ranks), sys.executable, "-m", "mesokit", *arguments]
    with contextlib.ExitStack() as held:
        name = held.enter_context(tempfile.TemporaryDirectory(prefix="mesokit-ranks-"))
        folder = Path(name)
        held.enter_context(lifeline.held(folder))
        process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=os.environ | {parent.FOLDER: name} | _terminal(sys.stderr),
            encoding="utf-8",
            errors="replace",
            start_new_session=True,  # Ctrl-C comes to us alone
        )
        asked: list[signal.Signals] = []

        def stop(by: signal.Signals) -> None:
            first = parent.number(folder / "rank-0")
            if asked or first is None:
                process.terminate()
            else:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(first, by)
            asked.append(by)

        with catching(stop):
            said = _pass_on(process)
            status = process.wait()
        ended = parent.number(folder / "ended")
        if ended is not None:
            return End(ended, "")
        if sys.stderr.isatty():
            print(CURSOR, end="", file=sys.stderr)
        if asked:
            return End(128 + asked[0], f"stopped by {asked[0].name}")
        return _what_is_known(folder, said, status)


def find() -> str:
    """The program that starts ranks: that of this environment, or the first there is.

    Raises RunError if there is none, or no mpi4py.
    """
    if importlib.util.find_spec("mpi4py") is None:
        raise RunError("--ranks: needs mpi4py: pip install 'mesokit[mpi]'")
    own = Path(sys.executable).parent
    found = shutil.which("mpiexec", path=str(own)) or shutil.which("mpiexec")
    if found is None:
        raise RunError("--ranks: no mpiexec here; expected an MPI: pip install 'mesokit[mpi]'")
    return found


def _terminal(stream: TextIO) -> dict[str, str]:
    """Where rank 0 finds our terminal, if there is one."""
    ttyname = getattr(os, "ttyname", None)
    if ttyname is None or not stream.isatty():
        return {}
    return {parent.TERMINAL: ttyname(stream.fileno())}


def _pass_on(process: subprocess.Popen[str]) -> list[str]:
    """Say what ranks say; what the launcher says of how they ended is not said."""
    kept: list[str] = []

    def say(lines: IO[str], stream: TextIO) -> None:
        for line in lines:
            if NOISE.search(line) or not line.strip():
                kept.append(line)
                continue
            with contextlib.suppress(OSError):  # the reader has left
                stream.write(line)
                stream.flush()

    assert process.stdout is not None and process.stderr is not None
    other = threading.Thread(target=say, args=(process.stdout, sys.stdout))
    other.start()
    say(process.stderr, sys.stderr)
    other.join()
    return kept


def _what_is_known(folder: Path, said: list[str], status: int) -> End:
    """Which rank has ended, and how, by what the launcher said."""
    text, rank_name = "".join(said), "a rank"
    if found := DIED.search(text):
        rank = found["rank"] or parent.rank_of(folder, int(found["process"]))
        rank_name = "a rank" if rank is None else f"rank {rank}"
    if found := SIGNAL.search(text):
        by = signal.Signals(int(found[1] or found[2]))
        return End(128 + by, f"{rank_name} ended by {by.name}")
    return End(status if 0 < status < 256 else 1, f"{rank_name} ended with status {status}")
