"""Ranks do not outlive the process that has started them on this machine, even if it is killed.

It holds a lock, of which the system lets go when that process ends in whatever way; ranks ask for
the lock, and the process that gets it ends.
"""

import contextlib
import os
import threading
import time
from collections.abc import Iterator
from pathlib import Path

LOCK = "alive"
PAUSE = 0.5  # seconds between two questions


@contextlib.contextmanager
def held(folder: Path) -> Iterator[None]:
    """Hold a lock while this process lives; a file system without locks has none."""
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


def end_with(folder: Path) -> None:
    """End this process, whatever it is at, as soon as the one that has that folder is gone."""
    if (folder / LOCK).exists():
        threading.Thread(target=_wait, args=(folder,), daemon=True).start()


def _wait(folder: Path) -> None:
    from filelock import FileLock

    while (folder / LOCK).exists():  # the process that made it removes it
        try:
            FileLock(folder / LOCK).acquire(poll_interval=PAUSE)
            break
        except OSError:  # could not be asked for just now
            time.sleep(PAUSE)
    os._exit(1)
