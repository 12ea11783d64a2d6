"""Numbers at an address: how compiled functions share large tables.

An array is seven machine words and a count of its users; a function that takes ten of them spends
its time on handing them over. An address is one word. Whoever makes a table keeps it alive.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic
from numpy.typing import NDArray


def address(array: NDArray[Any]) -> int:
    """Of the first element of an array that lies in one piece."""
    assert array.flags.c_contiguous
    return int(array.ctypes.data)


def _reader(kind: Any, element: Any, widen: Callable | None, doc: str) -> Any:
    """The function (address, index) -> element."""

    def read(typing_context: Any, start: Any, index: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            base = builder.inttoptr(arguments[0], element.as_pointer())
            value = builder.load(builder.gep(base, [arguments[1]]))
            return widen(builder, value) if widen else value

        return kind(types.int64, types.int64), generate

    read.__doc__ = doc
    return intrinsic(read)


real = _reader(types.float64, ir.DoubleType(), None, "float64 number `index` from an address.")
short = _reader(types.float32, ir.FloatType(), None, "float32 number `index` from an address.")
whole = _reader(
    types.int64,
    ir.IntType(32),
    lambda builder, value: builder.sext(value, ir.IntType(64)),
    "int32 number `index` from an address, as int64.",
)

word = _reader(types.int64, ir.IntType(64), None, "int64 number `index` from an address.")

assert np.dtype(np.intp).itemsize == 8
