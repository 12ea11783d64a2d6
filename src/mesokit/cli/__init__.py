"""The command line: every command is a few lines over the Python API.

What takes time to import is imported inside functions, so that Ctrl-C is understood at once.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

TEMPLATES = ("poiseuille", "obstacle", "couette", "shear", "kolmogorov", "bulk")


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line: one line on standard error and a status for whatever goes wrong.

    Exit status: 0 done, 1 the run failed, 2 the case or the command is wrong, 130 interrupted.
    """
    try:
        from mesokit.cli.end import status_of

        status = status_of(arguments)
    except KeyboardInterrupt:
        print("mesokit: interrupted", file=sys.stderr)
        status = 130
    raise SystemExit(status)
