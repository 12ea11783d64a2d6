"""Libraries of compiled code: that of parts, put together in the kernel, and that of stages.

The code of a part is bitcode, which lies in the store by its hash, with the hashes of what it
calls. A stage has machine code as well, by the same hash and the processor.
"""

import pickle
import weakref
from collections.abc import Iterable
from typing import Any

import llvmlite.binding as llvm
from llvmlite.binding import Linkage
from numba.core.codegen import JITCodeLibrary
from numba.core.registry import cpu_target

from mesokit.kernels.kept import counts, kept, versions
from mesokit.kernels.made_of import digest
from mesokit.kernels.store import Code, Entry, Store


def processor() -> str:
    """Processor for which machine code is made."""
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

    _ready: Any = None  # name of its machine code in numba

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
            record = pickle.dumps((_defined(made._final_module), hashes))
            code = Code(self.name, (), made._get_compiled_object())
            entry = Entry(f"kernel {self.name}", frozenset(), record, code.hash)
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
            loaded(hash).make_ready()


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
    """Parts that a part calls, that these call, and so on: each once, and after all that call
    it, as LLVM leaves out what nothing has named yet."""
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


def missing(library: Any, store: Store, found: dict[str, Code]) -> str:
    """The hash of a library; code of it, or of what it calls, is noted where a store lacks it."""
    known = getattr(library, "hash", None)
    if known is not None and (known in found or store.has_code(known)):
        return known
    called: tuple[str, ...] = ()
    if isinstance(library, PartLibrary):
        below = dict.fromkeys(library._linking_libraries)
        called = tuple(missing(one, store, found) for one in below)
    code = Code(library.name, called, _own_module(library).as_bitcode())
    found[code.hash], library.hash = code, code.hash
    _libraries[code.hash] = library
    return code.hash


def loaded(hash: str) -> Any:
    """The library of kept code, with all it calls. Raises LookupError where some is missing."""
    if hash in _libraries:
        return _libraries[hash]
    code = kept().code(hash)
    if code is None:
        raise LookupError(hash)
    kind = StageLibrary if code.name.startswith(STAGE) else PartLibrary
    library = kind(cpu_target.target_context.codegen(), code.name)
    library._linking_libraries = [loaded(one) for one in code.called]
    library._body, library._finalized, library.hash = code.body, True, hash
    _libraries[hash] = library
    return library
