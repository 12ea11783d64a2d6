"""The stores that a process uses: the user's own, and the one that came with the package.

Nothing that is wrong with a store ends a run: what is not found is compiled.
"""

from __future__ import annotations

import contextlib
import functools
import os
import platform
import sqlite3
import sys
import sysconfig
import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import llvmlite
import numba
import numpy
from numba import config

from mesokit.kernels.made_of import digest, named, still_holds
from mesokit.kernels.store import Code, Entry, Store, clear, store_file

HERE = Path(__file__).parent


class Counts:
    """Counts of what this process has made and found, and why it was made."""

    def __init__(self, explains: bool = False) -> None:
        self.parts_made = self.stages_made = self.kernels_made = 0
        self.parts_found = self.stages_found = self.kernels_found = 0
        self.compiles_ahead = 0  # children of this process that compile for it
        self.explains = explains  # whether reasons are looked for, which takes time
        self.reasons: dict[str, str] = {}  # by the name of what was made

    def add_made(self, other: Counts) -> None:
        """Count what another process made for this one."""
        for name in ("parts_made", "stages_made", "kernels_made"):
            setattr(self, name, getattr(self, name) + getattr(other, name))
        self.reasons.update(other.reasons)


counts = Counts()


@functools.cache
def versions() -> str:
    """A word, part of every key, for all else that machine code depends on."""
    names = [
        *("made_of", "later", "library", "part", "group", "packing", "kernel", "quicker"),
        "../scalar/jit",
    ]
    sources = "".join((HERE / f"{name}.py").read_text(encoding="utf-8") for name in names)
    options = "OPT LOOP_VECTORIZE SLP_VECTORIZE BOUNDSCHECK DEBUGINFO_DEFAULT LLVM_REFPRUNE_PASS"
    settings = [str(getattr(config, option)) for option in options.split()]
    return digest(" ".join([era(), sources, *settings]))


def version_line() -> str:
    """The same as a line of what a part needs."""
    return f"version mesokit:kernels {versions()}"


def era() -> str:
    """Versions of what compiles, and the architecture, for the name of a file of parts.

    Of NumPy the first two numbers: numba's functions of arrays are written for these.
    """
    python = f"{sys.implementation.name}{sys.version_info.major}{sys.version_info.minor}"
    system = f"{sysconfig.get_platform().split('-')[0]}-{platform.machine()}"
    arrays = ".".join(numpy.__version__.split(".")[:2])
    return (
        f"numba{numba.__version__}-llvmlite{llvmlite.__version__}-numpy{arrays}-{python}-{system}"
    )


def shipped_file() -> Path:
    """Where the package has its file of parts for these versions, if it brings one."""
    return HERE / "shipped" / f"{era()}.sqlite"


class Kept:
    """The stores of one process: the user's own, and the one that came with the package.

    Threads use them one at a time.
    """

    def __init__(self) -> None:
        self.process = os.getpid()
        self._one_thread = threading.RLock()
        self.trouble = ""  # why the user's own store is not used
        self.own: Store | None = None
        self.stores: list[Store] = []
        with self._without_own():
            self.own = _sound(store_file())
            self.stores = [self.own]
        self.shipped: Store | None = None
        with contextlib.suppress(sqlite3.Error, OSError):
            if shipped_file().exists():
                self.shipped = Store(shipped_file(), writes=False)
                self.stores.append(self.shipped)

    @contextlib.contextmanager
    def _without_own(self) -> Iterator[None]:
        """Go on without the user's own store if something is wrong with it."""
        try:
            with self._one_thread:
                yield
        except Exception as error:
            self.trouble = str(error) or type(error).__name__
            self.stores = [store for store in self.stores if store is not self.own]
            self.own = None
            if not _is_busy(error):  # damaged: it is begun anew
                with contextlib.suppress(OSError, sqlite3.Error):
                    clear()
                    self.own = _sound(store_file())
                    self.stores.insert(0, self.own)

    @contextlib.contextmanager
    def _reading(self, store: Store) -> Iterator[None]:
        """Treat a damaged store as an empty one."""
        if store is self.own:
            with self._without_own():
                yield
        else:
            with contextlib.suppress(Exception), self._one_thread:  # damaged, in any way
                yield

    def find(self, key: str) -> tuple[Entry, Store] | None:
        """A valid entry of a key."""
        for store in tuple(self.stores):
            with self._reading(store):
                for entry in store.find(key):
                    if all(map(still_holds, entry.needs)):
                        return entry, store
        return None

    def reason(self, key: str, name: str) -> str:
        """Why there is no valid entry of a key, in a line."""
        known = False
        for store in self.stores:
            with contextlib.suppress(sqlite3.Error, ValueError), self._one_thread:
                for entry in store.find(key):
                    for need in sorted(entry.needs):
                        if not still_holds(need):
                            return f"{named(need)} has changed"
                known |= store.has_name(name)
        if known:
            return "its code, the types of its arguments, or a version is another than before"
        return "it was not made before"

    def code(self, hash: str) -> Code | None:
        """Code by its hash, of any store."""
        for store in tuple(self.stores):
            with self._reading(store):
                found = store.code(hash)
                if found is not None:
                    return found
        return None

    def keep(self, key: str, made: Callable[[Store], tuple[Entry, list[Code]]]) -> None:
        """Add an entry to the user's own store, with the code that is missing there."""
        if self.own is None or not self.own.writes:
            return
        with self._without_own():
            self.own.keep(key, *made(self.own))

    def note_used(self) -> None:
        """Write down what was used, once compiling is done."""
        if self.own is not None:
            with self._without_own():
                self.own.note_used()


def _is_busy(error: Exception) -> bool:
    """Whether a store is locked, full or out of reach, and not damaged."""
    # a text that is none; tables of another program
    damaged = any(words in str(error) for words in ("decode", "no such", "has no column"))
    return isinstance(error, (sqlite3.OperationalError, OSError, RuntimeError)) and not damaged


def _sound(file: Path) -> Store:
    """An opened store. Raises sqlite3.Error where it is none."""
    store = Store(file)
    store.counts()
    return store


_now: list[Kept] = []


def kept() -> Kept:
    """The stores of this process; a child of it opens its own."""
    if not _now or _now[0].process != os.getpid():
        _now[:] = [Kept()]
    return _now[0]


def forget() -> None:
    """Open the stores anew when they are next needed."""
    _now.clear()
