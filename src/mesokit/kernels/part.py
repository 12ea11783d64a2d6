"""Parts of a kernel: what only other compiled code calls, compiled once and kept as bitcode.

Numba makes machine code, and a wrapper that Python can call, of each function that it compiles.
Here most functions are small and are inlined into the loop that calls them, so that both would be
thrown away. A part is translated as any other function, and kept for linking alone: in this
process, and in the store, where every process and every kernel finds it again. No processor matters
to it, since loops are made fit for one after linking.

A stage is a part that is not put together with what calls it: it has machine code of its own, made
and kept once for all kernels that call it, which find it by its name.
"""

from __future__ import annotations

import itertools
import os
import pickle
import weakref
from collections.abc import Callable, Iterable
from typing import Any

import llvmlite.binding as llvm
from llvmlite.binding import Linkage
from numba import njit
from numba._dynfunc import make_function
from numba.core import typed_passes, untyped_passes
from numba.core.bytecode import FunctionIdentity
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler, CompileResult
from numba.core.compiler_machinery import register_pass
from numba.core.environment import Environment
from numba.core.registry import CPUDispatcher, cpu_target
from numba.core.serialize import dumps

from mesokit.kernels.kept import counts, kept, versions
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


def _identified(cls: type, function: Any) -> Any:
    """Numba's name of a function, with a number that depends on what is compiled.

    Numba counts the functions of a process: two of two processes could have one name, and be linked
    in place of each other. A part has the number of its key, which tells its code and types; what
    numba compiles for it has one made of that key and its own name.
    """
    made = _identity(function)
    text = f"{_compiling[-1]} {made.modname} {made.func_qualname} {next(_numbers)}"
    return _numbered(made, text)


def _numbered(identity: Any, text: str) -> Any:
    identity.unique_id = int(digest(text)[:14], 16)
    identity.unique_name = f"{identity.func_qualname}${identity.unique_id}"
    return identity


FunctionIdentity.from_function = classmethod(_identified)


# --- libraries ------------------------------------------------------------------------------------


def processor() -> str:
    """What machine code is made for."""
    return digest(str(cpu_target.target_context.codegen().magic_tuple()))


class PartLibrary(JITCodeLibrary):
    """The code of one part, which is put together with that of others in the kernel, once.

    `needs` are the lines of all functions in it (see `made_of`), None where no other process could
    recognise one; `hash` is that of its code in the store.
    """

    needs: frozenset[str] | None = None
    hash: str | None = None
    _together: Any = None  # with all that it calls
    _body: bytes | None = None  # bitcode that is not read yet

    def finalize(self) -> None:
        self._raise_if_finalized()
        for function in self._final_module.functions:
            if not function.is_declaration and function.linkage == Linkage.external:
                function.linkage = "linkonce_odr"  # several kernels have it
        for library in self._linking_libraries:
            self._reload_init.update(library._reload_init)
        self._finalize_dynamic_globals()
        self._finalized = True

    def _optimize_functions(self, ll_module: Any) -> None:
        """As numba does, but for what is only declared: most functions of a small part."""
        ll_module.data_layout = self._codegen._data_layout
        for function in ll_module.functions:
            if not function.is_declaration:
                passes, builder = self._codegen._function_pass_manager()
                passes.run(function, builder)

    def _get_module_for_linking(self) -> Any:
        if self._together is None:
            for stage in stages_of(self):
                stage.make_ready()
            self._together = _linked(self)
        return self._together


STAGE = "stage "  # how names of their libraries begin


class StageLibrary(PartLibrary):
    """The code of a stage, and its machine code."""

    _ready: Any = None  # what numba knows its machine code by

    def make_ready(self) -> None:
        """Have its machine code in this process."""
        if self._ready is None:
            if self.hash is not None:
                self._ready = _ready.get(self.hash) or _found_ready(self.hash)
            self._ready = self._ready or self._compiled()

    def _compiled(self) -> Any:
        below = stages_of(self)
        for stage in below:
            stage.make_ready()
        made = self._codegen.create_library(self.name)
        made.enable_object_caching()
        made._final_module = _linked(self)
        for name in _defined(_own_module(self)):
            made._final_module.get_function(name).linkage = "external"
        made.finalize()
        counts.stages_made += 1
        hashes = [stage.hash for stage in below]
        if self.hash is not None and None not in hashes:
            _ready[self.hash] = made
            told = pickle.dumps((_defined(made._final_module), hashes))
            code = Code(self.name, (), made._get_compiled_object())
            entry = Entry(f"kernel {self.name}", frozenset(), told, code.hash)
            kept().keep(_key_of_stage(self.hash), lambda store: (entry, [code]))
        return made


