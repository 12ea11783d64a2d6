"""HDF5 files whose errors of reading and writing are exceptions, also on a full disk."""

import io
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import h5py

from mesokit.errors import RunError

MOST_IN_MEMORY = 2**28  # bytes kept in memory once the disk is full


class _Target(io.FileIO):
    """A file that HDF5 can always write, read and close; otherwise it may end the process.

    From the first write that the system refuses, as on a full disk, writes are kept in memory and
    read from there; `refused` is the reason.
    """

    def __init__(self, path: str | Path) -> None:
        super().__init__(path, "w+")
        self.refused: OSError | None = None
        self._kept: list[tuple[int, bytes]] = []  # offsets and what was written there
        self._end = 0  # of the last byte in memory

    def check(self) -> None:
        """Raise OSError once the system has refused a write."""
        if self.refused is not None:
            raise self.refused

    def write(self, data: Any) -> int:
        whole = memoryview(data).cast("B")
        start, left = self.tell(), whole
        try:
            while len(left) and self.refused is None:
                left = left[super().write(left) :]
        except OSError as error:
            self.refused = error
        if self.refused is not None:
            end = start + whole.nbytes
            if sum(len(one) for _, one in self._kept) < MOST_IN_MEMORY:
                self._kept.append((start, bytes(whole)))
            self._end = max(self._end, end)
            self.seek(end)
        return whole.nbytes

    def readinto(self, buffer: Any) -> int:
        """Fill a buffer from the file and from memory."""
        if self.refused is None:
            return super().readinto(buffer) or 0
        out, start = memoryview(buffer).cast("B"), self.tell()
        out[:] = bytes(out.nbytes)
        super().readinto(out)
        for at, data in self._kept:
            first, last = max(at, start), min(at + len(data), start + out.nbytes)
            if first < last:
                out[first - start : last - start] = data[first - at : last - at]
        self.seek(start + out.nbytes)
        return out.nbytes

    def seek(self, offset: int, whence: int = io.SEEK_SET) -> int:
        if whence == io.SEEK_END:
            return super().seek(max(super().seek(0, io.SEEK_END), self._end) + offset)
        return super().seek(offset, whence)

    def truncate(self, size: int | None = None) -> int:
        try:
            return super().truncate(size)
        except OSError as error:
            self.refused = self.refused or error
            return size or 0

    def flush(self) -> None:
        """Do nothing: there is no buffer."""


@contextmanager
def made(path: str | Path) -> Iterator[tuple[Any, Callable[[], None]]]:
    """A new HDF5 file, for writing, and a function that raises OSError once a write was refused.

    Raises OSError at the end, such as for a full disk.
    """
    with _Target(path) as target:
        try:
            with h5py.File(target, "w") as file:
                yield file, target.check
        except (OSError, RuntimeError):  # what HDF5 makes of it
            if target.refused is None:
                raise
        target.check()


@contextmanager
def opened(path: str | Path) -> Iterator[Any]:
    """The HDF5 file, for reading. Raises RunError if it is damaged, also while it is read."""
    try:
        with h5py.File(path, "r") as file:
            yield file
    except FileNotFoundError:
        raise RunError(f"{path}: no such file") from None
    except (OSError, LookupError, ValueError, TypeError, AttributeError, RuntimeError) as error:
        if getattr(error, "errno", None):  # not the file but the system, such as a full disk
            raise
        raise RunError(f"{path}: damaged: it is not a whole HDF5 file") from None
