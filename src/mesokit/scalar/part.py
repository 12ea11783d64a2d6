"""Compilation of the parts of a kernel: what only other compiled code calls.

Numba makes machine code, and a wrapper that Python can call, of each function that it compiles.
Here most functions are small and are inlined into the loop that calls them, so that both would be
thrown away. A part is translated as any other function, and kept for linking alone.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from llvmlite.binding import Linkage
from numba import njit
from numba._dynfunc import make_function
from numba.core import typed_passes, untyped_passes
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.compiler_machinery import register_pass
from numba.core.registry import CPUDispatcher

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


class _ForLinking(JITCodeLibrary):
    """The code of one part, which is put together with that of others in the kernel, once."""

    _together: Any = None  # with all that it calls

    def finalize(self) -> None:
        self._raise_if_finalized()
        for function in self._final_module.functions:
            if not function.is_declaration and function.linkage == Linkage.external:
                function.linkage = "linkonce_odr"  # several kernels have it
        for library in self._linking_libraries:
            self._reload_init.update(library._reload_init)
        self._finalize_dynamic_globals()
        self._finalized = True

    def _get_module_for_linking(self) -> Any:
        if self._together is None:
            self._together = self._final_module.clone()
            for library in _called_by(self):
                self._together.link_in(_own_module(library), preserve=True)
        return self._together


def _called_by(library: Any) -> list[Any]:
    """What a part calls, what that calls, and so on: each once, and after all that call it, as LLVM
    leaves out what nobody has asked for yet."""
    order: dict[Any, None] = {}

    def visit(library: Any) -> None:
        for called in library._linking_libraries if isinstance(library, _ForLinking) else ():
            if called not in order:
                visit(called)
        order[library] = None

    visit(library)
    return list(order)[-2::-1]


def _own_module(library: Any) -> Any:
    """The code of a part alone, or whatever numba links of what is its own."""
    if isinstance(library, _ForLinking):
        return library._final_module
    return library._get_module_for_linking()


@register_pass(mutates_CFG=True, analysis_only=False)
class _Lowering(typed_passes.NativeLowering):
    _name = "lowering of a part"

    def run_pass(self, state: Any) -> bool:
        library = _ForLinking(state.targetctx.codegen(), state.func_id.func_qualname)
        flags, state.library, state.flags = state.flags, library, state.flags.copy()
        state.flags.no_compile = True
        super().run_pass(state)
        state.flags = flags
        made, about = state["cr"], state["cr"].fndesc
        name = about.qualname.split(".")[-1]
        # numba knows compiled functions by objects that Python could call; this one leads nowhere
        entry = make_function(about.lookup_module(), name, "", 0, made.env, (library,))
        state.targetctx.insert_user_function(entry, about, [library])
        state.reload_init.extend(library._reload_init)
        state["cr"] = made._replace(cfunc=entry)
        return True


class PartCompiler(Compiler):
    """Numba's stages without those that parts have no use for."""

    def define_pipelines(self) -> list:
        """The stages in order."""
        [stages] = super().define_pipelines()
        kept, pruned = [], False
        for stage, why in stages.passes:
            if stage in SKIPPED or (stage is untyped_passes.DeadBranchPrune and pruned):
                continue
            pruned |= stage is untyped_passes.DeadBranchPrune
            kept.append((_Lowering if stage is typed_passes.NativeLowering else stage, why))
        stages.passes[:] = kept
        stages._finalized = False
        stages.finalize()
        return [stages]


class _Part(CPUDispatcher):
    """A part; called from Python, it is compiled once more in numba's usual way."""

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
