"""Families of parts, such as collision rules, and which parts there are of each.

A part is registered by being defined: a component that is a subclass of its family's base. Those of
mesokit are files in one folder: a case imports those that it names, a list of parts all of them.
Others are defined by a script before it builds a case, or brought by an installed package whose
entry point says where. Entry points are looked up and loaded only where a case names a part that is
not known yet.
"""

from __future__ import annotations

import functools
import importlib
import pkgutil
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any, TypeVar

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler, ValidationError, ValidationInfo
from pydantic_core import CoreSchema, InitErrorDetails, PydanticCustomError, core_schema

from mesokit.case.methods import METHODS
from mesokit.errors import CaseError

if TYPE_CHECKING:
    from importlib import metadata

T = TypeVar("T", bound=type)


class Family:
    """All parts of one sort, by the value of their tag.

    `title` is what messages call one of them, `tag` the key that names it in a case file, `group`
    that of the entry points by which packages bring more; `functions` is a hint of what to do with
    a function.
    """

    def __init__(self, base: type, title: str, tag: str, group: str, functions: str = "") -> None:
        self.base, self.title, self.tag, self.group = base, title, tag, group
        self.functions = functions
        self.packages: list[str] = []  # the folders of mesokit that have its parts
        self.known: dict[str, type[Any]] = {}  # the parts that are imported so far, by name
        self._described = False  # while its schema is made

    @property
    def parts(self) -> dict[str, type[Any]]:
        """All parts by name, whichever was imported first: those of the family's folders in
        alphabetical order, then others of mesokit, then those of scripts and packages."""
        for package in self.packages:
            for module in sorted(_modules(package)):
                importlib.import_module(f"{package}.{module}")

        def rank(name: str) -> tuple[int, str]:
            module = self.known[name].__module__
            if module.rpartition(".")[0] in self.packages:
                return 0, name
            return (1, name) if module.split(".")[0] == "mesokit" else (2, "")

        self.known = {name: self.known[name] for name in sorted(self.known, key=rank)}
        return self.known

    def add(self, name: str, part: type) -> None:
        """Register a part. Raises CaseError if another has its name."""
        known = self.known.get(name)
        if known is not None and address(known) != address(part):
            raise CaseError(
                f"{address(part)}: {self.title} {name!r} is {address(known)} already; choose "
                f"another {self.tag}"
            )
        self.known[name] = part

    def names(self) -> list[str]:
        """Names for case files, those of parts of installed packages included."""
        brought = [e.name for e in self._entries() if self._may_have(e)]
        return list(dict.fromkeys([*self.parts, *brought]))

    def find(self, name: str) -> type | None:
        """The part of that name, None if there is none. Raises CaseError if it cannot be loaded."""
        if name not in self.known:
            self._import(name)
        if name not in self.known and name not in self.parts:
            self._load(name)
        if name not in self.known:  # a part of another method: its check names those of the case
            for method in METHODS.values():
                importlib.import_module(method)
            self._import(name)
        return self.known.get(name)

    def _import(self, name: str) -> None:
        """Import the file that is named after a part; a file may have parts of other names too."""
        module = name.replace("-", "_").replace("+", "_plus_")
        for package in self.packages:
            if name not in self.known and module in _modules(package):
                importlib.import_module(f"{package}.{module}")

    def brought_by(self, name: str) -> Mapping[str, str]:
        """Distribution and version that have an entry point for a part; {} for a script's."""
        place = address(self.known[name])
        for entry in self._entries():
            if entry.name == name and entry.value.replace(" ", "") == place and entry.dist:
                return {"distribution": entry.dist.name, "version": entry.dist.version}
        return {}

    def _entries(self) -> Iterable[metadata.EntryPoint]:
        from importlib import metadata

        return metadata.entry_points(group=self.group)

    def _load(self, name: str) -> None:
        entries = [entry for entry in self._entries() if entry.name == name]
        if not entries:
            return
        sources = sorted(
            {f"{e.dist.name} {e.dist.version}" if e.dist else e.value for e in entries}
        )
        if len(sources) > 1:
            raise CaseError(
                f"{self.title} {name!r} is brought by {' and by '.join(sources)}; remove one"
            )
        try:
            entries[0].load()
        except CaseError:
            raise
        except Exception as error:
            reason = " ".join(f"{type(error).__name__}: {error}".split())
            raise CaseError(
                f"{self.title} {name!r} of {sources[0]} cannot be loaded: {reason}"
            ) from error
        part = self.known.get(name)
        if part is not None and (missing := sorted(getattr(part, "__abstractmethods__", ()))):
            del self.known[name]
            raise CaseError(
                f"{self.title} {name!r} of {sources[0]}: {address(part)} lacks {', '.join(missing)}"
            )
        if part is None and self._may_have(entries[0]):
            raise CaseError(
                f"entry point {name!r} of {sources[0]}: {entries[0].value} is no {self.title} with "
                f"{self.tag} = {name!r}"
            )

    def _may_have(self, entry: metadata.EntryPoint) -> bool:
        """True if no family of the same group has the part."""
        others = [f for f in FAMILIES.values() if f.group == self.group]
        return not any(entry.name in family.parts for family in others)

    # --- validation -----------------------------------------------------------------------------

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return core_schema.with_info_plain_validator_function(self._validated)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """One of the parts by their tag, those that packages bring included.

        Within a part that has another of its family in it, only those that have none.
        """
        within = self._described
        known: dict[Any, Any] = {}
        for name in self.names():
            part: Any = self.find(name)
            fields = part.__pydantic_fields__.values() if part else ()
            nested = any(self in (field.annotation, *field.metadata) for field in fields)
            if part and not (within and nested):
                known[name] = part.__pydantic_core_schema__
        self._described = True
        try:
            return handler(core_schema.tagged_union_schema(known, self.tag))
        finally:
            self._described = within

    def _validated(self, value: Any, info: ValidationInfo) -> Any:
        """A part as it is, or built from a table that names it."""
        if isinstance(value, self.base):
            if type(value) not in self.known.values():
                raise PydanticCustomError(
                    "part", f"{address(type(value))} lacks @component, or was defined anew"
                )
            return value
        if isinstance(value, type):
            raise PydanticCustomError(
                "part", f"expected an object, as {value.__name__}(...) is one"
            )
        if callable(value) and self.functions:
            raise PydanticCustomError("part", f"expected no function; {self.functions}")
        if not isinstance(value, Mapping):
            self._refuse_of_the_same_name(value)
            raise PydanticCustomError("dataclass_type", "expected a table")
        if self.tag in value:
            name = value[self.tag]
        elif len(self.parts) == 1:
            (name,) = self.parts
        else:
            raise PydanticCustomError("union_tag_not_found", "", {"discriminator": self.tag})
        try:
            part = self.find(name) if isinstance(name, str) else None
        except CaseError as error:
            raise PydanticCustomError("part", "{reason}", {"reason": str(error)}) from None
        if part is None:
            context = {"discriminator": self.tag, "tag": name}
            raise PydanticCustomError("union_tag_invalid", "", context)
        if missing := sorted(getattr(part, "__abstractmethods__", ())):
            reason = f"{address(part)} lacks {', '.join(missing)}"
            raise PydanticCustomError("part", "{reason}", {"reason": reason})
        try:
            return part.__pydantic_validator__.validate_python(value, context=info.context)  # type: ignore[attr-defined]
        except ValidationError as error:
            under_name: list[InitErrorDetails] = [
                {
                    "type": PydanticCustomError(entry["type"], entry["msg"], entry.get("ctx")),
                    "loc": (name, *entry["loc"]),
                    "input": entry["input"],
                }
                for entry in error.errors()
            ]
            raise ValidationError.from_exception_data(error.title, under_name) from None

    def _refuse_of_the_same_name(self, value: Any) -> None:
        """Raise an error that names the class meant, where a part of another family is given."""
        name = getattr(value, self.tag, None) if hasattr(value, "__pydantic_fields__") else None
        part = self.find(name) if isinstance(name, str) and name in self.parts else None
        if part is not None:
            words = f"expected {part.__name__}(...); {type(value).__name__} is of another section"
            raise PydanticCustomError("part", "{reason}", {"reason": words})


