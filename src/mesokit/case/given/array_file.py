"""One array of numbers in a file of NumPy, whose shape is known before its numbers are read."""

import io
import math
import zipfile
import zlib
from typing import Any

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

MAGIC = b"\x93NUMPY"  # what a file .npy begins with
EXPECTED = "expected a .npy or .npz file of numbers"
HEADERS = {(1, 0): npy.read_array_header_1_0, (2, 0): npy.read_array_header_2_0}


def array_of_contents(contents: bytes) -> NDArray[Any]:
    """The array that the bytes of a .npy file are. Raises ValueError.

    >>> file = io.BytesIO()
    >>> np.save(file, np.arange(3))
    >>> array_of_contents(file.getvalue())
    array([0, 1, 2])
    """
    stream = io.BytesIO(contents)
    shape, dtype = _header(stream)
    if math.prod(shape) * dtype.itemsize != len(contents) - stream.tell():
        raise ValueError("it has not as many numbers as it says")
    stream.seek(0)
    return np.asarray(npy.read_array(stream, allow_pickle=False))


def array_in_file(
    path: str, name: str, shape: tuple[int, ...], scale: float | None = None
) -> NDArray[Any]:
    """The array of a .npy file, as a map of it, or the only one (or that of a name) of a .npz file;
    with a scale, of its numbers times that.

    Raises OSError for a file that cannot be read, and ValueError, with the reason, for another
    shape than this and for what is no array of numbers.
    """
    if is_plain(path):
        with open(path, "rb") as file:
            _require(file, shape)
        found = np.load(path, mmap_mode="r", allow_pickle=False)
    else:
        try:
            with zipfile.ZipFile(path) as archive:
                members = {member.removesuffix(".npy"): member for member in archive.namelist()}
                if name not in members and len(members) != 1:
                    raise ValueError(f"expected one array, or one named {name!r}")
                member = members[name if name in members else next(iter(members))]
                with archive.open(member) as stream:
                    _require(stream, shape)
                with archive.open(member) as stream:
                    found = np.asarray(npy.read_array(stream, allow_pickle=False))
        except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError):
            raise ValueError(EXPECTED) from None
    if scale is None or found.dtype.kind not in "iuf":  # other types are refused by their name
        return found
    return np.asarray(found, float) * scale


def is_plain(path: str) -> bool:
    """Whether a file is a .npy one, of which rows can be read where they are needed."""
    with open(path, "rb") as file:
        return file.read(len(MAGIC)) == MAGIC


def _require(stream: Any, wanted: tuple[int, ...]) -> None:
    shape, _ = _header(stream)
    if shape != wanted:
        raise ValueError(f"shape {shape}: expected {wanted}")


def _header(stream: Any) -> tuple[tuple[int, ...], np.dtype[Any]]:
    try:
        shape, _, dtype = HEADERS[npy.read_magic(stream)](stream)
    except (KeyError, ValueError):
        raise ValueError(EXPECTED) from None
    if dtype.hasobject:
        raise ValueError("expected an array of numbers, not of object")
    return shape, dtype
