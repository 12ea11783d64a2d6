"""Texts that commands print: tables, JSON, warnings and reasons of errors."""

import contextlib
import errno
import itertools
import json
import math
import os
import sysconfig
import threading
import traceback
import warnings
from collections.abc import Iterator, Sequence
from typing import Any

import mesokit

SILENT = 2.0  # seconds
READING = "reading the case"


def say(text: str) -> None:
    """Write a line on standard error, if it is open and has room."""
    import click

    with contextlib.suppress(OSError):
        click.echo(text, err=True)


@contextlib.contextmanager
def warnings_said() -> Iterator[None]:
    """Warnings of the Python API as lines on standard error."""

    def show(message: Warning | str, *where: object) -> None:
        say(f"warning: {message}")

    with warnings.catch_warnings():
        warnings.simplefilter("always", UserWarning)
        warnings.showwarning = show  # type: ignore[assignment]
        yield


@contextlib.contextmanager
def patience(why: str, quiet: bool = False) -> Iterator[None]:
    """Print why it takes so long, if it does and the command is not quiet."""
    timer = threading.Timer(SILENT, say, [f"mesokit: {why} ..."])
    timer.daemon = True
    if not quiet:
        timer.start()
    try:
        yield
    finally:
        timer.cancel()


def show_table(rows: Sequence[tuple[str, str, str]]) -> None:
    """Print rows in aligned columns."""
    import click
    from rich.cells import cell_len

    lengths = [[cell_len(text) for text in row] for row in rows]
    widths = [max(column) for column in zip(*lengths, strict=True)]
    for row, length in zip(rows, lengths, strict=True):
        gaps = (" " * (width - own + 2) for width, own in zip(widths, length, strict=True))
        click.echo("".join(itertools.chain(*zip(row, gaps, strict=True))).rstrip())


def in_json(record: object) -> str:
    """Plain numbers and texts as JSON; nan and infinity, which JSON has not, become null."""
    return json.dumps(_finite(record), indent=2, ensure_ascii=False)


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {str(key): _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def reason(error: OSError) -> str:
    """The reason of an error of the system, in a few words."""
    words = {errno.ENOSPC: "no space left on the disk"}
    if hasattr(errno, "EDQUOT"):
        words[errno.EDQUOT] = "disk quota exceeded"
    text = words.get(error.errno or 0) or error.strerror or str(error)
    name = f"{error.filename}: " if error.filename else ""
    return f"{name}{text[0].lower()}{text[1:]}" if text else repr(error)


def frames_of_parts(error: BaseException) -> list[traceback.FrameSummary]:
    """The calls of an error in files of parts that mesokit has called, the innermost last."""
    package = os.path.dirname(mesokit.__file__)
    others = [package, *(sysconfig.get_path(name) for name in ("stdlib", "purelib", "platlib"))]
    frames = traceback.extract_tb(error.__traceback__)
    called = itertools.dropwhile(lambda frame: not frame.filename.startswith(package), frames)
    return [frame for frame in called if not frame.filename.startswith((*others, "<"))]
