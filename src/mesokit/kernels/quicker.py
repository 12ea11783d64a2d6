"""Numba's slowest steps of translating a function, done once or in fewer calls.

Most of the time to compile a part goes to numba's own Python. Three answers that it works out again
and again are given sooner here; what is compiled stays the same.
"""

from types import BuiltinFunctionType
from typing import Any

from numba.core import errors, ir
from numba.core.types import Function
from numba.core.types.functions import BaseFunction

_resolve = BaseFunction.get_call_type


def resolve_once(self: Any, context: Any, args: Any, kws: Any) -> Any:
    """The signature of a call of a function that is built into Python, such as a sum.

    Numba tries all signatures that it has for such a function at every call, and words an error for
    each that does not fit. New signatures make another object of the function. What is written in
    Python is asked again each time: it may have been defined anew.
    """
    if kws or not isinstance(self.typing_key, BuiltinFunctionType):
        return _resolve(self, context, args, kws)
    known = self.__dict__.setdefault("_resolved", {})
    if (context, args) not in known:
        signature: Any = _resolve(self, context, args, kws)
        known[context, args] = signature, self._impl_keys[signature.args]
    found, key = known[context, args]
    self._impl_keys[found.args] = key  # again, as one object serves processors and cards
    return found


def list_variables(self: Any, value: Any) -> list[ir.Var]:
    """The variables in a value of numba's intermediate form, in their order."""
    found: list[ir.Var] = []
    _collect(value, found)
    return found


PLAIN = {str, int, float, bool, type(None), ir.Loc}  # most values: these have no variables


def _collect(value: Any, found: list[ir.Var]) -> None:
    kind = type(value)
    if kind is ir.Var:
        found.append(value)
    elif kind in PLAIN:
        return
    elif isinstance(value, ir.Inst):
        found.extend(value.list_vars())
    elif isinstance(value, dict):
        for one in value.values():
            _collect(one, found)
    elif isinstance(value, list | tuple):
        for one in value:
            _collect(one, found)


def mark(self: Any, message: str, color: str | None = None, style: str = "\x1b[1m") -> str:
    """A text with the codes for its colour and style around it.

    Numba sets up the terminal for each text. It words an error, in bold, for every answer that is
    no: most of these are never shown.
    """
    return f"{color or ''}{style}{message}\x1b[0m"


Function.get_call_type = resolve_once  # type: ignore[method-assign]
ir.Inst._rec_list_vars = list_variables
if hasattr(errors, "HighlightColorScheme"):  # not without colorama
    errors.HighlightColorScheme._markup = mark
