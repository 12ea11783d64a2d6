"""How wrong cases are refused."""

from __future__ import annotations

import pytest

from mesokit.cli import main


def refused(capsys: pytest.CaptureFixture[str], *arguments: str, status: int = 2) -> str:
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
