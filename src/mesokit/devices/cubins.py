"""Kernels for chips, kept on disk beside those of the processor.

A kernel is known by the sources of mesokit, its arguments, its chip and the versions of compilers.
A process that finds one here loads no compiler of cards.
"""

import functools
import hashlib
import os
import sys
import tempfile
import zipfile
from collections.abc import Callable, Iterator
from importlib import metadata
from pathlib import Path
from typing import Any, NamedTuple

import mesokit
from mesokit.devices.compile import Chip, machine_of, text_of
from mesokit.kernels.made_of import describe_type
from mesokit.kernels.store import folder

COMPILERS = (
    "numba",
    "llvmlite",
    "numba-cuda",
    "nvidia-nvvm",
    "nvidia-nvjitlink",
    "nvidia-cuda-nvcc-cu12",
    "nvidia-nvjitlink-cu12",
)
TEXT, CUBIN, SAID = "kernel.ptx", "kernel.cubin", "assembler.txt"


class Made(NamedTuple):
    """A kernel: PTX, machine code, and what the assembler says of it."""

    ptx: str
    cubin: bytes
    said: str


def made(body: Callable, kinds: tuple[Any, ...], chip: Chip) -> Made:
    """The kernel of a body for a chip, found on disk or compiled and kept there."""
    key = _key(body, kinds, chip)
    file = None if key is None else folder() / "cuda" / f"{key}.zip"
    if file is not None and (found := _found(file)) is not None:
        return found
    ptx = text_of(body, kinds, chip)
    new = Made(ptx, *machine_of(ptx, chip))
    if file is not None:
        _keep(file, new)
    return new


def _found(file: Path) -> Made | None:
    try:
        with zipfile.ZipFile(file) as parts:
            text, said = (parts.read(name).decode() for name in (TEXT, SAID))
            return Made(text, parts.read(CUBIN), said)
    except (OSError, KeyError, zipfile.BadZipFile):  # none yet, or damaged: made anew
        return None


def _keep(file: Path, new: Made) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    handle, here = tempfile.mkstemp(dir=file.parent)
    os.close(handle)
    with zipfile.ZipFile(here, "w", zipfile.ZIP_DEFLATED) as parts:
        parts.writestr(TEXT, new.ptx)
        parts.writestr(CUBIN, new.cubin)
        parts.writestr(SAID, new.said)
    os.replace(here, file)


def _key(body: Callable, kinds: tuple[Any, ...], chip: Chip) -> str | None:
    """The name of a kernel on disk; None if no other process could know its sources."""
    if "<locals>" in body.__qualname__:
        return None
    place = body.__module__, body.__qualname__
    text = repr((place, [describe_type(kind) for kind in kinds], chip, _versions()))
    word = hashlib.sha256(text.encode() + _sources())
    modules = {body.__module__, *(kind.__module__ for kind in _classes(kinds))}
    for name in sorted(modules):
        if name.split(".")[0] == "mesokit":
            continue
        source = getattr(sys.modules.get(name), "__file__", None)
        if source is None:
            return None
        word.update(Path(source).read_bytes())
    return word.hexdigest()[:32]


@functools.cache
def _sources() -> bytes:
    word = hashlib.sha256()
    for file in sorted(Path(mesokit.__file__).parent.rglob("*.py")):
        word.update(file.read_bytes())
    return word.digest()


@functools.cache
def _versions() -> tuple[str, ...]:
    return tuple(map(_version, COMPILERS))


def _version(name: str) -> str:
    try:
        return f"{name} {metadata.version(name)}"
    except metadata.PackageNotFoundError:
        return f"{name} none"


def _classes(kinds: tuple[Any, ...]) -> Iterator[type]:
    """Classes of named tuples among the types of arguments."""
    for kind in kinds:
        if (named := getattr(kind, "instance_class", None)) is not None:
            yield named
        inner = getattr(kind, "types", ())
        yield from _classes(tuple(inner))
