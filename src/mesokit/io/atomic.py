"""Files that are replaced as a whole, also if the process or the machine fails."""

import errno
import os
import shutil
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from mesokit.errors import RunError

PAUSES = (0.01, 0.05, 0.2, 0.5)  # seconds, as virus scanners and other readers may need
CANNOT = (errno.EINVAL, errno.ENOTSUP, errno.EBADF, errno.EACCES)  # for a folder


@contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """A temporary file in the same folder, which becomes `path` if nothing goes wrong.

    Whatever goes wrong, the old file stays as it was and the temporary one is removed. Raises
    RunError where the system refuses, for example because the disk is full.

    >>> import tempfile
    >>> folder = Path(tempfile.mkdtemp())
    >>> with replacing(folder / "a.txt") as temporary:
    ...     _ = temporary.write_text("whole")
    >>> (folder / "a.txt").read_text(), len(list(folder.iterdir()))
    ('whole', 1)
    """
    path = Path(path)
    temporary = path.with_name(f".{path.name}.tmp")
    try:
        # An empty file of our own: a link in its place is removed, and not followed.
        temporary.unlink(missing_ok=True)
        os.close(os.open(temporary, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))
        yield temporary
        with temporary.open("rb+") as file:  # Windows needs the right to write
            os.fsync(file.fileno())  # the contents survive a loss of power
        _replace(temporary, path)
        _folder_to_disk(path.parent)
    except OSError as error:
        why = error.strerror or str(error).splitlines()[0]
        raise RunError(f"cannot write {path}: {why[0].lower()}{why[1:]}") from error
    finally:
        with suppress(OSError):  # where the folder itself is not there, the error above says so
            temporary.unlink(missing_ok=True)


def write_text(path: str | Path, text: str) -> Path:
    """Write a text file whole, and return its path. Raises RunError."""
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")
    return Path(path)


def delete_folder(folder: Path) -> None:
    """Delete a folder; a link in its place is deleted, and what it leads to is not."""
    if folder.is_symlink():
        folder.unlink()
    shutil.rmtree(folder, ignore_errors=True)


def _replace(temporary: Path, path: Path) -> None:
    """Rename; where a file that another process reads cannot be replaced, try again for a while."""
    for pause in PAUSES if sys.platform == "win32" else ():
        with suppress(PermissionError):
            return os.replace(temporary, path)
        time.sleep(pause)
    os.replace(temporary, path)


def _folder_to_disk(path: Path) -> None:
    """Let the names in a folder survive a loss of power. Windows and some network disks do so
    themselves, and refuse this call."""
    with suppress(PermissionError):
        handle = os.open(path, os.O_RDONLY)
        try:
            os.fsync(handle)
        except OSError as error:
            if error.errno not in CANNOT:
                raise
        finally:
            os.close(handle)
