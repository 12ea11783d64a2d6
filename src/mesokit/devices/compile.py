"""Kernels for cards of NVIDIA, made without one: text (PTX), then machine code (a cubin).

numba-cuda serves as a compiler alone. Its own launches compile with contraction, which has other
bits, and would handle dozens of arguments anew each time. This is the only file that uses what is
private to it; the version is pinned.
"""

import functools
import inspect
import re
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from mesokit.devices.device import BLOCK
from mesokit.errors import RunError

Chip = tuple[int, int]
ENTRY = "mesokit_kernel"
INSTALL = "expected `pip install '.[cuda13]'` in a clone, or [cuda12] for drivers below 580"


class Machine(NamedTuple):
    """A kernel as a card loads it, and what the assembler says of it: registers, spills, stack."""

    cubin: bytes
    said: str


@functools.cache
def _numba_cuda() -> Any:
    """The compiler of numba-cuda. Raises RunError where it is not installed."""
    try:
        from numba.cuda import compiler, dispatcher
        from numba.cuda.cudadrv import nvvm
    except ImportError as error:
        raise RunError(f"device = 'cuda': numba-cuda is missing ({error}); {INSTALL}") from None
    for module in (compiler, dispatcher):  # asked even where the chip is given
        module.get_current_device = _AnyDevice
    return compiler, nvvm


@functools.cache
def require_chip(chip: Chip) -> None:
    """Raise RunError for a compute capability that the compiler does not know."""
    _numba_cuda()
    from numba.cuda.cudadrv.nvrtc import get_supported_ccs

    known = get_supported_ccs()
    if chip not in known:
        names = ", ".join(f"{major}.{minor}" for major, minor in known)
        wrong = f"{chip[0]}.{chip[1]}"
        raise RunError(f"compute capability {wrong}: expected one that is known here: {names}")


class _AnyDevice:
    """What the compiler asks a device for."""

    compute_capability = (9, 0)


def kernel_of(body: Callable) -> Callable:
    """The function that a thread runs: it finds its number, and does the work if it has any."""
    from numba import cuda

    given = ", ".join(f"a{k}" for k in range(1, len(inspect.signature(body).parameters)))
    space: dict[str, Any] = {"body": body, "grid": cuda.grid, "whole": np.int64}
    code = f"def kernel(threads, {given}):\n    i = whole(grid(1))\n    if i < threads:\n"
    exec(f"{code}        body(i, {given})\n", space)
    made: Callable = space["kernel"]
    return made


def compiled(function: Callable, gives: Any, kinds: tuple[Any, ...], chip: Chip, level: int) -> Any:
    """A function of arguments of these numba types, as numba-cuda leaves it; `gives` is its type.

    Without contraction a * b + c keeps its two roundings, as on the processor.
    """
    require_chip(chip)
    compiler, _ = _numba_cuda()
    options = {"opt": level, "fma": 0}
    return compiler.compile_cuda(function, gives, kinds, nvvm_options=options, cc=chip)


def text_of(body: Callable, kinds: tuple[Any, ...], chip: Chip) -> str:
    """PTX of a body for arguments of these numba types: products and sums keep their roundings."""
    from numba import types

    compiler, nvvm = _numba_cuda()
    made = compiled(kernel_of(body), types.void, (types.int64, *kinds), chip, level=3)
    function = made.library.get_function(made.fndesc.llvm_func_name)
    compiler.kernel_fixup(function, False)
    nvvm.set_launch_bounds(function, BLOCK)
    return shortened("\n".join(made.library.get_asm_strs(cc=chip)))


def machine_of(ptx: str, chip: Chip) -> Machine:
    """Machine code of PTX. A driver older than the compiler can load it, but not the PTX."""
    try:
        from cuda.bindings import nvjitlink
    except ImportError as error:
        raise RunError(f"device = 'cuda': nvJitLink is missing ({error}); {INSTALL}") from None
    options = [f"-arch=sm_{chip[0]}{chip[1]}", "-Xptxas=-v"]
    linker, text = nvjitlink.create(len(options), options), ptx.encode() + b"\0"
    try:
        nvjitlink.add_data(linker, nvjitlink.InputType.PTX, text, len(text), "kernel.ptx")
        nvjitlink.complete(linker)
        cubin = bytearray(nvjitlink.get_linked_cubin_size(linker))
        nvjitlink.get_linked_cubin(linker, cubin)
        said = bytearray(nvjitlink.get_info_log_size(linker))
        nvjitlink.get_info_log(linker, said)
    finally:
        nvjitlink.destroy(linker)
    return Machine(bytes(cubin), said.rstrip(b"\0").decode())


def shortened(text: str) -> str:
    """PTX with short names: those of numba hold the types of all arguments."""
    found = re.search(r"\.entry\s+([\w$]+)", text)
    assert found is not None
    text = text.replace(found[1], ENTRY)
    short: dict[str, str] = {}

    def name(found: re.Match) -> str:
        return short.setdefault(found[0], f"name{len(short)}")

    return re.sub(r"\b(?:_Z|__)\w[\w$]{30,}", name, text)
