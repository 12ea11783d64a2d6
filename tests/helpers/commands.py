"""Commands in this process: exit status and the one line of a refusal."""

from __future__ import annotations

from pathlib import Path

import pytest

from mesokit.cli import main

Captured = pytest.CaptureFixture[str]


ROOT = Path(__file__).parents[2]


SOURCE = str(ROOT / "src")


SMALL = """
[run]
steps = 20
[box]
size = [8, 8]
[fluid]
density = 4
[[observe]]
quantity = "conservation"
every = 2
"""


def ends(*arguments: str) -> int:
    """Exit status of a command."""
    with pytest.raises(SystemExit) as end:
        main([str(argument) for argument in arguments])
    return int(end.value.code or 0)


def refusal(capsys: Captured, *arguments: str, status: int = 2) -> str:
    """The one line that a wrong command ends with."""
    capsys.readouterr()
    assert ends(*arguments) == status
    captured = capsys.readouterr()
    assert captured.err.startswith("mesokit: error: ")
    assert captured.err.count("\n") == 1
    return captured.err
