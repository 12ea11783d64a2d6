"""One process at a time writes into the folder of a run."""

import contextlib
from collections.abc import Iterator

from mesokit.errors import RunError
from mesokit.io.run_directory import RunDirectory


@contextlib.contextmanager
def alone(directory: RunDirectory | None) -> Iterator[None]:
    """Hold the lock of a folder; the system releases it with the process, even by a kill.

    Raises RunError if another writes there. Where a file system knows no locks, all may write.
    """
    if directory is None:
        yield
        return
    from filelock import FileLock, Timeout

    lock = FileLock(directory.lock_file)
    try:
        lock.acquire(blocking=False)
    except Timeout:
        said = f"{directory.path}: another process is writing there; wait for it, or stop it first"
        raise RunError(said) from None
    except (OSError, NotImplementedError):  # no locks here, or the folder cannot be written:
        pass  # writing will report it
    try:
        yield
    finally:
        lock.release()
