"""Numbers at an address: how compiled functions share large tables.

An array is seven machine words and a count of its users; a function that takes ten of them spends
its time on handing them over. An address is one word. The owner of a table keeps it alive.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.kernels.later import intrinsic


def address(array: NDArray[Any]) -> int:
    """Of the first element of an array that lies in one piece."""
    assert array.flags.c_contiguous
    return int(array.ctypes.data)


def _reader(kind: str, element: str, doc: str) -> Any:
    """The function (address, index) -> number of a kind, of elements of another that may be
    shorter."""

    def read(typing_context: Any, start: Any, index: Any) -> Any:
        from numba import types

        given, answer = getattr(types, element), getattr(types, kind)

        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            pointer = context.get_value_type(given).as_pointer()
            base = builder.inttoptr(arguments[0], pointer)
            value = builder.load(builder.gep(base, [arguments[1]]))
            return context.cast(builder, value, given, answer)

        return answer(types.int64, types.int64), generate

    read.__doc__ = doc
    return intrinsic(read)


real = _reader("float64", "float64", "float64 number `index` from an address.")
short = _reader("float32", "float32", "float32 number `index` from an address.")
whole = _reader("int64", "int32", "int32 number `index` from an address, as int64.")
word = _reader("int64", "int64", "int64 number `index` from an address.")

assert np.dtype(np.intp).itemsize == 8
