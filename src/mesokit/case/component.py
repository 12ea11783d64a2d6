"""Base of every part of a case: a frozen dataclass that checks its values.

A component is at once the Python object, the section of the case file, the stored metadata and
the row of the documentation. Write plain type hints: numbers are taken strictly (no strings, no
booleans; a whole float passes as an int), lists and arrays become tuples, unions of components
are distinguished by their tag (such as `rule` or `quantity`), unknown keys are refused.
"""

import contextlib
import dataclasses
import difflib
import functools
import math
import numbers
import operator
import re
import types
import typing
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar, dataclass_transform

import pydantic
from pydantic import BeforeValidator, ConfigDict, Field, ValidationError
from pydantic_core import PydanticCustomError

from mesokit.case.describe.hints import show_signature
from mesokit.case.describe.keys import Documented
from mesokit.case.describe.plain import TAGS
from mesokit.case.registry import FAMILIES, Family, register
from mesokit.errors import CaseError

T = TypeVar("T")


MANY = 12  # names, more than which are not listed where one of them is near


def param(default: Any = ..., *, doc: str, unit: str = "", **limits: Any) -> Any:
    """A field of a component: default (none: required), one-line meaning, unit, gt/ge/lt/le.

    `symbol` is written in formulas and figures; `unless_said` stands for a default that is no
    value.
    """
    extra: dict[str, Any] = {"unit": unit}
    extra |= {key: limits.pop(key) for key in ("symbol", "unless_said") if key in limits}
    return Field(default, description=doc, json_schema_extra=extra, **limits)


def option(*, default: Any, doc: str, kw_only: Literal[True], unit: str = "", **limits: Any) -> Any:
    """A field that is only given by name, which type checkers read from `kw_only`."""
    return param(default, doc=doc, kw_only=kw_only, unit=unit, **limits)


def tag(value: str, *, init: Literal[False] = False) -> Any:
    """The field, one of TAGS, whose value names the component in a case file.

    Python code does not give it, and type checkers (`init`) do not offer it.
    """
    return Field(value, description="name of the component", kw_only=True)


@dataclass_transform(frozen_default=True, field_specifiers=(tag, option))
def component(cls: type[T]) -> type[T]:
    """Make a class a frozen, validated dataclass that raises CaseError for bad values.

    Examples:
        >>> @component
        ... class Spring:
        ...     stiffness: float = param(1.0, doc="spring constant", unit="kT/a^2", gt=0)
        >>> Spring(stiffness=-1)
        Traceback (most recent call last):
        mesokit.errors.CaseError: Spring.stiffness = -1: expected a number above 0
    """
    hints = typing.get_type_hints(cls, include_extras=True)
    plain = typing.get_type_hints(cls)
    cls.__annotations__ = {name: strict(hints[name]) for name in cls.__annotations__}
    config = ConfigDict(extra="forbid", allow_inf_nan=False, validate_default=True)
    made = pydantic.dataclasses.dataclass(cls, frozen=True, config=config)
    validated_init = made.__init__

    @functools.wraps(validated_init)
    def __init__(self: Any, *args: Any, **kwargs: Any) -> None:
        try:
            validated_init(self, *args, **kwargs)
        except ValidationError as error:
            raise CaseError(first_line(made, error, start=made.__name__)) from None

    setattr(made, "__init__", __init__)  # noqa: B010 (mypy forbids assigning to a method)
    setattr(made, "__doc__", Documented(made.__doc__))  # noqa: B010
    made.__annotations__ = {name: plain[name] for name in made.__annotations__}
    show_signature(made, plain)
    if found := tag_of(made):
        register(typing.cast(type, made), found[1])
    return typing.cast(type[T], made)


def is_component(hint: Any) -> bool:
    """Whether a type is a component."""
    return isinstance(hint, type) and hasattr(hint, "__pydantic_fields__")


def tag_of(cls: Any) -> tuple[str, str] | None:
    """The tag field of a component and its value, such as ("rule", "srd")."""
    names = [field.name for field in dataclasses.fields(cls) if field.name in TAGS]
    return (names[0], cls.__pydantic_fields__[names[0]].default) if names else None


def name_of(part: Any) -> str:
    """The name of a component in a case file: the value of its tag."""
    found = tag_of(type(part))
    assert found is not None, f"{type(part).__name__} has no tag"
    return found[1]


