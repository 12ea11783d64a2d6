"""Where compiled kernels are kept: a folder of their own for each version of the sources.

Numba notices a change in a kernel's own file, not in the functions that it calls; the name of the
folder is a hash of all sources, so that nothing stale is ever run.
"""

from __future__ import annotations

import functools
import hashlib
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from numba import config, njit


@functools.cache
def folder() -> str:
    """NUMBA_CACHE_DIR, or a folder in the user's cache named after the sources."""
    if config.CACHE_DIR:
        return str(config.CACHE_DIR)
    root = Path(__file__).parent.parent
    code = hashlib.sha256()
    for path in sorted(root.rglob("*.py")):
        code.update(path.read_bytes())
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return str(Path(base) / "mesokit" / code.hexdigest()[:16])


def kernel(function: Callable) -> Any:
    """Compile a loop over particles or cells, and keep the result on disk.

    It takes (thread, threads, ...) and is run by all threads of a team at once.
    """
    before = config.CACHE_DIR
    config.CACHE_DIR = folder()
    try:
        return njit(nogil=True, cache=True, error_model="numpy", no_cfunc_wrapper=True)(function)
    finally:
        config.CACHE_DIR = before


def inner(function: Callable) -> Any:
    """A part of a kernel, compiled with it."""
    return njit(nogil=True, error_model="numpy", no_cfunc_wrapper=True, no_cpython_wrapper=True)(
        function
    )
