"""Single instructions that numba has no name for, alike on every target: CPU and CUDA."""

from typing import Any

from mesokit.kernels.later import intrinsic


@intrinsic
def mul_add(typing_context: Any, a: Any, b: Any, c: Any) -> Any:
    """a * b + c, rounded once: one instruction, and the same bits wherever it is compiled."""
    from numba import types

    double = types.float64

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        given = zip(arguments, signature.args, strict=True)
        cast = [context.cast(builder, value, kind, double) for value, kind in given]
        return builder.fma(*cast)

    return double(a, b, c), generate


@intrinsic
def floor(typing_context: Any, x: Any) -> Any:
    """The largest whole number that is not above x, as a float."""
    from numba import types

    double = types.float64

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        value = context.cast(builder, arguments[0], signature.args[0], double)
        function = builder.module.declare_intrinsic("llvm.floor", [value.type])
        return builder.call(function, [value])

    return double(x), generate


@intrinsic
def with_item(typing_context: Any, values: Any, k: Any, x: Any) -> Any:
    """The tuple of numbers with element k replaced by x."""
    from numba import types
    from numba.core import cgutils

    if not (isinstance(values, types.UniTuple) and isinstance(k, types.Integer)):
        return None

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        given, index, value = arguments
        place = cgutils.alloca_once_value(builder, given)
        zero = context.get_constant(types.int32, 0)
        if index.type.width > zero.type.width:
            index = builder.trunc(index, zero.type)
        value = context.cast(builder, value, signature.args[2], values.dtype)
        builder.store(value, builder.gep(place, [zero, index], inbounds=True))
        return builder.load(place)

    return values(values, k, x), generate


@intrinsic
def not_inlined(typing_context: Any) -> Any:
    """The function that says this is called, on every target, wherever it is used."""
    from numba import types

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        builder.function.attributes.add("noinline")
        return context.get_dummy_value()

    return types.void(), generate