def build(
    cls: type[T],
    values: dict[str, Any],
    rename: dict[str, str] | None = None,
    folder: Path | None = None,
) -> T:
    """A component from nested dictionaries, as read from a case file.

    `rename` maps field names of the outermost component to the keys to show in messages; file
    names are relative to `folder`, or to the working directory.
    Raises CaseError with the full key path, the given value and what was expected.
    """
    try:
        return pydantic.TypeAdapter(cls).validate_python(values, context={"folder": folder})
    except ValidationError as error:
        raise CaseError(first_line(cls, error, rename or {})) from None


# --- type hints ---------------------------------------------------------------------------------


def strict(hint: Any) -> Any:
    """Type hint with the rules for numbers, lists and tagged unions added to it."""
    if hint is float:
        return Annotated[float, BeforeValidator(_real)]
    if hint is int:
        return Annotated[int, BeforeValidator(_whole)]
    if hint is bool:
        return Annotated[bool, BeforeValidator(_truth)]
    if isinstance(hint, type) and hint in FAMILIES:
        return Annotated[Any, FAMILIES[hint]]
    origin, args = typing.get_origin(hint), typing.get_args(hint)
    if origin is tuple:
        inner = tuple(arg if arg is Ellipsis else strict(arg) for arg in args)
        return Annotated[tuple[inner], BeforeValidator(_list)]  # type: ignore[valid-type]
    if origin in (typing.Union, types.UnionType):
        members = [arg for arg in args if is_component(arg)]
        if len(members) > 1:
            field = tag_of(members[0])
            assert field is not None, f"{members[0].__name__} has no tag"
            union = functools.reduce(operator.or_, members)
            tagged = Annotated[union, Field(discriminator=field[0])]  # type: ignore[valid-type]
            others = (arg for arg in args if arg not in members)
            return functools.reduce(operator.or_, others, tagged)
        return functools.reduce(operator.or_, map(strict, args))
    return hint


def _real(value: Any) -> float:
    if not isinstance(value, numbers.Real) or isinstance(value, bool):
        raise PydanticCustomError("number", "expected a number")
    with contextlib.suppress(OverflowError):
        if math.isfinite(number := float(value)):
            return number
    raise PydanticCustomError("number", "expected a finite number")


def _whole(value: Any) -> int:
    if isinstance(value, numbers.Real) and not isinstance(value, bool):
        whole: Any = int(value) if isinstance(value, numbers.Integral) else float(value)
        if not abs(whole) < 2**63:
            raise PydanticCustomError("whole", "expected a whole number of at most 63 bits")
        if whole == int(whole):
            return int(whole)
    raise PydanticCustomError("whole", "expected a whole number")


def _truth(value: Any) -> bool:
    if isinstance(value, bool):
        return value
    raise PydanticCustomError("truth", "expected true or false")


def _list(value: Any) -> Any:
    if isinstance(value, str) or not isinstance(value, Iterable) or isinstance(value, dict):
        raise PydanticCustomError("list", "expected a list")
    return tuple(value)


# --- messages -----------------------------------------------------------------------------------


def first_line(
    cls: Any, error: ValidationError, rename: dict[str, str] | None = None, start: str = ""
) -> str:
    """The most telling of the errors as one line: key path, value, what was expected."""
    first = min(error.errors(), key=lambda e: not _is_unknown(e))  # a typo explains the rest
    path, holder, here = _walk(cls, first["loc"], rename or {}, start)
    kind, given, context = first["type"], first["input"], first.get("ctx", {})
    if _is_unknown(first):
        meant = _meant(holder, str(first["loc"][-1]), rename if holder is cls else None)
        return f"{path}: unknown key{meant}"
    if kind in ("missing", "missing_argument"):
        return f"{path}: missing; it has no default"
    if kind in ("union_tag_not_found", "union_tag_invalid"):
        tag = str(context["discriminator"]).strip("'")
        path += f".{tag}"
        if kind == "union_tag_invalid":
            return f"{path} = {show(context['tag'])}: {_tag(context['tag'], here, path)}"
        close = difflib.get_close_matches(tag, map(str, given), 1, 0.7)
        hint = f"; is {close[0]!r} meant to be it?" if close else ""
        return f"{path}: missing{hint}; expected {one_of(names_of(here))}"
    words = _expected(first)
    parts = _members(here if first["loc"] else cls)
    key = re.match(r"(\w+)(\[#\d+\])?(\.| = |: )", words) if kind == "value_error" else None
    if key and any(key[1] in part.__pydantic_fields__ for part in parts):  # it names the key itself
        return f"{path}.{words}" if path else words
    if words == TABLE and isinstance(given, str) and (named := tag_of(parts[0]) if parts else None):
        names = names_of(here if first["loc"] else cls)
        close = difflib.get_close_matches(given, names, 1, 0.5) or names[:1]
        words += f", such as {{ {named[0]} = {show(close[0])} }}"
    if not first["loc"]:  # a check of the whole component
        return f"{path}: {words}" if path else words
    return f"{path} = {show(given)}: {words}"


