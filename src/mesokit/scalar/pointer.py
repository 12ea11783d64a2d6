"""Numbers at an address: how compiled functions share large tables, on every target.

An array is seven machine words and a count of its users; a function that takes ten of them spends
its time on handing them over. An address is one word. The owner of a table keeps it alive.
"""

from typing import Any
from weakref import WeakValueDictionary

import numpy as np
from numpy.typing import NDArray

from mesokit.kernels.later import intrinsic
from mesokit.scalar.jit import by_type, elementwise, for_each

WORD = 8  # bytes of a number of 64 bits
_TABLES: WeakValueDictionary[int, NDArray[Any]] = WeakValueDictionary()


def address(array: NDArray[Any]) -> int:
    """Of the first element of an array that lies in one piece."""
    assert array.flags.c_contiguous
    place = int(array.ctypes.data)
    _TABLES[place] = array
    return place


def table_at(place: Any) -> NDArray[Any] | None:
    """The array whose address this is, or None: a device copies it to memory of its own."""
    return _TABLES.get(place)


def _is_cuda(context: Any) -> bool:
    return "cuda" in type(context).__module__


def _place(context: Any, builder: Any, place: Any, element: Any) -> Any:
    """A pointer to an element; on a GPU to global memory, which loads and stores then name."""
    from llvmlite import ir

    pointer = ir.PointerType(context.get_value_type(element), 1 if _is_cuda(context) else 0)
    start, index = place
    return builder.gep(builder.inttoptr(start, pointer), [index])


def _reader(kind: str, element: str, doc: str) -> Any:
    """The function (address, index) -> number of a kind, of elements of another that may be
    shorter."""

    def read(typing_context: Any, start: Any, index: Any) -> Any:
        from numba import types

        given, answer = getattr(types, element), getattr(types, kind)

        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            value = builder.load(_place(context, builder, arguments, given))
            return context.cast(builder, value, given, answer)

        return answer(types.int64, types.int64), generate

    read.__doc__ = doc
    return intrinsic(read)


real = _reader("float64", "float64", "float64 number `index` from an address.")
short = _reader("float32", "float32", "float32 number `index` from an address.")
whole = _reader("int64", "int32", "int32 number `index` from an address, as int64.")
word = _reader("int64", "int64", "int64 number `index` from an address.")


def _writer(kind: str, element: str, doc: str) -> Any:
    """The function (address, index, number) that stores a number as an element."""

    def write(typing_context: Any, start: Any, index: Any, value: Any) -> Any:
        from numba import types

        given, stored = getattr(types, kind), getattr(types, element)

        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            place = _place(context, builder, arguments[:2], stored)
            builder.store(context.cast(builder, arguments[2], given, stored), place)
            return context.get_dummy_value()

        return types.void(types.int64, types.int64, given), generate

    write.__doc__ = doc
    return intrinsic(write)


put_real = _writer("float64", "float64", "Store float64 number `index` from an address.")
put_whole = _writer("int64", "int32", "Store int32 number `index` from an address.")
put_word = _writer("int64", "int64", "Store int64 number `index` from an address.")


def _atomic(what: str, element: str, doc: str) -> Any:
    """The function (address, index, number) that adds to an element, or takes the larger one, all
    at once; it gives the number that was there. Of whole numbers alone the order does not matter.
    """

    def change(typing_context: Any, start: Any, index: Any, value: Any) -> Any:
        from llvmlite import ir
        from numba import types

        stored = getattr(types, element)

        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            place = _place(context, builder, arguments[:2], stored)
            number = context.cast(builder, arguments[2], types.int64, stored)
            if _is_cuda(context):
                # By name: newer compilers would make it visible to the whole system, not to the
                # device alone, which takes longer.
                bits, kind = number.type.width, "u" if what == "add" else "s"
                text = f"atom.relaxed.gpu.global.{what}.{kind}{bits} $0, [$1], $2;"
                letter = "l" if bits == 64 else "r"
                form = ir.FunctionType(number.type, [ir.IntType(64), number.type])
                code = ir.InlineAsm(form, text, f"={letter},l,{letter}", side_effect=True)
                found = builder.call(code, [builder.ptrtoint(place, ir.IntType(64)), number])
            else:
                found = builder.atomic_rmw(what, place, number, "monotonic")
            return context.cast(builder, found, stored, types.int64)

        return types.int64(types.int64, types.int64, types.int64), generate

    change.__doc__ = doc
    return intrinsic(change)


