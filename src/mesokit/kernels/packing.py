"""Groups as kernels take them: their numbers and the addresses of their arrays, in one memory."""

import struct
from collections.abc import Iterable
from typing import Any

import numpy as np
from numba import typeof, types
from numba.extending import typeof_impl

from mesokit.kernels.group import CHANGING, Group, group_of, items_of

OWNS = 4  # the bit of an array's flags that says that the memory is its own


def _is_packed(value: Any) -> bool:
    """Whether a value holds arrays, or is of a class that is always packed."""
    if isinstance(value, np.ndarray) or type(value) in CHANGING:
        return True
    return isinstance(value, tuple) and any(map(_is_packed, value))


def kind_of(value: Any) -> Any:
    """The numba type of a value as kernels take it."""
    if isinstance(value, tuple) and _is_packed(value):
        inner = tuple(map(kind_of, value))
        return group_of(type(value), inner) if hasattr(value, "_fields") else types.Tuple(inner)
    if type(value) is np.ndarray:
        key = value.dtype, value.ndim, value.flags.num & ~OWNS
        if key not in _arrays:
            _arrays[key] = typeof(value)
        return _arrays[key]
    return typeof(value)


_arrays: dict[Any, Any] = {}  # types of arrays: numba takes long to find them


class Packed:
    """A group in memory, with the fields of the group that it was made of.

    Examples
    --------
    >>> from typing import NamedTuple
    >>> class Row(NamedTuple):
    ...     scale: float
    ...     values: np.ndarray
    >>> row = packed(Row(2.0, np.ones(3)))
    >>> row.scale, len(row.memory)  # the scale; address and length of the array
    (2.0, 3)
    """

    def __init__(self, value: Any, kind: Any = None) -> None:
        self.value, self._numba_type_ = value, kind or kind_of(value)
        self._apart: list[Any] = []  # what fields of one word are addresses of
        self.memory = _in_memory(value, self._numba_type_, self._apart)
        self.address = self.memory.ctypes.data

    def __getattr__(self, name: str) -> Any:
        return getattr(self.value, name)


def _in_memory(value: Any, kind: Any, apart: list[Any]) -> Any:
    """The words of a value; what fields of one word are addresses of is added to `apart`."""
    numbers: list[Any] = []
    formats: list[str] = []
    _flatten(value, kind, numbers, formats, apart)
    words = struct.pack("=" + "".join(formats), *numbers)
    return np.frombuffer(bytearray(words or bytes(8)), np.int64)


def _flatten(
    value: Any, kind: Any, numbers: list[Any], formats: list[str], apart: list[Any]
) -> None:
    """Add the words of a value, and the letters of `struct` for them."""
    if isinstance(kind, Group):
        for one, inner in zip(value, kind.types, strict=True):
            if kind.in_words and not isinstance(inner, types.Number):
                apart.append(_in_memory(one, inner, apart))
                numbers.append(apart[-1].ctypes.data)
                formats.append("q")
            else:
                _flatten(one, inner, numbers, formats, apart)
    elif isinstance(kind, types.BaseTuple):
        for one, inner in zip(value, items_of(kind), strict=True):
            _flatten(one, inner, numbers, formats, apart)
    elif isinstance(kind, types.Array):
        words = (value.ctypes.data, *value.shape, *(value.strides if kind.layout != "C" else ()))
        numbers.extend(words)
        formats.append("q" * len(words))
    else:
        numbers.append(value)
        signed = getattr(kind, "signed", True)
        formats.append("d" if isinstance(kind, types.Float) else "q" if signed else "Q")


def packed(value: Any) -> Any:
    """A group as kernels take it; other values stay as they are."""
    return Packed(value) if hasattr(value, "_fields") and _is_packed(value) else value


def all_packed(values: Iterable[Any]) -> tuple[Any, ...]:
    """Arguments of a kernel, their groups packed."""
    return tuple(packed(value) for value in values)


class Packing:
    """Groups of one owner, as kernels take them: packed anew only where one is made of others.

    The owner keeps it, so that no array outlives its owner.

    Examples
    --------
    >>> from typing import NamedTuple
    >>> class Row(NamedTuple):
    ...     scale: float
    ...     values: np.ndarray
    >>> packing, values = Packing(), np.ones(3)
    >>> [first] = packing(Row(2.0, values))
    >>> packing(Row(2.0, values))[0] is first, packing(Row(3.0, values))[0] is first
    (True, False)
    """

    def __init__(self) -> None:
        self._known: dict[type, Packed] = {}

    def __call__(self, *values: Any) -> tuple[Any, ...]:
        return tuple(map(self._one, values))

    def _one(self, value: Any) -> Any:
        known = self._known.get(type(value))
        if known is not None and _is_same(known.value, value):
            return known
        if known is not None and _is_alike(known.value, value):
            made = Packed(value, known._numba_type_)
        else:
            made = packed(value)
        if isinstance(made, Packed):
            self._known[type(value)] = made
        return made


def _is_same(one: Any, other: Any) -> bool:
    """Whether two values hold the same arrays and equal numbers; of groups that kernels change,
    whether they are one."""
    if one is other:
        return True
    if type(one) is not type(other) or isinstance(one, np.ndarray) or CHANGING.get(type(one)):
        return False
    if isinstance(one, tuple):
        return len(one) == len(other) and all(map(_is_same, one, other))
    return bool(one == other)


def _is_alike(one: Any, other: Any) -> bool:
    """Whether two values have the same type in compiled code: much faster than to find that."""
    if type(one) is not type(other):
        return False
    if isinstance(one, np.ndarray):
        if one.dtype != other.dtype or one.ndim != other.ndim:
            return False
        return not (one.flags.num ^ other.flags.num) & ~OWNS
    if isinstance(one, tuple):
        return len(one) == len(other) and all(map(_is_alike, one, other))
    return True


@typeof_impl.register(Packed)
def _(value: Packed, context: Any) -> Any:
    return value._numba_type_
