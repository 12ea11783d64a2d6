"""Files and variables that connect ranks with `mesokit run --ranks`, the process that starts them.

In a temporary folder each rank notes its process number, and the last one that prints notes the
exit status of all. The parent holds a lock in the folder. The system releases the lock when the
parent ends, even if it is killed; a rank that then gets the lock ends, so no rank is left running.
"""

import contextlib
import os
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

FOLDER = "MESOKIT_RANKS_FOLDER"
TERMINAL = "MESOKIT_TERMINAL"  # terminal for the progress bar of rank 0
LOCK = "alive"
PAUSE = 0.5  # seconds between two tries to get the lock


def known() -> bool:
    """True if there is such a parent."""
    return FOLDER in os.environ


def note_rank(rank: int) -> None:
    """Note the number of this process, and let it end with its parent."""
    if known():
        folder = Path(os.environ[FOLDER])
        if (folder / LOCK).exists():
            threading.Thread(target=_end_with, args=(folder,), daemon=True).start()
        _write(f"rank-{rank}", os.getpid())


def note_end(status: int) -> None:
    """Note the exit status of all ranks; everything has been printed."""
    if known():
        _write("ended", status)


def take_terminal() -> None:
    """Let rank 0 draw its progress on the terminal of the parent."""
    name = os.environ.get(TERMINAL)
    if name is not None:
        sys.stderr.flush()
        os.dup2(os.open(name, os.O_WRONLY | getattr(os, "O_NOCTTY", 0)), 2)


def rank_of(folder: Path, process: int) -> int | None:
    """The rank that a process had."""
    found = (file for file in folder.glob("rank-*") if number(file) == process)
    return next((int(file.name.partition("-")[2]) for file in found), None)


def number(file: Path) -> int | None:
    """The number in a file, None without one."""
    try:
        return int(file.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None


def _write(name: str, number: int) -> None:
    folder = Path(os.environ[FOLDER])
    beside = folder / f".{name}"
    beside.write_text(str(number), encoding="utf-8")
    os.replace(beside, folder / name)


@contextlib.contextmanager
def alive(folder: Path) -> Iterator[None]:
    """Hold the lock while this process lives; without it if the file system has no locks."""
    from filelock import FileLock

    lock = FileLock(folder / LOCK)
    try:
        lock.acquire(blocking=False)
    except (OSError, NotImplementedError):
        (folder / LOCK).unlink(missing_ok=True)
    try:
        yield
    finally:
        lock.release()


def _end_with(folder: Path) -> None:
    """End this process, whatever it does, as soon as its parent is gone."""
    from filelock import FileLock

    while (folder / LOCK).exists():  # a parent that ends in order removes it
        try:
            FileLock(folder / LOCK).acquire(poll_interval=PAUSE)
            break
        except OSError:  # the system cannot answer at present
            time.sleep(PAUSE)
    os._exit(1)
