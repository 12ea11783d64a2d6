"""How physics is written: plain scalar functions, compiled once for every way of execution."""

import functools
import inspect
from collections.abc import Callable
from typing import Any

from mesokit.kernels.later import Later
from mesokit.scalar.intrinsics import not_inlined


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
    return Later(function, lambda: _part(function, forceinline=True, _nrt=False))


def _part(function: Callable, **options: bool) -> Any:
    from mesokit.kernels.part import part

    return part(function, **options)


def seldom(function: Callable) -> Any:
    """As `scalar`, for what few particles need: compiled once and called, not inlined.

    Both compilers need it. Numba for the CPU hands the wish to be inlined on from a function
    to those that it calls. What CUDA is given as the function is one that says of itself that it
    is not to be inlined, and then does the work.
    """

    def make() -> Any:
        from numba import njit

        made = _part(function, forceinline=False, nogil=True, _nrt=False)
        names = ", ".join(inspect.signature(function).parameters)
        space = {"not_inlined": not_inlined, "work": njit(inline="always", _nrt=False)(function)}
        exec(f"def called({names}):\n    not_inlined()\n    return work({names})", space)
        made.py_func = functools.update_wrapper(space["called"], function)
        del made.py_func.__wrapped__  # numba would take its lines for those of this one
        return made

    return Later(function, make)


def by_type(choose: Callable) -> Any:
    """A function of which `choose`, given the types of the arguments, gives the code to compile."""
    return _overloaded(choose, choose)


def _overloaded(name: Callable, choose: Callable) -> Any:
    def make() -> Any:
        from numba.extending import overload

        from mesokit.kernels.part import OPTIONS

        options = OPTIONS | {"forceinline": True, "_nrt": False}
        overload(name, strict=False, jit_options=options)(choose)
        return name

    choose.chooser = choose  # type: ignore[attr-defined]
    return Later(name, make, choose)


def generic(stub: Callable) -> Any:
    """A scalar function with one implementation per parameter type, as `functools.singledispatch`.

    The first argument is a `NamedTuple` of parameters; its class picks the implementation when the
    calling kernel is compiled, so that a kernel for one rule holds no trace of the others. Called
    from plain Python it is compiled for its arguments; a class that is not registered is a
    TypeError, unless `otherwise` has said what serves all others. `plain` is the same, not
    compiled; `implementations` are those registered, by class; `others` is [what otherwise serves].
    The stub has a docstring and no body.

    Examples
    --------
    >>> from typing import NamedTuple
    >>> from numba import njit, types
    >>> class Disk(NamedTuple):
    ...     radius: float
    >>> @generic
    ... def inside(shape, r):
    ...     '''Whether r lies inside the shape.'''
    >>> @inside.register(Disk)
    ... def _(shape, r):
    ...     return r < shape.radius
    >>> njit(lambda shape, r: inside(shape, r))(Disk(2.0), 1.0)
    True
    >>> inside(Disk(2.0), 3.0)
    False
    """
    table: dict[type, Callable] = {}
    others: list[Callable] = []

    def found(kind: Any) -> Callable | None:
        return table.get(kind, *others)

    def choose(*arguments: Any) -> Callable | None:
        kind = getattr(arguments[0], "instance_class", None)
        chosen = found(kind)
        if chosen is not None:  # what is compiled depends on this choice
            vars(chosen).setdefault("chosen_for", {})[made, kind] = None
        return chosen

    @functools.wraps(stub)
    def dispatch(*arguments: Any) -> Any:
        kind = type(arguments[0])
        implementation = found(kind)
        if implementation is None:
            raise TypeError(f"{stub.__name__}: nothing is registered for {kind.__name__}")
        return _compiled(implementation)(*arguments)

    def checked(implementation: Callable) -> Callable:
        if inspect.signature(implementation).parameters.keys() != names:
            given = ", ".join(inspect.signature(implementation).parameters)
            raise TypeError(
                f"{stub.__name__} takes ({', '.join(names)}), by these names; not ({given})"
            )
        return implementation

    def register(*parameters: type) -> Callable:
        def decorate(implementation: Callable) -> Callable:
            table.update(dict.fromkeys(parameters, checked(implementation)))
            return implementation

        return decorate

    def otherwise(implementation: Callable) -> Callable:
        others.append(checked(implementation))
        return implementation

    names = inspect.signature(stub).parameters.keys()
    dispatch.implementation = found  # type: ignore[attr-defined]
    dispatch.implementations = table  # type: ignore[attr-defined]
    dispatch.others = others  # type: ignore[attr-defined]
    dispatch.register = register  # type: ignore[attr-defined]
    dispatch.otherwise = otherwise  # type: ignore[attr-defined]
    dispatch.plain = lambda *given: table[type(given[0])](*given)  # type: ignore[attr-defined]
    made = _overloaded(dispatch, choose)
    return made


_compiled = functools.cache(scalar)


def elementwise(model: Callable) -> Any:
    """A function whose answer is a tuple as long as its last argument.

    The model gives the text of element {k}. Loops over long tuples are not unrolled by the
    compiler, and what is not unrolled goes through memory: so the elements are written out.

    Examples
    --------
    >>> from numba import njit
    >>> @elementwise
    ... def larger(a, b):
    ...     return "max(a[{k}], b[{k}])"
    >>> njit(lambda a, b: larger(a, b))((1.0, 2.0), (3.0, 0.0))
    (3.0, 2.0)
    """
    return _written_out(model, "return ({})", "{}, ")


def for_each(model: Callable) -> Any:
    """As `elementwise`, for statements: the function does them and has no answer."""
    return _written_out(model, "{}pass", "{}; ")


def _written_out(model: Callable, body: str, part: str) -> Any:
    names = ", ".join(inspect.signature(model).parameters)
    line = model(*names.split(", "))

    def choose(*arguments: Any) -> Callable:
        parts = (part.format(line.format(k=k)) for k in range(len(arguments[-1])))
        space: dict[str, Any] = {}
        code = f"def made({names}): {body.format(''.join(parts))}"
        exec(code, model.__globals__, space)
        return space["made"]

    return _overloaded(model, choose)


@by_type
def optional(values, default):
    """The one element of a tuple of parameters that may be empty, or the default."""
    if len(values) == 0:
        return lambda values, default: default
    return lambda values, default: values[0]