_ready: dict[str, Any] = {}  # machine code of stages in this process, by the hash of their code


def _key_of_stage(hash: str) -> str:
    return digest(f"stage {hash} {processor()} {versions()}")


def _found_ready(hash: str) -> Any:
    """The machine code of a stage that is kept, with that of all that it calls; else None."""
    hit = kept().find(_key_of_stage(hash))
    code = None if hit is None else kept().code(hit[0].code)
    if hit is None or code is None:
        return None
    try:
        names, below = pickle.loads(hit[0].about)
        make_ready(below)
    except Exception:  # what was kept does not fit, in any way: it is made anew
        return None
    counts.stages_found += 1
    _ready[hash] = machine_code(code, names)
    return _ready[hash]


def make_ready(hashes: Iterable[str]) -> None:
    """Have the machine code of stages in this process. Raises LookupError where one is missing."""
    for hash in hashes:
        if hash not in _ready and _found_ready(hash) is None:
            _loaded(hash).make_ready()


def machine_code(code: Code, names: Iterable[str]) -> Any:
    """Kept machine code, and the names in it, brought into this process."""
    codegen = cpu_target.target_context.codegen()
    library = codegen.create_library(code.name)
    library.enable_object_caching()
    library._set_compiled_object(code.body)
    library._finalize_final_module()
    codegen._engine._defined_symbols.update(names)
    return library


def _defined(module: Any) -> list[str]:
    """Names of the functions that are in a module."""
    return [function.name for function in module.functions if not function.is_declaration]


def _linked(library: Any) -> Any:
    """The code of a part with that of all that it calls, but stages."""
    together = _own_module(library).clone()
    for called in _called_by(library):
        together.link_in(_own_module(called), preserve=True)
    return together


def stages_of(library: Any) -> list[Any]:
    """The stages that a library calls, itself or in its parts."""
    found: dict[Any, None] = {}
    seen: set[Any] = set()

    def visit(library: Any) -> None:
        for called in library._linking_libraries:
            if isinstance(called, StageLibrary):
                found[called] = None
            elif isinstance(called, PartLibrary) and called not in seen:
                seen.add(called)
                visit(called)

    visit(library)
    return list(found)


def _called_by(library: Any) -> list[Any]:
    """What a part calls, what that calls, and so on: each once, and after all that call it, as LLVM
    leaves out what nothing has named yet."""
    order: dict[Any, None] = {}

    def visit(library: Any) -> None:
        for called in library._linking_libraries if isinstance(library, PartLibrary) else ():
            if called not in order and not isinstance(called, StageLibrary):
                visit(called)
        order[library] = None

    visit(library)
    return list(order)[-2::-1]


def _own_module(library: Any) -> Any:
    """The code of a part alone, or whatever numba links of what is its own."""
    if not isinstance(library, PartLibrary):
        return library._get_module_for_linking()
    if library._body is not None:
        library._final_module, library._body = llvm.parse_bitcode(library._body), None
    library._ensure_finalized()
    return library._final_module


def needs_below(library: Any) -> frozenset[str] | None:
    """Lines of all parts that a library calls; None where one of them cannot be kept."""
    found: set[str] = set()
    for called in library._linking_libraries:
        if isinstance(called, PartLibrary):
            if called.needs is None:
                return None
            found |= called.needs
    return frozenset(found)


_libraries: weakref.WeakValueDictionary[str, Any] = weakref.WeakValueDictionary()  # by hash