def _meant(holder: Any, key: str, rename: dict[str, str] | None) -> str:
    """The keys that may have been meant by an unknown one, and if another part has it, whose."""
    known = known_keys(holder, rename)
    listed = f"; valid here: {', '.join(known)}"
    families = [found for base, found in FAMILIES.items() if issubclass(holder, base)]
    others = [part.__pydantic_fields__ for found in families for part in found.parts.values()]
    theirs = [_hint_of(fields[key]) for fields in others if key in fields]
    named = tag_of(holder)
    if not theirs or named is None:
        return nearest(key, known) or listed
    own = {name: _hint_of(field) for name, field in holder.__pydantic_fields__.items()}
    alike = [name for name, hint in own.items() if hint in theirs and _members(hint)]
    meant = f"; did you mean {one_of(alike)}?" if alike else nearest(key, known, 0.7) or listed
    return f" of {named[0]} {show(named[1])}{meant}"


def known_keys(cls: Any, rename: dict[str, str] | None = None) -> list[str]:
    """The keys that a component takes in a case file."""
    return [(rename or {}).get(f.name, f.name) for f in dataclasses.fields(cls)]


def nearest(given: str, known: Iterable[str], likeness: float = 0.5) -> str:
    """'; did you mean X?' for the closest valid name, or nothing."""
    close = closest(given, known, likeness)
    return f"; did you mean {show(close)}?" if close else ""


def closest(given: str, known: Iterable[str], likeness: float) -> str:
    """The name that is most like a word, first of all its plural; "" if none is so much like it.

    >>> closest("bodys", ["bonds", "bodies"], 0.75)
    'bodies'
    """
    plain = {name.lower().replace("_", "-"): name for name in known}
    word = given.lower().replace("_", "-")
    same = [name for name in plain if _singular(name) == _singular(word)]
    near = same or difflib.get_close_matches(word, plain, 1, likeness)
    return plain[near[0]] if near else ""


def _singular(name: str) -> str:
    return name[:-3] + "y" if name.endswith("ies") else name.removesuffix("s")


def require_known(given: Iterable[str], known: Sequence[str]) -> None:
    """Raise CaseError for a name that is not known.

    >>> require_known(["regoin"], ["region", "window"])
    Traceback (most recent call last):
        ...
    mesokit.errors.CaseError: regoin: unknown; expected 'region' or 'window'; did you mean 'region'?
    """
    for name in given:
        if name not in known:
            raise CaseError(f"{name}: unknown; expected {one_of(known)}{nearest(name, known)}")


def one_of(names: Sequence[str]) -> str:
    """'a', 'b' or 'c'."""
    quoted = [show(name) for name in names]
    return quoted[0] if len(quoted) == 1 else f"{', '.join(quoted[:-1])} or {quoted[-1]}"


def show(value: Any, longest: int = 60) -> str:
    """A value as the user would write it, cut to a readable length."""
    if isinstance(value, bool):
        text = str(value).lower()
    elif isinstance(value, dict):
        text = "{" + ", ".join(f"{_printable(k)} = {show(v)}" for k, v in value.items()) + "}"
    elif isinstance(value, list | tuple):
        text = "[" + ", ".join(show(v) for v in value) + "]"
    elif isinstance(value, float):
        text = f"{value:.12g}"
    else:
        text = " ".join(repr(value).split())
    return text if len(text) <= longest else text[: longest - 3] + "..."


def _printable(key: str) -> str:
    return key if key.isprintable() else repr(key)


def _is_unknown(entry: Any) -> bool:
    return entry["type"] in ("extra_forbidden", "unexpected_keyword_argument")


