"""Loading or compiling the kernels of a run, which is said if it takes long."""

from __future__ import annotations

import contextlib
import sys
import threading
from collections.abc import Callable, Iterator

COMPILE_SECONDS = 0.7  # a first call that takes longer is compiling, not loading


@contextlib.contextmanager
def telling(tell: Callable[[], None]) -> Iterator[None]:
    """Call `tell` if what is done meanwhile takes long."""
    timer = threading.Timer(COMPILE_SECONDS, tell)
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


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
