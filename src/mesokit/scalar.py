"""How physics is written: plain scalar functions, compiled once for every way of execution."""

import inspect
from collections.abc import Callable
from typing import Any

from numba import njit, types
from numba.extending import intrinsic, overload


def scalar(function: Callable) -> Any:
    """Compile a function of floats and tuples; it is inlined into the loop that calls it.

    Floating point stays strictly IEEE (no fast-math, no contraction): a result then does not
    depend on whether LLVM vectorised the loop, which is what makes runs bit-reproducible.

    Examples
    --------
    >>> @scalar
    ... def kinetic_energy(m, v):
    ...     return 0.5 * m * v * v
    >>> kinetic_energy(1.0, 2.0)
    2.0
    """
    return njit(forceinline=True, error_model="numpy")(function)


def by_type(stub: Callable) -> Callable:
    """Decorator for a function that chooses, from argument types, how to compile the stub."""
    return overload(stub, strict=False, jit_options={"forceinline": True, "error_model": "numpy"})


def generic(stub: Callable) -> Any:
    """A scalar function with one implementation per parameter type, as `functools.singledispatch`.

    The first argument is a `NamedTuple` of parameters; its class picks the implementation when the
    calling kernel is compiled, so that a kernel for one rule holds no trace of the others.

    Examples
    --------
    >>> from typing import NamedTuple
    >>> from numba import njit, types
    >>> class Disk(NamedTuple):
    ...     radius: float
    >>> @generic
    ... def inside(shape, r): ...
    >>> @inside.register(Disk)
    ... def _(shape, r):
    ...     return r < shape.radius
    >>> njit(lambda shape, r: inside(shape, r))(Disk(2.0), 1.0)
    True
    """
    table: dict[type, Callable] = {}

    def choose(*arguments: Any) -> Callable | None:
        return table.get(getattr(arguments[0], "instance_class", None))  # type: ignore[arg-type]

    by_type(stub)(choose)

    def register(*parameters: type) -> Callable:
        def decorate(implementation: Callable) -> Callable:
            if inspect.signature(implementation).parameters.keys() != names:
                raise TypeError(f"{stub.__name__} takes ({', '.join(names)})")
            table.update(dict.fromkeys(parameters, implementation))
            return implementation

        return decorate

    names = inspect.signature(stub).parameters.keys()
    stub.register = register  # type: ignore[attr-defined]
    return stub


def optional(values: Any, default: Any) -> Any:
    """The one element of a tuple of parameters that may be empty, or the default."""
    return values[0] if values else default


@by_type(optional)
def _optional(values: Any, default: Any) -> Callable:
    if len(values) == 0:
        return lambda values, default: default
    return lambda values, default: values[0]


def first(values: Any, like: Any) -> Any:
    """As many of the values as the tuple `like` has elements."""
    return values[: len(like)]


@by_type(first)
def _first(values: Any, like: Any) -> Callable:
    count = len(like)
    if count == 1:
        return lambda values, like: values[:1]
    if count == 2:
        return lambda values, like: values[:2]
    return lambda values, like: values[:3]


@intrinsic
def mul_add(typing_context: Any, a: Any, b: Any, c: Any) -> Any:
    """a * b + c, rounded once: one instruction, and the same bits wherever it is compiled."""
    double = types.float64

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        given = zip(arguments, signature.args, strict=True)
        cast = [context.cast(builder, value, kind, double) for value, kind in given]
        return builder.fma(*cast)

    return double(a, b, c), generate


def written_out(signature: str, line: str, length: int, result: str = "", **names: Any) -> Callable:
    """A function that does `line` for each of the elements {k} of its tuples, without a loop.

    Loops over long tuples are not unrolled by the compiler, and what is not unrolled goes through
    memory. `result` is an expression in which {all} stands for the lines joined by commas.
    """
    lines = [line.format(k=k) for k in range(length)]
    if result:
        body = f"    return {result.format(all=', '.join(lines))}"
    else:
        body = "\n".join(f"    {text}" for text in lines) or "    pass"
    space: dict[str, Any] = dict(names)
    exec(f"def made({signature}):\n{body}", space)
    return space["made"]


def scaled(factor: Any, x: Any) -> Any:
    """A vector times a number."""
    raise NotImplementedError


@by_type(scaled)
def _scaled(factor: Any, x: Any) -> Callable:
    return written_out("factor, x", "factor * x[{k}]", len(x), "({all},)")


def added(a: Any, b: Any) -> Any:
    """The sum of two vectors."""
    raise NotImplementedError


@by_type(added)
def _added(a: Any, b: Any) -> Callable:
    return written_out("a, b", "a[{k}] + b[{k}]", len(a), "({all},)")


def chosen(condition: Any, a: Any, b: Any) -> Any:
    """a where the condition holds, else b, for vectors a and b."""
    raise NotImplementedError


@by_type(chosen)
def _chosen(condition: Any, a: Any, b: Any) -> Callable:
    line = "a[{k}] if condition else b[{k}]"
    return written_out("condition, a, b", line, len(a), "({all},)")


def added_scaled(a: Any, factor: Any, b: Any) -> Any:
    """a + factor * b for vectors a and b."""
    raise NotImplementedError


@by_type(added_scaled)
def _added_scaled(a: Any, factor: Any, b: Any) -> Callable:
    line = "mul_add(factor, b[{k}], a[{k}])"
    return written_out("a, factor, b", line, len(a), "({all},)", mul_add=mul_add)


@scalar
def dot(a, b):
    """Scalar product of two vectors."""
    total = a[0] * b[0]
    for k in range(1, len(a)):
        total = mul_add(a[k], b[k], total)
    return total
