"""One process at a time writes into the folder of a run."""

import contextlib
from collections.abc import Iterator

from mesokit.errors import RunError
from mesokit.io.run_directory import RunDirectory


@contextlib.contextmanager
def alone(directory: RunDirectory | None) -> Iterator[None]:
    """Hold the lock of a folder, which the system releases with the process, even by a kill.

    Raises RunError if another process writes there. File systems without locks let all write.
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
    except (OSError, NotImplementedError):
        pass  # there are no locks; or the folder cannot be written, which writing will report
    try:
        yield
    finally:
        lock.release()
