"""Loading or compiling the kernels of a run, which is said if it takes long."""

import contextlib
import sys
import threading
from collections.abc import Callable, Iterator

from mesokit.kernels.kept import counts

SILENT = 0.7  # seconds


@contextlib.contextmanager
def telling(tell: Callable[[str], None]) -> Iterator[None]:
    """Call `tell` with what is done meanwhile, if it takes long, and again when that changes."""
    done, doing = threading.Event(), _doing()

    def look() -> None:
        said = ""
        while not done.wait(SILENT):
            words = doing()
            if words != said:
                tell(words)
            said = words

    threading.Thread(target=look, daemon=True).start()
    try:
        yield
    finally:
        done.set()


def _doing() -> Callable[[], str]:
    """What tells what has been done with kernels from now on."""
    made, parts, kernels = counts.parts_made, counts.parts_found, counts.kernels_found

    def words() -> str:
        if counts.parts_made > made or counts.compiles_ahead:
            return "compiling (once; kept for the next runs)"
        if counts.parts_found > parts:
            return "compiling from parts that are kept (once)"
        if counts.kernels_found > kernels:
            return "loading kernels"
        return "loading kernels, or waiting for another process that compiles them"

    return words


@contextlib.contextmanager
def swallowed(kind: type[BaseException]) -> Iterator[None]:
    """Exceptions of a kind that C code cannot hand on, such as the compiler's, are not written out
    where Python drops them."""
    earlier = sys.unraisablehook
    sys.unraisablehook = lambda told: None if isinstance(told.exc_value, kind) else earlier(told)
    try:
        yield
    finally:
        sys.unraisablehook = earlier
