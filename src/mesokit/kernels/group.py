"""Groups by address: a NamedTuple of arrays is one machine word in compiled code, not hundreds.

Python packs the numbers of a group, and addresses and shapes of its arrays, into one stretch of
memory; kernels take its address, and `group.field` is loaded from there. A group within a group is
an address again; numbers and small tuples are taken by value. Nothing is counted: the arrays live
as long as the packed group. Loads are marked as of memory that does not change, so that LLVM takes
them out of loops, but for the fields that a class declares as changing.
"""

import functools
import hashlib
from collections.abc import Callable, Sequence
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.errors import TypingError
from numba.core.typing import signature
from numba.core.typing.templates import AbstractTemplate, AttributeTemplate, infer_global
from numba.extending import (
    NativeValue,
    infer_getattr,
    intrinsic,
    lower_builtin,
    lower_getattr_generic,
    models,
    register_model,
    unbox,
)
from numba.np.arrayobj import populate_array

_WORD, _BYTES = ir.IntType(64), ir.IntType(8).as_pointer()
CHANGING: dict[type, tuple[str, ...]] = {}  # classes that are always packed, and what changes
_IN_WORDS: set[type] = set()  # classes of which each field takes one word


def by_address(*changing: str, in_words: bool = False) -> Callable[[type], type]:
    """Declare a class of groups that are packed even if they hold no arrays.

    `changing` are fields that kernels write anew (see `writer`). With `in_words` each field takes
    one word, a number or the address of what is longer: fields can then be hidden (see `without`).
    """

    def declare(kind: type) -> type:
        CHANGING[kind] = changing
        if in_words:
            _IN_WORDS.add(kind)
        return kind

    return declare


class Group(types.Type):
    """The type of a packed group: its class, and names and types of its fields."""

    def __init__(self, kind: Any, inner: tuple[Any, ...]) -> None:
        self.instance_class, self.fields, self.types = kind, kind._fields, inner
        self.changing, self.in_words = CHANGING.get(kind, ()), kind in _IN_WORDS
        self.offsets, self.words = {}, 0
        for name, one in zip(self.fields, inner, strict=True):
            self.offsets[name] = self.words
            self.words += 1 if self.in_words else _words_of(one)
        text = f"{kind.__module__}.{kind.__qualname__} {self.fields} {inner} {self.changing}"
        word = hashlib.sha256(text.encode()).hexdigest()[:12]
        super().__init__(name=f"{kind.__name__}.{word}")

    @property
    def key(self) -> Any:
        """Class and types of fields, as several classes may have one name."""
        return self.instance_class, self.types

    def __len__(self) -> int:
        return len(self.types)


register_model(Group)(models.OpaqueModel)


_HIDDEN = types.Opaque("hidden")  # the type of a field that a stage does not look at


def items_of(kind: Any) -> Sequence[Any]:
    """Types of the elements of a tuple."""
    uniform = isinstance(kind, (types.UniTuple, types.NamedUniTuple))
    return [kind.dtype] * kind.count if uniform else kind.types


def _words_of(kind: Any) -> int:
    if isinstance(kind, Group):
        return kind.words
    if isinstance(kind, types.BaseTuple):
        return sum(map(_words_of, items_of(kind)))
    if isinstance(kind, types.Array):
        return 1 + kind.ndim * (1 if kind.layout == "C" else 2)
    if isinstance(kind, (types.Integer, types.Float, types.Boolean)):
        return 1
    raise TypeError(f"a group cannot hold {kind}")


@functools.cache
def group_of(kind: type, inner: tuple[Any, ...]) -> Group:
    """The type of groups of a class with these types of fields."""
    return Group(kind, inner)


@unbox(Group)
def _unbox(kind: Group, thing: Any, context: Any) -> NativeValue:
    word = context.pyapi.object_getattr_string(thing, "address")
    value = context.pyapi.long_as_longlong(word)
    context.pyapi.decref(word)
    return NativeValue(context.builder.inttoptr(value, _BYTES))


@infer_getattr
class _Field(AttributeTemplate):
    key = Group

    def generic_resolve(self, kind: Group, name: str) -> Any:
        found = kind.types[kind.fields.index(name)] if name in kind.fields else None
        if found is _HIDDEN:
            raise TypingError(f"{kind.instance_class.__name__}.{name} is hidden from this stage")
        return found


