"""Description of the sources of compiled code, in words that are the same in every process.

A compiled function is known by its own code, the values that are frozen into it, and the types of
its arguments. What it uses beside that are its needs: lines that name a function and hold a hash of
it. Code is valid while all its needs are as they were, so that an edit of one function remakes what
contains it and nothing else.
"""

import dis
import functools
import hashlib
import importlib
import sys
import types as python_types
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core.registry import CPUDispatcher

# Packages whose versions are part of every key: their functions are known by name alone.
KNOWN = ("numpy", "numba", "llvmlite", "builtins", "math", "operator", "typing", "functools")


class Unknown(Exception):
    """Something that no other process could recognise as the same."""


def digest(text: str) -> str:
    """A word for a text."""
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()[:24]


# --- functions ------------------------------------------------------------------------------------


@functools.cache
def _code(code: Any, documented: bool) -> str:
    """All of a code object that a compiler reads: no lines, no files, no docstring."""
    constants = code.co_consts[1:] if documented else code.co_consts
    names = code.co_names, code.co_varnames, code.co_freevars, code.co_cellvars
    counts = code.co_argcount, code.co_kwonlyargcount, code.co_flags
    return repr((code.co_code, names, counts, [_constant(value) for value in constants]))


def _constant(value: Any) -> str:
    if isinstance(value, python_types.CodeType):
        return _code(value, False)
    if isinstance(value, tuple):
        return str([_constant(item) for item in value])
    if isinstance(value, frozenset):
        return str(sorted(_constant(item) for item in value))
    return f"{type(value).__name__} {value!r}"


@functools.cache
def _names(code: Any) -> tuple[frozenset[str], frozenset[str]]:
    """Names that a code object, or one within it, looks up in its module, and in any object."""
    lines = [line for line in dis.get_instructions(code) if line.opname.startswith("LOAD")]
    looked = {line.argval for line in lines if line.opname in ("LOAD_GLOBAL", "LOAD_NAME")}
    parts = {line.argval for line in lines if line.opname in ("LOAD_ATTR", "LOAD_METHOD")}
    for value in code.co_consts:
        if isinstance(value, python_types.CodeType):
            more, others = _names(value)
            looked, parts = looked | more, parts | others
    return frozenset(looked), frozenset(parts)


def _named(function: Any) -> dict[str, Any]:
    """Values of its module that a function names."""
    space = function.__globals__
    return {name: space[name] for name in sorted(_names(function.__code__)[0]) if name in space}


def place_of(thing: Any) -> str:
    """Module and name under which every process finds a function or class. Raises Unknown."""
    module, name = thing.__module__, thing.__qualname__
    main = getattr(sys.modules["__main__"], "__file__", "") or "no file"
    if module == "__main__" and not Path(main).is_file():
        raise Unknown(f"{name} is of a notebook, whose cells may define it anew")
    if module is None or "<locals>" in name or _find(module, name) is not thing:
        raise Unknown(f"{module}.{name}")
    return f"{module}:{name}"


def _find(module: str, name: str) -> Any:
    """The function or class at a place; None if there is nothing."""
    try:
        found: Any = sys.modules.get(module) or importlib.import_module(module)
        for part in name.split("."):
            found = getattr(found, part)
    except (ImportError, AttributeError, ValueError):
        return None
    return source_of(found) if isinstance(found, CPUDispatcher) else found


def source_of(compiled: Any) -> Any:
    """The Python function that a compiled one was made of."""
    return getattr(compiled, "source", compiled._compiler.py_func)


def code_of(function: Any) -> str:
    """A word for a function: its code and what is frozen into it. Raises Unknown."""
    return digest(_function(function, ()))


def _function(function: Any, within: tuple) -> str:
    """The code of a function and all that it names; `within`: functions in hand."""
    if function in within:
        return f"function {within.index(function)} again"
    within, code = (*within, function), function.__code__
    documented = bool(code.co_consts) and function.__doc__ == code.co_consts[0] is not None
    parts = _names(code)[1]
    named = {name: describe(value, within, parts) for name, value in _named(function).items()}
    cells = [cell.cell_contents for cell in function.__closure__ or ()]
    frozen = [*cells, function.__defaults__, function.__kwdefaults__]
    return repr((_code(code, documented), named, [describe(value, within) for value in frozen]))


# --- values ---------------------------------------------------------------------------------------


def describe(value: Any, within: tuple = (), parts: Iterable[str] = ()) -> str:
    """A text for a value that compiled code, or what chooses it, may depend on. Raises Unknown.

    Compiled functions are named, for they are needs of their own; other functions are described in
    full. `parts`: names that may be looked up in a module.
    """
    if value is None or isinstance(value, (bool, int, float, complex, str, bytes)):
        return f"{type(value).__name__} {value!r}"
    if isinstance(value, (np.generic, np.ndarray)):
        array = np.asarray(value)
        if array.dtype.hasobject:
            raise Unknown("objects in an array")
        return f"{array.dtype} {array.shape} {hashlib.sha256(array.tobytes()).hexdigest()}"
    if isinstance(value, types.Type):
        return describe_type(value)
    if isinstance(value, (np.dtype, ir.Type)):
        return f"{type(value).__name__} {value}"
    if isinstance(value, (tuple, list)):
        named = _class(type(value)) if hasattr(value, "_fields") else type(value).__name__
        return f"{named} {[describe(item, within) for item in value]}"
    if isinstance(value, (set, frozenset)):
        return f"set {sorted(describe(item, within) for item in value)}"
    if isinstance(value, dict):
        items = [(describe(key, within), describe(item, within)) for key, item in value.items()]
        return f"dict {sorted(items)}"
    if isinstance(value, python_types.ModuleType):
        taken = _taken(value, parts).items()
        described = {name: describe(one, within, parts) for name, one in taken}
        return f"module {value.__name__} {described}"
    if isinstance(value, type):
        return _class(value)
    return _callable(value, within)


