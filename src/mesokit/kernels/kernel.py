"""Kernels: loops over particles or cells, which Python calls, made of parts.

A kernel is a function that calls one part, so that its own code is found in the store like all
other. Machine code of kernels is kept too, for one processor: a second start compiles nothing.
"""

import contextlib
import gc
import hashlib
import inspect
import itertools
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

from filelock import BaseFileLock, FileLock
from numba import njit, typeof
from numba.core.registry import CPUDispatcher, cpu_target

from mesokit.kernels import ahead
from mesokit.kernels.kept import counts, kept, versions
from mesokit.kernels.library import machine_code, make_ready, needs_below, processor, stages_of
from mesokit.kernels.made_of import Unknown, code_of, describe_type, digest
from mesokit.kernels.packing import all_packed
from mesokit.kernels.part import as_bytes, part, result_of
from mesokit.kernels.store import Code, Entry

PATIENCE = 300.0  # seconds: a process that was stopped holds no other up for ever


def taken(folder: str, name: str) -> BaseFileLock | None:
    """The lock of what has this name, once no other process has it.

    None where the file system has no locks, and after too long a wait: then all compile. The
    system takes the lock from a process that ends.
    """
    place = Path(folder) / "locks" / hashlib.sha256(name.encode()).hexdigest()[:32]
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
        lock = FileLock(place, timeout=PATIENCE)
        lock.acquire(poll_interval=0.02)
    except (OSError, NotImplementedError):  # Timeout is an OSError
        return None
    return lock


_used: set[str] | None = set()  # lines of all kernels of this process
_words: dict[tuple[str, ...], str] = {}  # the hash in such a line, by the rest of it


def needs_of_all() -> frozenset[str] | None:
    """Lines of all kernels that this process has found or made (see `made_of`); None where one of
    them cannot be kept."""
    return None if _used is None else frozenset(_used)


def _note_used(needs: frozenset[str] | None) -> None:
    global _used
    _used = None if needs is None or _used is None else _used | needs
    _words.update(map(_split, needs or ()))


def _split(need: str) -> tuple[tuple[str, ...], str]:
    what, place, word, *more = need.split(" ")
    return (what, place, *more), word


def inner(function: Callable) -> Any:
    """A part of a kernel, compiled with it."""
    return part(function, nogil=True)


def kernel(function: Callable) -> Any:
    """Compile a loop over particles or cells, and keep the result on disk.

    Those that take a `Worker` first are run by all its threads at once.
    """
    names = ", ".join(inspect.signature(function).parameters)
    space = {"body": inner(function), "__name__": function.__module__}
    exec(f"def {function.__name__}({names}):\n    return body({names})", space)
    made = njit(nogil=True, error_model="numpy", no_cfunc_wrapper=True)(space[function.__name__])
    made.py_func = made.source = function
    made.__class__, made._cache = _Kernel, _MachineCode(function)
    return made


class _Kernel(CPUDispatcher):
    """A kernel. While it is compiled, Python looks for garbage less often: numba makes little of it
    and much that stays, which would be looked through again and again."""

    def __call__(self, *arguments: Any) -> Any:
        return super().__call__(*all_packed(arguments))

    def compile_ahead(self, *arguments: Any) -> None:
        """Compile for arguments like these on another core, if that is needed and can be done."""
        given = tuple(map(typeof, all_packed(arguments)))
        if given not in self.overloads and not self._cache.has(given):
            ahead.begin(self, lambda: self.compile(given))

    def compile(self, sig: Any) -> Any:
        ahead.end(self)
        usual = gc.get_threshold()
        gc.set_threshold(20_000, 10, 1000)
        try:
            return super().compile(sig)
        finally:
            gc.set_threshold(*usual)
            self._cache.end_turn()


class _MachineCode:
    """Cache of numba: machine code of one kernel, for each signature."""

    cache_path = ""

    def __init__(self, function: Callable) -> None:
        self.function = function
        self._turn: BaseFileLock | None = None

    def load_overload(self, signature: Any, target: Any) -> Any:
        """The kernel for these types; None if there is none, and this process is to compile it."""
        key = self._key(signature)
        if key is None:
            return None
        found = self._found(key)
        if found is None:
            own = kept().own
            self._turn = taken(str(own.file.parent), key) if own is not None else None
            found = self._found(key)
        if found is not None:
            counts.kernels_found += 1
        return found

    def has(self, signature: Any) -> bool:
        """Whether the kernel for these types is kept."""
        key = self._key(signature)
        return key is not None and kept().find(key) is not None

    def end_turn(self) -> None:
        """Let other processes look for what was compiled here."""
        turn, self._turn = self._turn, None  # threads of this process may come here together
        if turn is not None:
            turn.release()
            with contextlib.suppress(OSError):  # a process that waits has it open
                Path(turn.lock_file).unlink()
            kept().note_used()

    def save_overload(self, signature: Any, compiled: Any) -> None:
        """Keep a compiled kernel."""
        counts.kernels_made += 1
        name = f"kernel {self.function.__module__}:{self.function.__qualname__}"
        key, below, library = self._key(signature), needs_below(compiled.library), compiled.library
        _note_used(below)
        stages = [stage.hash for stage in stages_of(library)]
        if key is None or below is None or compiled.reload_init or None in stages:
            counts.reasons[name] = "no other process would know a part of it again"
            return
        if counts.explains:
            counts.reasons[name] = kept().reason(key, name)
        compiled.fndesc.typemap = compiled.fndesc.calltypes = None
        module = library._final_module
        every = itertools.chain(module.functions, module.global_variables)
        names = [one.name for one in every if not one.is_declaration]
        others = compiled._find_referenced_environments()
        record = compiled.fndesc, compiled.environment, compiled.signature, names, others, stages
        code = Code(library.name, (), library._get_compiled_object())
        try:
            about = as_bytes(record)
        except Unknown:
            counts.reasons[name] = "a part of it cannot be copied"
            return
        entry = Entry(name, below, about, code.hash)
        kept().keep(key, lambda store: (entry, [code]))

    def flush(self) -> None:
        """Nothing is to be forgotten: what is no longer valid is not found."""

    def _key(self, signature: Any) -> str | None:
        place = f"{self.function.__module__}:{self.function.__qualname__}"
        try:
            given = [describe_type(kind) for kind in getattr(signature, "args", signature)]
            record = code_of(self.function), place, given, processor(), versions()
        except Unknown:
            return None
        return digest(repr(("kernel", *record)))

    def _found(self, key: str) -> Any:
        hit = kept().find(key)
        code = None if hit is None else kept().code(hit[0].code)
        if hit is None or code is None:
            return None
        # code here of something that was defined anew since: its names in machine code are the same
        if any(_words.get(rest, word) != word for rest, word in map(_split, hit[0].needs)):
            return None
        try:
            fndesc, environment, signature, names, others, stages = pickle.loads(hit[0].about)
        except Exception:  # what was kept does not fit, in any way: it is made anew
            return None
        context = cpu_target.target_context
        context.refresh()  # what machine code finds by name: numba does this before it compiles
        try:
            make_ready(stages)
        except LookupError:
            return None
        library = machine_code(code, names)
        _note_used(hit[0].needs)
        for one in others:
            library.codegen.set_env(one.env_name, one)
        entry = context.get_executable(library, fndesc, environment)
        return result_of(library, fndesc, signature, entry, environment)._replace(
            referenced_envs=others
        )