take_number = _atomic("add", "int32", "Add to int32 number `index`; gives what it was before.")
raise_to = _atomic("max", "int64", "Make int64 number `index` at least so large.")


@intrinsic
def add_word(typing_context: Any, start: Any, index: Any, value: Any) -> Any:
    """Add to int64 number `index` from an address, to which other threads add as well."""
    from llvmlite import ir
    from numba import types

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        whole, place = ir.IntType(64), _place(context, builder, arguments[:2], types.int64)
        if _is_cuda(context):
            form = ir.FunctionType(ir.VoidType(), [whole, whole])
            code = ir.InlineAsm(form, "red.relaxed.gpu.global.add.u64 [$0], $1;", "l,l", True)
            builder.call(code, [builder.ptrtoint(place, whole), arguments[2]])
        else:
            builder.atomic_rmw("add", place, arguments[2], "monotonic")
        return context.get_dummy_value()

    return types.void(types.int64, types.int64, types.int64), generate


def is_address(values: Any) -> bool:
    """Whether these are numbers at an address and no array, from the numba type."""
    from numba import types

    return isinstance(values, types.Integer)


@by_type
def element(values, k):
    """Number k of an array, or of the float64 numbers at an address."""
    return (lambda values, k: real(values, k)) if is_address(values) else _element


def _element(values, k):
    return values[k]


@by_type
def entry(values, k):
    """The same of whole numbers, which are int32 at an address."""
    return (lambda values, k: whole(values, k)) if is_address(values) else _element


@by_type
def put_entry(values, k, number):
    """Store one of these."""
    return (lambda values, k, number: put_whole(values, k, number)) if is_address(values) else _put


def _put(values, k, number):
    values[k] = number


@by_type
def cell_of_table(values, row, column, width):
    """A whole number of a table (rows, width), an array or int32 at an address."""
    if is_address(values):
        return lambda values, row, column, width: whole(values, row * width + column)
    return lambda values, row, column, width: values[row, column]


@by_type
def integer(values, k):
    """Number k of an array of whole numbers, or of the int64 numbers at an address."""
    from numba import types

    if isinstance(values, types.Array):
        return lambda values, k: np.int64(values[k])
    return lambda values, k: word(values, k)


@by_type
def numbers_in(values, row, width, first, pattern):
    """Numbers of a row from one column on, as a tuple as long as `pattern`.

    `values` is an array (rows, width), or the address of such float64 numbers.
    """
    from numba import types

    if isinstance(values, types.Array):
        return lambda values, row, width, first, pattern: _in_array(values, row, first, pattern)
    return lambda values, row, width, first, pattern: reals(values, row * width + first, pattern)


@elementwise
def _in_array(values, row, first, pattern):
    return "values[row, first + {k}]"


@by_type
def put_numbers_in(values, row, width, first, given):
    """Store a tuple in such a row from one column on."""
    from numba import types

    if isinstance(values, types.Array):
        return lambda values, row, width, first, given: _to_array(values, row, first, given)
    return lambda values, row, width, first, given: put_reals(values, row * width + first, given)


@for_each
def _to_array(values, row, first, given):
    return "values[row, first + {k}] = given[{k}]"


@elementwise
def reals(start, index, pattern):
    """float64 numbers from `index` on, as a tuple as long as `pattern`."""
    return "real(start, index + {k})"


@for_each
def put_reals(start, index, values):
    """Store a tuple as float64 numbers from `index` on."""
    return "put_real(start, index + {k}, values[{k}])"


@elementwise
def words_at(start, index, pattern):
    """int64 numbers from `index` on, as a tuple as long as `pattern`."""
    return "word(start, index + {k})"


@for_each
def add_words(start, index, values):
    """Add a tuple to the int64 numbers from `index` on, to which others add as well."""
    return "add_word(start, index + {k}, values[{k}])"


@for_each
def clear_words(start, index, pattern):
    """Set as many int64 numbers as `pattern` has to 0."""
    return "put_word(start, index + {k}, 0)"


assert np.dtype(np.intp).itemsize == WORD
