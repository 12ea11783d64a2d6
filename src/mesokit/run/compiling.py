"""Messages while kernels of a run are loaded or compiled, if that takes long."""

import contextlib
import sys
import threading
from collections.abc import Callable, Iterator

from mesokit.kernels.kept import counts

SILENT = 0.7  # seconds


@contextlib.contextmanager
def telling(tell: Callable[[str], None]) -> Iterator[None]:
    """Call `tell` with the present activity, if it takes long, and again when it changes."""
    done = threading.Event()
    made, parts, kernels = counts.parts_made, counts.parts_found, counts.kernels_found

    def doing() -> str:
        if counts.parts_made > made or counts.compiles_ahead:
            return "compiling (once; kept for the next runs)"
        if counts.parts_found > parts:
            return "compiling from parts that are kept (once)"
        if counts.kernels_found > kernels:
            return "loading kernels"
        return "loading kernels, or waiting for another process that compiles them"

    def look() -> None:
        last = ""
        while not done.wait(SILENT):
            if (words := doing()) != last:
                tell(words)
            last = words

    threading.Thread(target=look, daemon=True).start()
    try:
        yield
    finally:
        done.set()


@contextlib.contextmanager
def swallowed(kind: type[BaseException]) -> Iterator[None]:
    """Do not print exceptions of a kind that Python drops because C code, such as the compiler,
    cannot pass them on."""
    earlier = sys.unraisablehook
    sys.unraisablehook = lambda told: None if isinstance(told.exc_value, kind) else earlier(told)
    try:
        yield
    finally:
        sys.unraisablehook = earlier