def _missing(library: Any, store: Store, found: dict[str, Code]) -> str:
    """The hash of a library; code of it, or of what it calls, is noted where a store lacks it."""
    known = getattr(library, "hash", None)
    if known is not None and (known in found or store.has_code(known)):
        return known
    called: tuple[str, ...] = ()
    if isinstance(library, PartLibrary):
        below = dict.fromkeys(library._linking_libraries)
        called = tuple(_missing(one, store, found) for one in below)
    code = Code(library.name, called, _own_module(library).as_bitcode())
    found[code.hash], library.hash = code, code.hash
    _libraries[code.hash] = library
    return code.hash


def _loaded(hash: str) -> Any:
    """The library of kept code, with all it calls. Raises LookupError where some is missing."""
    if hash in _libraries:
        return _libraries[hash]
    code = kept().code(hash)
    if code is None:
        raise LookupError(hash)
    kind = StageLibrary if code.name.startswith(STAGE) else PartLibrary
    library = kind(cpu_target.target_context.codegen(), code.name)
    library._linking_libraries = [_loaded(one) for one in code.called]
    library._body, library._finalized, library.hash = code.body, True, hash
    _libraries[hash] = library
    return library


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
    """What numba knows a compiled function by: an object that Python could call, which leads
    nowhere."""
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
        found = key and _found(key)
        if found:
            counts.parts_found += 1
            return found
        counts.parts_made += 1
        if key is not None and counts.explains:
            name = f"{func.__module__}:{func.__qualname__}"
            counts.reasons[f"part {name}"] = kept().reason(key, name)
        global _numbers
        outer, _numbers = _numbers, itertools.count()
        _compiling.append(key or f"{_compiling[0]} {next(_unknown)}")
        try:
            made = super().compile_extra(func)
        finally:
            _compiling.pop()
            _numbers = outer
        if key is not None:
            _keep(key, func, made)
        return made

    def _key(self, function: Any) -> str | None:
        """What a part is known by; None if no other process would know it again."""
        state = self.state
        try:
            given = [describe_type(kind) for kind in state.args]
            answer = "" if state.return_type is None else describe_type(state.return_type)
            told = code_of(function), given, answer, str(state.flags), str(state.locals), versions()
        except Unknown:
            return None
        return digest(repr((self.lowering._name, *told)))


class StageCompiler(PartCompiler):
    """The same for stages."""

    lowering = _LoweringOfStage


def _found(key: str) -> CompileResult | None:
    """A kept part as a result of compiling it."""
    hit = kept().find(key)
    if hit is None:
        return None
    try:
        library = _loaded(hit[0].code)
        fndesc, signature = pickle.loads(hit[0].about)
    except Exception:  # what was kept does not fit, in any way: it is made anew
        return None
    library.needs = hit[0].needs
    environment = Environment.from_fndesc(fndesc)
    entry = _known_to_numba(library, fndesc, environment)
    return result_of(library, fndesc, signature, entry, environment)


def result_of(library: Any, fndesc: Any, signature: Any, entry: Any, environment: Any) -> Any:
    """What numba would say had it compiled what was kept."""
    return CompileResult(
        typing_context=cpu_target.typing_context,
        target_context=cpu_target.target_context,
        entry_point=entry,
        typing_error=None,
        type_annotation=None,
        signature=signature,
        library=library,
        call_helper=None,
        environment=environment,
        lifted=(),
        fndesc=fndesc,
        objectmode=False,
        reload_init=(),
        referenced_envs=(),
        metadata={},
    )


def as_bytes(told: Any) -> bytes:
    """What numba must be told of compiled code. Classes are named, and not copied: those of a
    script that is run again are the same."""
    try:
        return pickle.dumps(told)
    except Exception:  # something that has no name
        return dumps(told)


def _keep(key: str, function: Any, made: Any) -> None:
    """Write a compiled part down for other kernels and processes."""
    library, below = made.library, needs_below(made.library)
    if below is None or library._reload_init:
        return
    try:
        library.needs = below | frozenset(needs_of(function))
    except Unknown:
        return
    made.fndesc.typemap = made.fndesc.calltypes = None
    about = as_bytes((made.fndesc, made.signature))
    name = f"{function.__module__}:{function.__qualname__}"

    def entry(store: Store) -> tuple[Entry, list[Code]]:
        found: dict[str, Code] = {}
        hash = _missing(library, store, found)
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
