"""Functions compiled for a GPU, on a machine that has none."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from numba import typeof
from numba.cuda import compiler, dispatcher

ARCHITECTURE = (9, 0)
Call = tuple[Callable, tuple[Any, ...]]


class Device:
    """What the compiler asks of a device."""

    compute_capability = ARCHITECTURE


# The compiler asks the device what it is; there is no public way to tell it.
for module in (dispatcher, compiler):
    module.get_current_device = Device


class Compiled(NamedTuple):
    """Functions as the compiler of numba leaves them, and as that of the GPU does."""

    ir: str
    ptx: str


def compile_for_gpu(calls: Sequence[Call], optimised: bool = False) -> Compiled:
    """One function that does these calls, with arguments like these.

    An exception of some kind tells that there is in them what the CUDA target does not know.
    """
    answers = ", ".join(f"f{k}(*given[{k}])" for k in range(len(calls)))
    space: dict[str, Any] = {f"f{k}": function for k, (function, _) in enumerate(calls)}
    exec(f"def called(given): return ({answers},)", space)
    result = compiler.compile_cuda(
        space["called"],
        None,
        (typeof(tuple(arguments for _, arguments in calls)),),
        # without contraction a * b + c keeps its two roundings, as on the CPU
        nvvm_options={"opt": 3 if optimised else 0, "fma": 0},
        cc=ARCHITECTURE,
    )
    (text,) = result.library.get_asm_strs(cc=ARCHITECTURE)
    return Compiled(result.library.get_llvm_str(), text)
