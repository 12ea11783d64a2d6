"""Where compiled kernels are kept: a folder of their own for each version of the sources.

Numba notices a change in a kernel's own file, not in the functions that it calls; the name of the
folder is a hash of all sources that hold compiled code, so that nothing stale is ever run. Kernels
for parts from outside mesokit, such as a user's collision rule, lie in a folder within, named after
the sources of those parts: elsewhere nobody could read them where the parts are not installed.
"""

from __future__ import annotations

import functools
import gc
import hashlib
import os
import sys
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

from numba import config, njit
from numba.core.caching import FunctionCache
from numba.core.registry import CPUDispatcher

from mesokit.scalar.one_compiles import released, taken
from mesokit.scalar.part import part

COMPILED = ("scalar", "case", "geometry", "potential", "spheres", "method", "execute")


@functools.cache
def folder() -> str:
    """The folder named after the sources, in NUMBA_CACHE_DIR or the user's cache."""
    base = config.CACHE_DIR or os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return str(Path(base) / "mesokit" / digest(Path(__file__).parent.parent))


def digest(root: Path) -> str:
    """A word for the state of all files of a package that kernels may be made of, whatever they
    import: one may register what another has named."""
    code = hashlib.sha256()
    for path in sorted(path for name in COMPILED for path in (root / name).rglob("*.py")):
        code.update(str(path.relative_to(root)).encode() + path.read_bytes())
    return code.hexdigest()[:16]


def kernel(function: Callable) -> Any:
    """Compile a loop over particles or cells, and keep the result on disk.

    Those that take a `Team` first are run by all its threads at once.
    """
    made = njit(nogil=True, error_model="numpy", no_cfunc_wrapper=True)(function)
    made.__class__ = _Kernel
    made._cache = KernelFiles(function)
    return made


class _Kernel(CPUDispatcher):
    """A kernel. While it is compiled, Python looks for garbage less often: numba makes little of it
    and much that stays, which would be looked through again and again."""

    def compile(self, sig: Any) -> Any:
        usual = gc.get_threshold()
        gc.set_threshold(20_000, 10, 1000)
        try:
            return super().compile(sig)
        finally:
            gc.set_threshold(*usual)
            self._cache.end_turn()


def inner(function: Callable) -> Any:
    """A part of a kernel, compiled with it."""
    return part(function, nogil=True)


class KernelFiles:
    """What numba asks of a cache, for one kernel: files in a folder by whose parts are in it."""

    def __init__(self, function: Callable) -> None:
        self.function = function
        self.caches: dict[str, FunctionCache] = {}
        self._turn: Any = None

    @property
    def cache_path(self) -> str:
        """The folder of kernels without parts from outside."""
        return folder()

    def load_overload(self, signature: Any, target: Any) -> Any:
        """The compiled kernel for these types; None if there is none, and it is for this process to
        compile it."""
        cache = self._cache(signature)
        if cache is None:
            return None
        found = cache.load_overload(signature, target)
        if found is None:
            self._turn = taken(cache.cache_path, f"{self.function.__qualname__} {signature}")
            found = cache.load_overload(signature, target)
        return found

    def end_turn(self) -> None:
        """Let others look for what was compiled here."""
        released(self._turn)
        self._turn = None

    def save_overload(self, signature: Any, compiled: Any) -> None:
        """Keep a compiled kernel."""
        cache = self._cache(signature)
        if cache is not None:
            lock = taken(cache.cache_path, self.function.__qualname__)  # two at once would lose one
            try:
                cache.save_overload(signature, compiled)
            finally:
                released(lock)

    def flush(self) -> None:
        """Forget what is on disk."""
        for cache in self.caches.values():
            cache.flush()

    def _cache(self, signature: Any) -> FunctionCache | None:
        outside = {c for c in classes(signature) if c.__module__.split(".")[0] != "mesokit"}
        if any(c.__module__ == "__main__" or "<locals>" in c.__qualname__ for c in outside):
            return None  # no other process could tell that these are the same classes
        place = folder()
        if outside:
            place = str(Path(place) / sources({c.__module__ for c in outside}))
        if place not in self.caches:
            before, config.CACHE_DIR = config.CACHE_DIR, place
            try:
                self.caches[place] = FunctionCache(self.function)
            finally:
                config.CACHE_DIR = before
        return self.caches[place]


def classes(types: Iterable[Any]) -> Iterator[type]:
    """The classes of all NamedTuples among the types of arguments."""
    for kind in types:
        if hasattr(kind, "instance_class"):
            yield kind.instance_class
        if hasattr(kind, "types"):
            yield from classes(kind.types)
        elif hasattr(kind, "dtype") and hasattr(kind, "count"):  # a tuple of equal types
            yield from classes((kind.dtype,))


def sources(modules: set[str]) -> str:
    """A hash of modules, and of all loaded ones beside or below them, wherever they lie.

    Packages have a folder of their own; a module that lies beside all others stands for itself.
    """
    files = {name: getattr(module, "__file__", None) for name, module in list(sys.modules.items())}
    near = {os.path.dirname(os.path.abspath(files[name] or "")) for name in modules}
    near = {path for path in near if not path.endswith("site-packages")}
    code = hashlib.sha256()
    for name, path in sorted(files.items()):
        beside = any((path or "").startswith(f"{folder}{os.sep}") for folder in near)
        if name in modules or (beside and str(path).endswith(".py")):
            code.update(name.encode() + (Path(path).read_bytes() if path else b""))
    return code.hexdigest()[:16]
