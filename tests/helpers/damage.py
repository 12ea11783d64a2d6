"""Kinds of damage to files of a run, and what commands say of it."""

from __future__ import annotations

from pathlib import Path

import pytest

from mesokit.cli import main

CASE = """
[run]
steps = 20
[box]
size = [8, 8]
[fluid]
density = 10
[[observe]]
quantity = "conservation"
every = 2
[trajectory]
every = 5
"""


ANEW = "mesokit run run/case.toml --output run --overwrite"


SOURCE = str(Path(__file__).parents[2] / "src")


def contents(folder: Path) -> dict[str, bytes]:
    return {str(p): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def refusal(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    capsys.readouterr()
    with pytest.raises(SystemExit) as end:
        main(list(arguments))
    assert end.value.code in (1, 2)
    captured = capsys.readouterr()
    assert captured.err.startswith("mesokit: error: ")
    assert captured.err.count("\n") == 1
    return captured.err


def truncated(data: bytes) -> bytes:
    return data[: len(data) // 2]


def flipped(data: bytes) -> bytes:
    middle = len(data) // 2
    return data[:middle] + bytes(255 - b for b in data[middle : middle + 64]) + data[middle + 64 :]


def flipped_anywhere(data: bytes) -> bytes:
    """Whole at its start and of the right length, nonsense from there on."""
    return data[:2048] + bytes(255 - b for b in data[2048:])


def empty(data: bytes) -> bytes:
    return b""


def main_ends(arguments: list[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main(arguments)
    assert not end.value.code
