"""The command line: every command is a few lines over the Python API.

What takes time to import is imported inside functions, so that Ctrl-C is understood at once.
"""

import contextlib
import os
import sys
from collections.abc import Sequence

from mesokit.processes.end import leave_at_once
from mesokit.processes.streams import outlive_readers


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line: one line on standard error and a status for whatever goes wrong.

    Exit status: 0 done, 1 the run failed, 2 the case or the command is wrong, 128 + its number
    stopped by a signal (130 Ctrl-C, 143 SIGTERM, 129 SIGHUP, 138 SIGUSR1).
    """
    _settle()
    try:
        from mesokit.cli.end import status_of

        status = status_of(arguments)
    except KeyboardInterrupt as stop:
        print("mesokit: interrupted", file=sys.stderr)
        status = getattr(stop, "status", 130)
    with contextlib.suppress(OSError):  # a full disk, reported where it can be: in the run's folder
        sys.stderr.flush()
    if arguments is None and status > 128:
        leave_at_once(status)
    raise SystemExit(status)


def _settle() -> None:
    """Make up for what the shell gives: streams that are closed, or know few letters, and settings
    of libraries that pictures and kernels could not be made with."""
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115  for ever
        elif hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")
    outlive_readers()
    os.environ["MPLBACKEND"] = "agg"  # there are no windows
    for name in ("NUMBA_DISABLE_JIT", "NUMBA_NUM_THREADS"):  # kernels have threads of their own
        os.environ.pop(name, None)