FAMILIES: dict[type, Family] = {}


def family(title: str, tag: str, group: str, functions: str = "") -> Callable[[T], T]:
    """Make a class the base of a family of parts."""

    def decorate(base: T) -> T:
        FAMILIES[base] = Family(base, title, tag, group, functions)
        return base

    return decorate


def register(part: type, name: str) -> None:
    """Add a component to the families whose base it is a subclass of."""
    for base, found in FAMILIES.items():
        if issubclass(part, base):
            found.add(name, part)


def family_of(part: Any) -> Family:
    """The family of a component, the first of several."""
    return next(found for base, found in FAMILIES.items() if isinstance(part, base))


def parts_in(package: str, **lists: type[Any]) -> Callable[[str], tuple[type[Any], ...]]:
    """Let families look for parts in the files of a package, by the bases of the families.

    Returns the `__getattr__` of the package: each list, by its name, has all parts of a family that
    the files define. All of them are imported when a list is first used.
    """
    for base, found in FAMILIES.items():
        if not set(base.__mro__).isdisjoint(lists.values()):
            found.packages.append(package)

    def listed(name: str) -> tuple[type[Any], ...]:
        if name not in lists:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        found = FAMILIES[lists[name]].parts.values()
        return tuple(part for part in found if part.__module__.startswith(f"{package}."))

    return listed


@functools.cache
def _modules(package: str) -> frozenset[str]:
    path = importlib.import_module(package).__path__
    return frozenset(module.name for module in pkgutil.iter_modules(path))


def address(part: type) -> str:
    """Module and name of a class, as in an entry point."""
    return f"{part.__module__}:{part.__qualname__}"
