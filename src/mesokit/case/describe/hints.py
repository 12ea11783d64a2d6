"""Type hints of components: as type checkers see them, and as `help` shows them."""

import dataclasses
import inspect
import re
import typing
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Generic, TypeVar

T = TypeVar("T")
A = TypeVar("A")

# Fields that are given as lists, tuples or arrays, and are tuples ever after. For type
# checkers they may be set to any iterable and are read as tuples, which no plain hint expresses.
if TYPE_CHECKING:

    class Many(Generic[T]):
        """Any number of T."""

        def __get__(self, owner: Any, kind: Any = None) -> tuple[T, ...]: ...
        def __set__(self, owner: Any, values: Iterable[T]) -> None: ...

    class Either(Generic[A, T]):
        """An A, or any number of T."""

        def __get__(self, owner: Any, kind: Any = None) -> A | tuple[T, ...]: ...
        def __set__(self, owner: Any, values: A | Iterable[T]) -> None: ...

else:

    class Many:
        """Any number of T.

        >>> Many[float]
        tuple[float, ...]
        """

        def __class_getitem__(cls, one: Any) -> Any:
            return tuple[one, ...]

    class Either:
        """An A, or any number of T.

        >>> Either[None, float]
        typing.Optional[tuple[float, ...]]
        """

        def __class_getitem__(cls, both: tuple[Any, Any]) -> Any:
            return typing.Union[both[0], tuple[both[1], ...]]  # noqa: UP007  of texts too


class _Plain(str):
    """A text that a signature shows without quotes."""

    __repr__ = str.__str__


def text_of(hint: Any) -> str:
    """A type hint in few words.

    >>> text_of(tuple[float, ...] | None), text_of(inspect.Signature)
    ('tuple[float, ...] | None', 'Signature')
    """
    text = re.sub(r"\b(?:[A-Za-z_]\w*\.)+(?=[A-Za-z_])", "", inspect.formatannotation(hint))
    return re.sub(r"^Optional\[(.*)\]$", r"\1 | None", text)


def show_signature(made: Any, shown: dict[str, Any]) -> None:
    """Give a component a signature that can be read.

    `shown` are the hints of fields as they were written, before the rules for their values. A
    parameter that is required after one with a default is given by name.
    """
    parameters: list[inspect.Parameter] = []
    by_name = False
    for field in sorted(dataclasses.fields(made), key=lambda field: bool(field.kw_only)):
        about = made.__pydantic_fields__[field.name]
        needed = about.is_required()
        by_name |= bool(field.kw_only) or (
            needed and any(p.default is not p.empty for p in parameters)
        )
        extra = about.json_schema_extra if isinstance(about.json_schema_extra, dict) else {}
        default = _default(extra.get("unless_said", about.default))
        parameters.append(
            inspect.Parameter(
                field.name,
                inspect.Parameter.KEYWORD_ONLY
                if by_name
                else inspect.Parameter.POSITIONAL_OR_KEYWORD,
                default=inspect.Parameter.empty if needed else default,
                annotation=_Plain(text_of(shown.get(field.name, Any))),
            )
        )
    myself = inspect.Parameter("self", inspect.Parameter.POSITIONAL_ONLY)
    made.__signature__ = inspect.Signature(parameters)
    made.__init__.__signature__ = inspect.Signature([myself, *parameters])


def _default(value: Any) -> Any:
    """A default as a user would write it: components without what they have by themselves."""
    if not dataclasses.is_dataclass(value):
        return value
    given = inspect.signature(type(value)).parameters.values()
    own = [p.name for p in given if getattr(value, p.name) != p.default]
    words = ", ".join(f"{name}={getattr(value, name)!r}" for name in own)
    return _Plain(f"{type(value).__name__}({words})")
