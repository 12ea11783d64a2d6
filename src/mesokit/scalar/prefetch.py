"""Memory that will be read soon, brought into the cache before: changes times and nothing else."""

from typing import Any

from mesokit.kernels.later import intrinsic

LINE = 64  # bytes of a cache line


@intrinsic
def prefetch(typing_context: Any, array: Any, row: Any, byte: Any) -> Any:
    """Ask for the cache line with a byte of a row of an array, which must exist or lie just beyond
    the end."""
    from llvmlite import ir
    from numba import types
    from numba.core import cgutils
    from numba.np.arrayobj import make_array

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        given = make_array(signature.args[0])(context, builder, arguments[0])
        index = context.cast(builder, arguments[1], signature.args[1], types.intp)
        offset = context.cast(builder, arguments[2], signature.args[2], types.intp)
        stride = builder.extract_value(given.strides, 0)
        bytes_on = builder.add(builder.mul(index, stride), offset)
        start = builder.ptrtoint(given.data, bytes_on.type)
        pointer = builder.inttoptr(builder.add(start, bytes_on), cgutils.voidptr_t)
        number = ir.IntType(32)
        kind = ir.FunctionType(ir.VoidType(), [cgutils.voidptr_t, number, number, number])
        function = cgutils.get_or_insert_function(builder.module, kind, "llvm.prefetch.p0i8")
        builder.call(function, [pointer, number(0), number(3), number(1)])
        return context.get_dummy_value()

    return types.void(array, row, byte), generate
