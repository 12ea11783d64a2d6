"""Of several processes that need the same kernel, one compiles it; the others wait for the file."""

from __future__ import annotations

import contextlib
import hashlib
from pathlib import Path

from filelock import BaseFileLock, FileLock

PATIENCE = 300.0  # seconds: a process that was stopped holds no other up for ever


def taken(folder: str, name: str) -> BaseFileLock | None:
    """The lock of what has this name, once no other process has it.

    None where the file system knows no locks, and after too long a wait: then all compile. The
    system takes the lock from a process that ends.
    """
    place = Path(folder) / "locks" / hashlib.sha256(name.encode()).hexdigest()[:32]
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
        lock = FileLock(place, timeout=PATIENCE)
        lock.acquire(poll_interval=0.02)
    except (OSError, NotImplementedError):  # Timeout is an OSError
        return None
    return lock


def released(lock: BaseFileLock | None) -> None:
    """Let other processes go on."""
    if lock is not None:
        lock.release()
        with contextlib.suppress(OSError):  # a process that waits has it open
            Path(lock.lock_file).unlink()
