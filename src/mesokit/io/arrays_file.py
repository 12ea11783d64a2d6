"""Files of named arrays (.npz), as of `numpy.savez`, written and read without a copy in memory.

An array that comes in pieces has a shape, a dtype and `blocks()`, which yields its rows in order.
"""

import math
import zipfile
from collections import deque
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from mesokit.errors import RunError
from mesokit.io.atomic import replacing

LARGE = 2**20  # bytes of an array that stays in the file
READ = 2**20  # bytes at a time
SUFFIX = ".npy"
HEADERS = {(1, 0): npy.read_array_header_1_0, (2, 0): npy.read_array_header_2_0}


def save(
    path: str | Path, arrays: Mapping[str, Any], here: bool = True, folder: bool = False
) -> None:
    """Write a file of arrays whole, or leave the old one. Raises RunError if it cannot be written.

    Of several ranks that all call this and gather pieces, the one with `here` writes. If it fails,
    the others still send their pieces. With `folder` a missing folder of the file is made.
    """
    members = [(name, *_header_and_blocks(entry)) for name, entry in arrays.items()]
    try:
        if here:
            if folder:
                _make(Path(path).parent)
            with (
                replacing(path) as temporary,
                zipfile.ZipFile(temporary, "w", zipfile.ZIP_STORED, allowZip64=True) as archive,
            ):
                for name, header, blocks in members:
                    with archive.open(name + SUFFIX, mode="w", force_zip64=True) as member:
                        npy.write_array_header_1_0(member, header)
                        for rows in blocks:
                            member.write(np.ascontiguousarray(rows).reshape(-1).view(np.uint8).data)
    finally:
        for _, _, blocks in members:
            deque(blocks, maxlen=0)  # what is left of them


def _make(folder: Path) -> None:
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise RunError(f"cannot make {folder}: {error.strerror}") from None


def _header_and_blocks(entry: Any) -> tuple[dict[str, Any], Iterator[NDArray[Any]]]:
    """The header of NumPy for an array, and its rows block by block."""
    spread = hasattr(entry, "blocks")
    array = entry if spread else np.asanyarray(entry)
    descr = npy.dtype_to_descr(array.dtype)
    header = {"shape": array.shape, "fortran_order": False, "descr": descr}
    return header, iter(entry.blocks() if spread else [array])


def load(path: str | Path, large: float = math.inf) -> dict[str, NDArray[Any]]:
    """The arrays of a file; those of at least `large` bytes stay there as maps.

    Every byte is checked first. Raises the errors of zipfile, zlib and numpy for a damaged file,
    and ValueError for compressed members, which cannot be mapped.
    """
    with zipfile.ZipFile(path) as archive:
        _check(archive)
        return {
            member.filename.removesuffix(SUFFIX): _array(path, archive, member, large)
            for member in archive.infolist()
        }


def _check(archive: zipfile.ZipFile) -> None:
    """Read every byte of a file, and compare checksums."""
    for member in archive.infolist():
        _require_plain(member)
    for member in archive.infolist():
        with archive.open(member) as stream:
            while stream.read(READ):
                pass


def one(path: str | Path, name: str) -> NDArray[Any]:
    """One array of a file, checked. Raises the errors of `load`."""
    with zipfile.ZipFile(path) as archive, archive.open(name + SUFFIX) as stream:
        _require_plain(archive.getinfo(name + SUFFIX))
        return np.asarray(npy.read_array(stream, allow_pickle=False))


def checksums(path: str | Path) -> dict[str, tuple[str, int, int]]:
    """Name, size and checksum of each array of a file, by the name. Raises the errors of `load`.

    The size and the checksum are those of the array with its shape and type. Every byte is checked.
    """
    with zipfile.ZipFile(path) as archive:
        _check(archive)
        members = {one.filename.removesuffix(SUFFIX): one for one in archive.infolist()}
    return {name: (name, one.file_size, one.CRC) for name, one in members.items()}


def _require_plain(member: zipfile.ZipInfo) -> None:
    if member.compress_type != zipfile.ZIP_STORED:
        raise ValueError(f"{member.filename} is compressed")


def _array(
    path: str | Path, archive: zipfile.ZipFile, member: zipfile.ZipInfo, large: float
) -> NDArray[Any]:
    with archive.open(member) as stream:
        if member.file_size < large:
            return np.asarray(npy.read_array(stream, allow_pickle=False))
        shape, fortran, dtype = HEADERS[npy.read_magic(stream)](stream)
        header = stream.tell()
    if dtype.hasobject or math.prod(shape) * dtype.itemsize != member.file_size - header:
        raise ValueError("not an array of numbers")
    with open(path, "rb") as file:
        file.seek(member.header_offset + 26)
        name, extra = (int.from_bytes(file.read(2), "little") for _ in range(2))
    start = member.header_offset + 30 + name + extra + header
    return np.memmap(path, dtype, "r", start, shape, "F" if fortran else "C")