def _choice(given: Any, known: Sequence[str]) -> str:
    near = nearest(str(given), known)
    if near and len(known) > MANY:
        return near.removeprefix("; ")
    return f"expected {one_of(known)}{near}"


def _tag(given: Any, hint: Any, path: str) -> str:
    """The tags that were expected; a hint at `--import` if the given one is like none of them."""
    known = names_of(hint)
    section = next((key for key in re.split(r"[.\[]", path) if key[:1].islower()), "")
    names = f"one of {len(known)} names, which `mesokit explain {section}` lists"
    if len(known) <= MANY:
        names = one_of(known)
    if not isinstance(given, str):
        return f"expected a text in quotes, {names}"
    several = len(known) > MANY and not nearest(given, known)
    words = f"expected {names}" if several else _choice(given, known)
    groups = {family.group for family in _families(hint)}
    elsewhere = any(given in one.parts for one in FAMILIES.values() if one.group in groups)
    if groups and not elsewhere and not difflib.get_close_matches(given, known, 1, 0.6):
        words += "; your own parts need mesokit --import MODULE"
    return words


def _families(hint: Any) -> list[Family]:
    """The families that a type hint names, to which users can add parts."""
    if isinstance(hint, Family):
        return [hint]
    return [found for arg in typing.get_args(hint) for found in _families(arg)]


def _walk(
    cls: Any, loc: Sequence[int | str], rename: dict[str, str], start: str
) -> tuple[str, Any, Any]:
    """Key path as the user wrote it, the component with the last key, and the type of the key."""
    if loc and isinstance(loc[0], int):  # a positional argument in Python
        names = [name for name in cls.__pydantic_fields__ if name not in TAGS]
        loc = (names[loc[0]] if loc[0] < len(names) else "?", *loc[1:])
    path, here, holder = start, cls, cls
    for item in loc:
        if isinstance(item, int):
            path += f"[#{item + 1}]"
            continue
        options = _members(here)
        tagged = [c for c in options if (tag_of(c) or ("", ""))[1] == item]
        if tagged and not is_component(here):  # a step that only names the member of a union
            here = tagged[0]
            continue
        if options:
            holder = options[0]
        elif here is not cls and isinstance(item, str) and typing.get_origin(here) is not dict:
            continue  # a branch of a union of plain types
        shown = rename.get(item, item) if holder is cls else item
        path += ("." if path else "") + _printable(shown)
        fields = holder.__pydantic_fields__
        here = _hint_of(fields[item]) if item in fields else None
    return path, holder, here


def _hint_of(field: Any) -> Any:
    """The type hint of a field with its family, which pydantic keeps in the metadata."""
    families = [mark for mark in field.metadata if isinstance(mark, Family)]
    return Annotated[field.annotation, families[0]] if families else field.annotation


def names_of(hint: Any) -> list[str]:
    """The tags by which a case file can choose among the components of a type hint."""
    if isinstance(hint, Family):
        return hint.names()
    if is_component(hint):
        return [name[1] for name in [tag_of(hint)] if name]
    return [name for arg in typing.get_args(hint) for name in names_of(arg)]


def _members(hint: Any) -> list[Any]:
    """The components that a type hint names."""
    if is_component(hint):
        return [hint]
    if isinstance(hint, Family):
        return list(hint.parts.values())
    return [found for arg in typing.get_args(hint) for found in _members(arg)]


TABLE = "expected a table"
_LIMITS = {
    "greater_than": ("gt", "a number above"),
    "greater_than_equal": ("ge", "a number of at least"),
    "less_than": ("lt", "a number below"),
    "less_than_equal": ("le", "a number of at most"),
    "string_too_short": ("min_length", "a longer text, length at least"),
    "too_short": ("min_length", "a longer list, length at least"),
    "too_long": ("max_length", "a shorter list, length at most"),
}


def _expected(entry: Any) -> str:
    kind, context = entry["type"], entry.get("ctx", {})
    if kind in _LIMITS:
        key, words = _LIMITS[kind]
        return f"expected {words} {context[key]:g}"
    if kind == "literal_error":
        names = [name.strip(" '") for name in context["expected"].replace(" or ", ",").split(",")]
        return _choice(entry["input"], names)
    if kind == "value_error":
        return str(context["error"])
    return {
        "dataclass_type": TABLE,
        "string_type": "expected a text in quotes",
        "model_attributes_type": TABLE,
    }.get(kind, str(entry["msg"]))
