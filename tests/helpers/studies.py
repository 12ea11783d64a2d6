"""The key that studies of the tests vary, and commands in this process."""

from __future__ import annotations

import pytest

from mesokit.cli import main

FORCE = "fluid.force.acceleration"


def said(capsys, *arguments) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as end:
        main([str(a) for a in arguments])
    out = capsys.readouterr()
    return int(end.value.code or 0), out.out, out.err
