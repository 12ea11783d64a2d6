"""Loading or compiling the kernels of a run, which is said if it takes long."""

from __future__ import annotations

import contextlib
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
