"""Stages of a step that are compiled only for the kinds of case that need them."""

import functools
import inspect
from collections.abc import Callable
from typing import Any

from mesokit.scalar.jit import by_type


def where(otherwise: str = "None", **needs: Callable[[Any], Any]) -> Callable[[Callable], Any]:
    """Compile a function, or a stage, only where the types of its arguments fulfil conditions.

    For other types a call is replaced by `otherwise`, an expression of the arguments, and nothing
    of the function is compiled. `needs` are functions of the numba type of an argument, by its
    name: `len` for a tuple that may be ().

    Examples
    --------
    >>> from numba import njit
    >>> @where("total", spring=len)
    ... def with_spring(total, spring):
    ...     return total + spring[0]
    >>> add = njit(lambda total, spring: with_spring(total, spring))
    >>> add(1.0, (2.0,)), add(1.0, ())
    (3.0, 1.0)
    """

    def decorate(function: Callable) -> Any:
        source = getattr(function, "py_func", function)
        names = list(inspect.signature(source).parameters)
        conditions = {names.index(name): condition for name, condition in needs.items()}
        space: dict[str, Any] = {}
        exec(f"def elsewhere({', '.join(names)}): return {otherwise}", source.__globals__, space)
        here = function if function is source else lambda *given: function(*given)

        @functools.wraps(source)
        def choose(*types: Any) -> Callable:
            needed = all(condition(types[place]) for place, condition in conditions.items())
            return here if needed else space["elsewhere"]

        return by_type(choose)

    return decorate
