"""How wrong cases are refused."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

import pytest

from mesokit.cli import main


def changed(text: str, changes: Mapping[str, str], count: int = -1) -> str:
    """A case with each old text replaced by the new one; new lines at its end replace nothing."""
    for old, new in changes.items():
        assert old in text, old
        text = text.replace(old, new, count) if old else f"{text}\n{new}\n"
    return text


def has_words(message: str, words: Iterable[str]) -> None:
    """Assert that a message is one line in which all these words stand."""
    assert message.strip() and "\n" not in message.strip(), message
    assert not [word for word in words if word not in message], message


def refused(capsys: pytest.CaptureFixture[str], *arguments: str | Path, status: int = 2) -> str:
    """The one line that the command ends with."""
    with pytest.raises(SystemExit) as end:
        main(list(map(str, arguments)))
    captured = capsys.readouterr()
    assert end.value.code == status
    assert captured.out == ""
    assert captured.err.startswith("mesokit: error: ")
    assert captured.err.count("\n") == 1
    assert "Traceback" not in captured.err
    return captured.err