def _taken(module: Any, parts: Iterable[str]) -> dict[str, Any]:
    """Names in a module whose version is in no key that may be looked up."""
    if module.__name__.split(".")[0] in KNOWN:
        return {}
    return {name: vars(module)[name] for name in sorted(parts) if name in vars(module)}


def _class(kind: type) -> str:
    return f"class {place_of(kind)} {getattr(kind, '_fields', '')}"


def _callable(value: Any, within: tuple) -> str:
    if isinstance(value, CPUDispatcher):
        function = source_of(value)
        options = sorted((name, str(option)) for name, option in value.targetoptions.items())
        if not getattr(value, "is_part", False):  # no need of its own says what it is
            return f"compiled {_function(function, within)} {options}"
        try:
            return f"compiled {place_of(function)} {options}"
        except Unknown:
            return f"compiled {_function(function, within)} {options}"
    if hasattr(value, "_defn"):
        return f"intrinsic {_function(value._defn, within)}"
    if isinstance(value, types.ExternalFunction):
        return f"external {value.symbol} {value.sig}"
    if hasattr(value, "implementation"):  # of a generic function
        return f"generic {place_of(value)}"
    chooser = getattr(value, "chooser", None)
    if chooser is not None:  # code is chosen by types: what it gives is compiled, and a need
        if any(hasattr(function, "chooser") for function in within):
            return f"overloaded {place_of(value)}"
        return f"overloaded {_function(chooser, within)}"
    function = getattr(value, "__wrapped__", value)
    known = str(getattr(value, "__module__", None)).split(".")[0] in KNOWN
    if isinstance(function, python_types.FunctionType) and not known:
        return f"function {_function(function, within)}"
    if isinstance(function, (python_types.BuiltinFunctionType, np.ufunc)) or known:
        name = getattr(value, "__name__", None) or describe_type(types.unliteral(value))
        return f"built in {name}"
    raise Unknown(repr(value))


# --- types ----------------------------------------------------------------------------------------


def describe_type(kind: Any) -> str:
    """A text for a type of numba, with places and fields of classes. Raises Unknown."""
    if kind not in _texts:
        _texts[kind] = _describe_type(kind)
    return _texts[kind]


_texts: dict[Any, str] = {}


def _describe_type(kind: Any) -> str:
    if isinstance(kind, (types.UniTuple, types.NamedUniTuple)):
        inner = [kind.dtype] * kind.count
    else:
        inner = list(getattr(kind, "types", ()))
    if hasattr(kind, "instance_class"):
        laid_out = getattr(kind, "changing", ""), getattr(kind, "in_words", "")  # of a group
        named = f"{type(kind).__name__} {_class(kind.instance_class)} {laid_out}"
        return f"{named} {[describe_type(one) for one in inner]}"
    if isinstance(kind, types.BaseTuple):
        return f"tuple {[describe_type(one) for one in inner]}"
    if isinstance(kind, types.Dispatcher):
        return describe(kind.dispatcher)
    if isinstance(kind, types.Literal):
        return f"literal {describe(kind.literal_value)}"
    if isinstance(kind, types.Omitted):
        return f"omitted {describe(kind.value)}"
    text = str(kind)
    if " at 0x" in text:
        raise Unknown(text)
    return text


# --- needs ----------------------------------------------------------------------------------------


def needs_of(function: Any) -> Iterator[str]:
    """Lines for `holds`: what must stay as it is for code that contains a function.

    A function that has no place of its own was made by another, which has its code; what it
    names in a module is described here. Raises Unknown.
    """
    try:
        yield f"function {place_of(function)} {code_of(function)}"
    except Unknown:
        named = _named(function) if function.__module__ in sys.modules else {}
        for name, value in named.items():
            if isinstance(value, python_types.ModuleType):
                for part, taken in _taken(value, _names(function.__code__)[1]).items():
                    yield f"name {value.__name__}:{part} {digest(describe(taken))}"
            else:
                yield f"name {function.__module__}:{name} {digest(describe(value))}"
    for stub, kind in getattr(function, "chosen_for", ()):
        place = "builtins:None" if kind is None else place_of(kind)
        yield f"choice {place_of(stub)} {code_of(function)} {place} {function.__module__}"


def holds(need: str) -> bool:
    """Whether what a line names is still the same."""
    try:
        what, place, word, *more = need.split(" ")
        if what == "version":  # the key has it too: here it is for what is exported
            return True
        module, name = place.split(":")
        found = _find(module, name)
        if what == "function":
            return found is not None and code_of(found) == word
        if what == "choice":
            kind, registered_in = more
            if registered_in not in sys.modules:
                importlib.import_module(registered_in)
            return code_of(found.implementation(_find(*kind.split(":")))) == word
        return digest(describe(vars(importlib.import_module(module))[name])) == word
    except (Unknown, AttributeError, KeyError, ImportError, ValueError):
        return False  # also a line as another version of this package writes it


_still = functools.cache(holds)


def still_holds(need: str) -> bool:
    """The same, looked at once in a process where nothing can change: in this package alone, since
    others may be typed in, or imported again after an edit."""
    fixed = need.startswith(("function mesokit.", "name mesokit.", "version "))
    return _still(need) if fixed else holds(need)


def named(need: str) -> str:
    """The subject of a line, in words."""
    what, place, _, *more = need.split(" ")
    if what != "choice" or len(more) < 2:
        return place
    return f"{place} for {more[0].split(':')[-1]} (in {more[1]})"