@infer_global(len)
class _Length(AbstractTemplate):
    """The number of fields, as of the NamedTuple: `len(beads) > 0` is true if there are any."""

    def generic(self, given: Any, named: Any) -> Any:
        return signature(types.intp, *given) if isinstance(given[0], Group) else None


@lower_builtin(len, Group)
def _length(context: Any, builder: Any, kinds: Any, given: Any) -> Any:
    return context.get_constant(types.intp, len(kinds.args[0]))


@lower_getattr_generic(Group)
def _load_field(context: Any, builder: Any, kind: Group, value: Any, name: str) -> Any:
    inner, fixed = kind.types[kind.fields.index(name)], name not in kind.changing
    at = kind.offsets[name]
    if kind.in_words and not isinstance(inner, types.Number):
        value, at = _load_word(builder, value, at, _BYTES, True), 0
    return _load(context, builder, value, at, inner, fixed)


def _place(builder: Any, base: Any, at: int, element: Any) -> Any:
    place = builder.gep(base, [ir.Constant(_WORD, 8 * at)])
    return builder.bitcast(place, element.as_pointer())


def _load_word(builder: Any, base: Any, at: int, element: Any, fixed: bool) -> Any:
    found = builder.load(_place(builder, base, at, element), align=8)
    if fixed:
        found.set_metadata("invariant.load", builder.module.add_metadata([]))
    return found


def _load(context: Any, builder: Any, base: Any, at: int, kind: Any, fixed: bool) -> Any:
    """The value of a field that begins at a word."""
    if isinstance(kind, Group):
        return builder.gep(base, [ir.Constant(_WORD, 8 * at)])
    if isinstance(kind, types.BaseTuple):
        items = []
        for item in items_of(kind):
            items.append(_load(context, builder, base, at, item, fixed))
            at += _words_of(item)
        return context.make_tuple(builder, kind, items)
    if isinstance(kind, types.Array):
        return _load_array(context, builder, base, at, kind)
    if isinstance(kind, types.Float):
        found = _load_word(builder, base, at, ir.DoubleType(), fixed)
        return context.cast(builder, found, types.float64, kind)
    found = _load_word(builder, base, at, _WORD, fixed)
    if isinstance(kind, types.Boolean):
        return builder.icmp_unsigned("!=", found, ir.Constant(_WORD, 0))
    return builder.trunc(found, ir.IntType(kind.bitwidth)) if kind.bitwidth < 64 else found


def _load_array(context: Any, builder: Any, base: Any, at: int, kind: Any) -> Any:
    """An array, made of its address and shape; nothing counts its users."""
    element = context.get_data_type(kind.dtype)
    size = ir.Constant(_WORD, context.get_abi_sizeof(element))
    data = _load_word(builder, base, at, element.as_pointer(), True)
    shape = [_load_word(builder, base, at + 1 + k, _WORD, True) for k in range(kind.ndim)]
    if kind.layout == "C":
        strides: list[Any] = []
        step = size
        for k in range(kind.ndim - 1, -1, -1):
            strides.insert(0, step)
            step = builder.mul(step, shape[k]) if k else step
    else:
        first = at + 1 + kind.ndim
        strides = [_load_word(builder, base, first + k, _WORD, True) for k in range(kind.ndim)]
    array = context.make_array(kind)(context, builder)
    populate_array(
        array,
        data=data,
        shape=cgutils.pack_array(builder, shape, _WORD),
        strides=cgutils.pack_array(builder, strides, _WORD),
        itemsize=size,
        meminfo=None,
    )
    return array._getvalue()


def without(*names: str) -> Any:
    """The function that gives a group with some of its fields hidden.

    What is compiled for it serves all groups that differ in these fields alone. A group that is
    there by value stays as it is.
    """

    def hide(typing_context: Any, group: Any) -> Any:
        kind = group
        if isinstance(group, Group):
            pairs = zip(group.fields, group.types, strict=True)
            inner = tuple(_HIDDEN if name in names else one for name, one in pairs)
            kind = group_of(group.instance_class, inner)
        return kind(group), lambda context, builder, signature, arguments: arguments[0]

    return intrinsic(hide)


