"""Functions compiled for a GPU, on a machine that has none."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from numba import typeof

from mesokit.devices.compile import compiled

ARCHITECTURE = (9, 0)
Call = tuple[Callable, tuple[Any, ...]]


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
    given = typeof(tuple(arguments for _, arguments in calls))
    level = 3 if optimised else 0
    result = compiled(space["called"], None, (given,), ARCHITECTURE, level)
    (text,) = result.library.get_asm_strs(cc=ARCHITECTURE)
    return Compiled(result.library.get_llvm_str(), text)
