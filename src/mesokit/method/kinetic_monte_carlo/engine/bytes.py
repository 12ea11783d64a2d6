"""Search among the 64 bytes at an address, in a few instructions on every processor."""

from typing import Any

from mesokit.kernels.later import intrinsic


@intrinsic
def equal_bytes(typing_context: Any, address: Any, value: Any) -> Any:
    """A word with a bit for each of the 64 bytes at an address, set where it has a value."""
    from llvmlite import ir
    from numba import types

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        byte, vector = ir.IntType(8), ir.VectorType(ir.IntType(8), 64)
        whole = builder.load(builder.inttoptr(arguments[0], vector.as_pointer()), align=1)
        one = builder.insert_element(
            ir.Constant(vector, ir.Undefined),
            builder.trunc(arguments[1], byte),
            ir.Constant(ir.IntType(32), 0),
        )
        every = builder.shuffle_vector(
            one,
            ir.Constant(vector, ir.Undefined),
            ir.Constant(ir.VectorType(ir.IntType(32), 64), [0] * 64),
        )
        equal = builder.icmp_unsigned("==", whole, every)
        return builder.bitcast(equal, ir.IntType(64))

    return types.uint64(types.uint64, types.uint64), generate


@intrinsic
def bits_set(typing_context: Any, word: Any) -> Any:
    """How many bits of a word are set."""
    from numba import types

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.ctpop(arguments[0])

    return types.uint64(types.uint64), generate


@intrinsic
def lowest_bit(typing_context: Any, word: Any) -> Any:
    """The number of the lowest bit that is set, 64 if none is."""
    from llvmlite import ir
    from numba import types

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.cttz(arguments[0], ir.Constant(ir.IntType(1), 0))

    return types.uint64(types.uint64), generate
