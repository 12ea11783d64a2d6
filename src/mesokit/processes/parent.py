"""What ranks tell the process that has started them: `mesokit run --ranks` of this machine.

It gives them a folder, in which each notes its number, and the one that speaks last the status that
all of this ends with.
"""

import os
import sys
from pathlib import Path

from mesokit.processes import lifeline

FOLDER = "MESOKIT_RANKS_FOLDER"
TERMINAL = "MESOKIT_TERMINAL"  # where the progress bar of rank 0 is to be


def known() -> bool:
    """Whether there is such a process."""
    return FOLDER in os.environ


def note_rank(rank: int) -> None:
    """This process is that rank, and ends with the one that has started it."""
    if known():
        lifeline.end_with(Path(os.environ[FOLDER]))
        _write(f"rank-{rank}", os.getpid())


def note_end(status: int) -> None:
    """All has been said, and this is the status."""
    if known():
        _write("ended", status)


def take_terminal() -> None:
    """Rank 0 tells its progress where the process that has started it would."""
    name = os.environ.get(TERMINAL)
    if name is not None:
        sys.stderr.flush()
        os.dup2(os.open(name, os.O_WRONLY | getattr(os, "O_NOCTTY", 0)), 2)


def rank_of(folder: Path, process: int) -> int | None:
    """Which rank a process was."""
    for file in folder.glob("rank-*"):
        if number(file) == process:
            return int(file.name.partition("-")[2])
    return None


def number(file: Path) -> int | None:
    """What a file says, None if it is not there."""
    try:
        return int(file.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None


def _write(name: str, number: int) -> None:
    folder = Path(os.environ[FOLDER])
    beside = folder / f".{name}"
    beside.write_text(str(number), encoding="utf-8")
    os.replace(beside, folder / name)
