"""Parts of a kernel: what only other compiled code calls, compiled once and kept as bitcode.

Numba makes machine code, and a wrapper that Python can call, of each function that it compiles.
Here most functions are small and are inlined into the loop that calls them, so that both would be
thrown away. A part is translated as any other function, and kept for linking alone: in this
process, and in the store, where every process and every kernel finds it again. No processor matters
to it, since loops are made fit for one after linking.

A stage is a part that is not put together with what calls it: it has machine code of its own, made
and kept once for all kernels that call it, which find it by its name.
"""

import itertools
import os
import pickle
from collections.abc import Callable
from typing import Any

from numba import njit
from numba._dynfunc import make_function
from numba.core import typed_passes, untyped_passes
from numba.core.bytecode import FunctionIdentity
from numba.core.compiler import Compiler, CompileResult, compile_result
from numba.core.compiler_machinery import register_pass
from numba.core.environment import Environment
from numba.core.registry import CPUDispatcher, cpu_target
from numba.core.serialize import dumps

from mesokit.kernels import quicker  # noqa: F401  what numba compiles is compiled sooner
from mesokit.kernels.kept import counts, kept, version_line, versions
from mesokit.kernels.library import STAGE, PartLibrary, StageLibrary, loaded, missing, needs_below
from mesokit.kernels.made_of import Unknown, code_of, describe_type, digest, needs_of
from mesokit.kernels.store import Code, Entry, Store

# What numba does to functions that use these: array expressions as a whole, `with`, closures,
# `literal_unroll` and `literally`.
SKIPPED = {
    untyped_passes.WithLifting,
    untyped_passes.RewriteDynamicRaises,
    untyped_passes.FindLiterallyCalls,
    untyped_passes.LiteralUnroll,
    untyped_passes.LiteralPropagationSubPipelinePass,
    typed_passes.NopythonRewrites,
    typed_passes.NoPythonSupportedFeatureValidation,
    typed_passes.DumpParforDiagnostics,
}


# --- names of functions in machine code -----------------------------------------------------------

_identity = FunctionIdentity.from_function
_compiling = [f"process {os.urandom(16).hex()}"]  # keys of the parts that are being compiled
_numbers = itertools.count()
_unknown = itertools.count()  # parts without a key
_here: dict[str, Any] = {}  # hashes of the parts of this process by key: a name is for one code


def _identified(cls: type, function: Any) -> Any:
    """Numba's name of a function, with a number that depends on what is compiled.

    Numba counts the functions of a process: two of two processes could have one name, and be linked
    in place of each other. A part has the number of its key, which names its code and types; what
    numba compiles for it has one made of that key and its own name.
    """
    made = _identity(function)
    text = f"{_compiling[-1]} {made.modname} {made.func_qualname} {next(_numbers)}"
    made.unique_id = int(digest(text)[:14], 16)
    made.unique_name = f"{made.func_qualname}${made.unique_id}"
    return made


FunctionIdentity.from_function = classmethod(_identified)


# --- compiling ------------------------------------------------------------------------------------


@register_pass(mutates_CFG=True, analysis_only=False)
class _Lowering(typed_passes.NativeLowering):
    _name = "lowering of a part"
    kind, begins = PartLibrary, ""

    def run_pass(self, state: Any) -> bool:
        library = self.kind(state.targetctx.codegen(), self.begins + state.func_id.func_qualname)
        flags, state.library, state.flags = state.flags, library, state.flags.copy()
        state.flags.no_compile = True
        super().run_pass(state)
        state.flags = flags
        made, about = state["cr"], state["cr"].fndesc
        entry = _known_to_numba(library, about, made.env)
        state.reload_init.extend(library._reload_init)
        state["cr"] = made._replace(cfunc=entry)
        return True


@register_pass(mutates_CFG=True, analysis_only=False)
class _LoweringOfStage(_Lowering):
    _name = "lowering of a stage"
    kind, begins = StageLibrary, STAGE


def _known_to_numba(library: Any, about: Any, environment: Any) -> Any:
    """Numba's object for a compiled function, which Python could call; it leads nowhere."""
    name = about.qualname.split(".")[-1]
    entry = make_function(about.lookup_module(), name, "", 0, environment, (library,))
    cpu_target.target_context.insert_user_function(entry, about, [library])
    return entry