def replaced(name: str) -> Any:
    """The function (group, value) that gives a group with another value of a field, or, for None,
    the group as it is.

    The group has fields of one word each. The new one lies in the memory of the function that
    calls this, until that returns or calls it again in the same place.
    """

    def replace(typing_context: Any, group: Any, value: Any) -> Any:
        if value is types.none:
            return group(group, value), lambda context, builder, kinds, given: given[0]
        place = group.fields.index(name)
        inner = (*group.types[:place], _stored(value), *group.types[place + 1 :])
        kind = group_of(group.instance_class, inner)

        def generate(context: Any, builder: Any, kinds: Any, given: Any) -> Any:
            held = _room(builder, _words_of(value))
            _store(context, builder, held, 0, value, given[1])
            made = _room(builder, kind.words)
            _store(context, builder, made, 0, kind, given[0])
            address = _place(builder, made, kind.offsets[name], _BYTES)
            builder.store(held, address, align=8)
            # Loads are marked as of memory that does not change, and this does at the next call: so
            # each call gives a pointer that LLVM takes for another, which no load can come before.
            same = ir.FunctionType(_BYTES, [_BYTES])
            return builder.asm(same, "", "=r,0,~{memory}", [made], side_effect=True)

        return kind(group, value), generate

    return intrinsic(replace)


def _stored(kind: Any) -> Any:
    """The type of a value of compiled code once it lies in a group."""
    if not isinstance(kind, types.BaseTuple):
        return kind
    inner = tuple(map(_stored, items_of(kind)))
    holds_arrays = any(isinstance(one, (Group, types.Array)) for one in inner)
    named = getattr(kind, "instance_class", None)
    return group_of(named, inner) if named is not None and holds_arrays else kind


def _room(builder: Any, words: int) -> Any:
    room = cgutils.alloca_once(builder, ir.ArrayType(_WORD, max(1, words)))
    return builder.bitcast(room, _BYTES)


def _store(context: Any, builder: Any, base: Any, at: int, kind: Any, value: Any) -> int:
    """Write a value to memory, as `_flatten` does; the word after it."""
    if isinstance(kind, Group):
        for word in range(kind.words):
            found = _load_word(builder, value, word, _WORD, False)
            builder.store(found, _place(builder, base, at + word, _WORD), align=8)
        return at + kind.words
    if isinstance(kind, types.BaseTuple):
        for place, inner in enumerate(items_of(kind)):
            item = builder.extract_value(value, place)
            at = _store(context, builder, base, at, inner, item)
        return at
    if isinstance(kind, types.Array):
        array = context.make_array(kind)(context, builder, value)
        words = [builder.ptrtoint(array.data, _WORD), *cgutils.unpack_tuple(builder, array.shape)]
        words += cgutils.unpack_tuple(builder, array.strides) if kind.layout != "C" else []
        for place, word in enumerate(words, at):
            builder.store(word, _place(builder, base, place, _WORD), align=8)
        return at + len(words)
    wide = types.float64 if isinstance(kind, types.Float) else types.int64
    element = context.get_data_type(wide)
    found = context.cast(builder, value, kind, wide)
    builder.store(found, _place(builder, base, at, element), align=8)
    return at + 1


@intrinsic
def put_value(typing_context: Any, place: Any, value: Any) -> Any:
    """Write a value to an address: each of its numbers, in order, in a word."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        base = builder.inttoptr(arguments[0], _BYTES)
        _store(context, builder, base, 0, signature.args[1], arguments[1])
        return context.get_dummy_value()

    return types.void(types.int64, value), generate


def value_at(kind: Any) -> Any:
    """The function that reads a value of a type from an address, as `put_value` writes it."""

    def load(typing_context: Any, place: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            return _load(context, builder, builder.inttoptr(arguments[0], _BYTES), 0, kind, True)

        return kind(types.int64), generate

    return intrinsic(load)


def words_in(kind: Any) -> int:
    """The number of words of a value of a type."""
    return _words_of(kind)


def writer(name: str) -> Any:
    """The function (group, number) that writes a field anew, which the class declares as changing.

    The field is a whole number, or a tuple whose first element is.
    """

    def write(typing_context: Any, group: Any, number: Any) -> Any:
        if not isinstance(group, Group) or name not in group.changing:
            return None

        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            kind = signature.args[0]
            place = _place(builder, arguments[0], kind.offsets[name], _WORD)
            builder.store(arguments[1], place, align=8)
            return context.get_dummy_value()

        return types.void(group, types.int64), generate

    return intrinsic(write)