class PartCompiler(Compiler):
    """Numba's passes without those that parts have no use for; what is kept needs none of them."""

    lowering: Any = _Lowering

    def define_pipelines(self) -> list:
        """The passes in order."""
        [passes] = super().define_pipelines()
        kept, pruned = [], False
        for one, why in passes.passes:
            if one in SKIPPED or (one is untyped_passes.DeadBranchPrune and pruned):
                continue
            pruned |= one is untyped_passes.DeadBranchPrune
            kept.append((self.lowering if one is typed_passes.NativeLowering else one, why))
        passes.passes[:] = kept
        passes._finalized = False
        passes.finalize()
        return [passes]

    def compile_extra(self, func: Any) -> Any:
        """Find the part, or compile and keep it."""
        key = self._key(func)
        found = None if key is None else _found(key)
        if found and _here.setdefault(key or "", found.library.hash) == found.library.hash:
            counts.parts_found += 1
            return found
        again = key in _here  # and other than before, as what it contains was defined anew
        counts.parts_made += 1
        if key is not None and counts.explains:
            name = f"{func.__module__}:{func.__qualname__}"
            counts.reasons[f"part {name}"] = kept().reason(key, name)
        global _numbers
        outer, _numbers = _numbers, itertools.count()
        known = None if again else key
        _compiling.append(known or f"{_compiling[0]} {next(_unknown)}")
        try:
            made = super().compile_extra(func)
        finally:
            _compiling.pop()
            _numbers = outer
        if known is not None:
            _keep(known, func, made)
            _here[known] = made.library.hash
        return made

    def _key(self, function: Any) -> str | None:
        """The key of a part; None if no other process could recognise it."""
        state = self.state
        try:
            given = [describe_type(kind) for kind in state.args]
            answer = "" if state.return_type is None else describe_type(state.return_type)
            record = (
                code_of(function),
                given,
                answer,
                str(state.flags),
                str(state.locals),
                versions(),
            )
        except Unknown:
            return None
        return digest(repr((self.lowering._name, *record)))


class StageCompiler(PartCompiler):
    """The same for stages."""

    lowering = _LoweringOfStage


def _found(key: str) -> CompileResult | None:
    hit = kept().find(key)
    if hit is None:
        return None
    try:
        library = loaded(hit[0].code)
        fndesc, signature = pickle.loads(hit[0].about)
    except Exception:  # what was kept does not fit, in any way: it is made anew
        return None
    library.needs = hit[0].needs
    environment = Environment.from_fndesc(fndesc)
    entry = _known_to_numba(library, fndesc, environment)
    return result_of(library, fndesc, signature, entry, environment)


def result_of(library: Any, fndesc: Any, signature: Any, entry: Any, environment: Any) -> Any:
    """Numba's record of a compilation, for code that was kept."""
    return compile_result(
        typing_context=cpu_target.typing_context,
        target_context=cpu_target.target_context,
        entry_point=entry,
        typing_error=None,
        signature=signature,
        library=library,
        environment=environment,
        lifted=(),
        fndesc=fndesc,
        objectmode=False,
        reload_init=(),
        referenced_envs=(),
        metadata={},
    )


def as_bytes(record: Any) -> bytes:
    """Pickle what numba needs to load compiled code. Classes are named, and not copied: those of
    a script that is run again are the same. Raises Unknown for what cannot be copied either, such
    as functions that a notebook puts in place of those of Python."""
    try:
        return pickle.dumps(record)
    except Exception:  # something that has no name
        try:
            return dumps(record)
        except Exception as error:
            raise Unknown(str(error)) from error


def _keep(key: str, function: Any, made: Any) -> None:
    library, below = made.library, needs_below(made.library)
    if below is None or library._reload_init:
        return
    made.fndesc.typemap = made.fndesc.calltypes = None
    try:
        library.needs = below | {version_line(), *needs_of(function)}
        about = as_bytes((made.fndesc, made.signature))
    except Unknown:
        return
    name = f"{function.__module__}:{function.__qualname__}"

    def entry(store: Store) -> tuple[Entry, list[Code]]:
        found: dict[str, Code] = {}
        hash = missing(library, store, found)
        return Entry(name, library.needs, about, hash), list(found.values())

    kept().keep(key, entry)


# --- declaring parts ------------------------------------------------------------------------------


class _Part(CPUDispatcher):
    """A part; called from Python, it is compiled once more in numba's usual way."""

    is_part = True

    def __call__(self, *arguments: Any) -> Any:
        if "_called" not in vars(self):
            self._called = njit(error_model="numpy", no_cfunc_wrapper=True)(self.py_func)
        return self._called(*arguments)


OPTIONS = {
    "error_model": "numpy",
    "no_cfunc_wrapper": True,
    "no_cpython_wrapper": True,
    "pipeline_class": PartCompiler,
}


def part(function: Callable, **options: bool) -> Any:
    """Compile a function that compiled code calls; from Python it can be called too."""
    made = njit(**OPTIONS, **options)(function)
    made.__class__ = _Part
    return made


def stage(function: Callable) -> Any:
    """Compile a part with machine code of its own, which all kernels that call it share."""
    made = njit(**OPTIONS | {"pipeline_class": StageCompiler}, nogil=True, _nrt=False)(function)
    made.__class__ = _Part
    return made
