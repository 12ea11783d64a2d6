"""A case: everything that defines a run, as a Python object and as a TOML file."""

from __future__ import annotations

import functools
import typing
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from mesokit.case import checks, methods, toml
from mesokit.case.box import Box
from mesokit.case.component import (
    build,
    component,
    is_component,
    known_keys,
    nearest,
    one_of,
    param,
    show,
)
from mesokit.case.describe.shown import Shown
from mesokit.case.registry import FAMILIES
from mesokit.case.run import Log, Run
from mesokit.case.trajectory import Group, Trajectory
from mesokit.case.units import Units
from mesokit.errors import CaseError

SECTIONS = "the sections of the method"  # where these come among the fields that all cases have
FIELDS: dict[str, Any] = {
    "run": (Run, param(doc="how long, and how safe")),
    "box": (Box, param(doc="the box")),
    SECTIONS: (),
    "observe": (None, param((), doc="what is measured; key `[[observe]]`")),
    "trajectory": (
        Trajectory | None, param(None, doc="particles to write (none unless said)")
    ),
    "log": (Log | None, param(None, doc="numbers to tell in time (none unless said)")),
    "units": (
        Units | None, param(None, doc="what the units are in SI (reduced units unless said)")
    ),
    "title": (str, param("", doc="for the figures")),
}  # fmt: skip


class Case(Shown):
    """Everything that defines a run.

    Beside `run`, `box`, `observe`, `trajectory`, `log`, `units` and `title` it has the sections of
    its method, `run.method`: those of an MPCD fluid are `fluid`, `solutes` and `walls`.

    Raises CaseError for values out of range and for combinations without a physics.

    Examples:
        >>> from mesokit import Fluid
        >>> case = Case(run=Run(steps=100), box=Box([30, 30]), fluid=Fluid(density=5))
        >>> print(case.to_toml()[:37])
        [run]
        steps = 100
        warmup = 0
        seed = 1
    """

    run: Run
    box: Box
    observe: tuple[Any, ...]
    trajectory: Trajectory | None
    log: Log | None
    units: Units | None
    title: str
    _method: ClassVar[Any]  # typed in `mesokit.seam.method`, which imports cases
    if TYPE_CHECKING:
        __dataclass_fields__: ClassVar[dict[str, Any]]

        def __getattr__(self, section: str) -> Any: ...

    def __new__(cls, *given: Any, **sections: Any) -> Case:
        """A case of the class of `run.method`."""
        if cls is Case:
            run = given[0] if given else sections.get("run")
            cls = case_class(method_named(run))
            _require_sections(cls, sections, "Case.")
        return object.__new__(cls)

    def __init__(self, *given: Any, **sections: Any) -> None:
        raise TypeError("a case is made by its class")  # that of its method has another

    def __post_init__(self) -> None:
        method = self._method
        if self.run.method != method.name:
            raise CaseError(
                f"run.method = {show(self.run.method)}: the sections are those of "
                f"{show(method.name)}; make a new case"
            )
        if self.units is not None and method.si is None:
            raise CaseError(f"units: method {show(method.name)} does not know them in SI")
        checks.box_keys(self.box, method)
        method.check(self)
        checks.check(self, method)
        if self.log is not None:
            checks.log(self, method.log(self).names)

    def _card(self) -> dict[str, Any]:
        rows = [(key, text, "") for key, text in toml.given(self, self._method.keys)]
        words, text = self.title, self.to_toml()
        return {"title": "case", "words": words, "rows": rows, "text": text, "fold": "all defaults"}

    def __reduce__(self) -> Any:
        fields = {name: getattr(self, name) for name in type(self)._fields()}
        return functools.partial(Case, **fields), ()

    @property
    def groups(self) -> tuple[Group, ...]:
        """The groups of particles, in the order of their numbers."""
        groups: tuple[Group, ...] = self._method.groups(self)
        return groups

    def particles_have(self, what: str) -> bool:
        """True if some group has a quantity such as "diameter" (`Group.has`)."""
        return any(what in group.has for group in self.groups)

    @property
    def particles(self) -> int:
        """Number of particles of the first group: of a fluid, without what is dissolved in it."""
        return self.groups[0].number if self.groups else 0

    @property
    def noun(self) -> str:
        """What a particle of the first group is called in messages."""
        return self.groups[0].noun if self.groups else "particle"

    @classmethod
    def from_toml(cls, path: str | Path, overrides: Mapping[str, Any] | None = None) -> Case:
        """Read a case file.

        Parameters:
            path: the file. File names in it are relative to its folder.
            overrides: values that replace those of the file, by key path, such as
                {"fluid.density": "5"}; a text is read as a TOML value, else taken as it is. One
                of several [[wall]] or [[observe]] is named by its number from 1, and an
                observable by its name: "observe.velocity-profile.every".

        Raises CaseError: one line with file, key, value and what was expected.
        """
        path = Path(path)
        try:
            data = toml.parse(toml.read(path))
            for key, value in (overrides or {}).items():
                toml.override(data, key, value)
            return cls.from_data(data, path.parent)
        except CaseError as error:
            raise CaseError(f"{path}: {error}") from None

    @classmethod
    def from_data(cls, data: dict[str, Any], folder: Path) -> Case:
        """A case from the tables of a file; file names in it are relative to the folder.

        Raises CaseError: one line with key, value and what was expected.
        """
        run = data.get("run")
        if isinstance(run, dict) and "method" in run:
            try:
                build(Run, {"steps": 0, "method": run["method"]})  # other keys depend on it
            except CaseError as error:
                raise CaseError(f"run.{error}") from None
        made = case_class(method_named(run))
        keys: dict[str, str] = made._method.keys
        for field, key in keys.items():
            if field in data:
                raise CaseError(f"{field}: unknown key; did you mean [[{key}]]?")
        lists = [f for f in made._fields() if made.__dataclass_fields__[f].default.default == ()]
        for key in (keys.get(field, field) for field in lists):
            if isinstance(data.get(key), dict):
                raise CaseError(f"{key}: expected [[{key}]], in double brackets")
        fields = {key: field for field, key in keys.items()}
        values = {fields.get(key, key): value for key, value in data.items()}
        _require_sections(made, values)
        _require_keys(made, values)
        return build(made, values, keys, folder)

    def to_toml(self, folder: Path | None = None) -> str:
        """The case as a file, with every default written out; `from_toml` gives an equal case.

        Files in the folder that the file is for are named without it: they may be moved together.
        """
        return toml.write(self, self._method.keys, folder)

    def missing_files(self) -> list[str]:
        """'key = file' for each file or folder that the start needs and that is not there."""
        missing: list[str] = self._method.initial.missing(self)
        return missing

    @classmethod
    def _fields(cls) -> list[str]:
        return known_keys(cls)


@functools.cache
def case_class(name: str) -> type[Case]:
    """The class of the cases of a method: the fields of all cases, and its sections."""
    method = methods.load(name)
    hints = typing.get_type_hints(method.sections, include_extras=True)
    sections = {key: (hint, getattr(method.sections, key)) for key, hint in hints.items()}
    fields: dict[str, Any] = {}
    for key, field in FIELDS.items():
        fields |= sections if key == SECTIONS else {key: field}
    # known once the module of any method is imported
    observable: Any = next(f.base for f in FAMILIES.values() if f.group == "mesokit.observable")
    fields["observe"] = (tuple[observable, ...], fields["observe"][1])
    body = {
        "__annotations__": {key: hint for key, (hint, _) in fields.items()},
        "__doc__": Case.__doc__,
        "__module__": __name__,
        **{key: default for key, (_, default) in fields.items()},
        "_method": method,
    }
    return component(type("Case", (Case,), body))


def method_named(run: Any) -> str:
    """The method that a section `run` names, or its table; a wrong name is left to its check."""
    given = run.get("method") if isinstance(run, dict) else getattr(run, "method", None)
    if not isinstance(given, str):
        return methods.DEFAULT
    known = given in methods.METHODS or given in methods.modules()  # which looks at all packages
    return given if known else methods.DEFAULT


def _require_sections(made: type[Case], given: Mapping[str, Any], where: str = "") -> None:
    """Raise CaseError for a key that is no section of a case of this method."""
    method, known = made._method, made._fields()
    for key in given:
        if key not in known:
            names = [method.keys.get(name, name) for name in known] if not where else known
            every = {name: case_class(name) for name in methods.METHODS}
            others = [
                name
                for name, other in every.items()
                if key in (*other._fields(), *other._method.keys.values())
            ]
            if others:
                hint = f"; a section of {one_of(others)} (run.method)"
            else:
                hint = nearest(key, names) or f"; valid here: {', '.join(names)}"
            raise CaseError(f"{where}{key}: unknown key of method {show(method.name)}{hint}")


def _require_keys(made: type[Case], given: Mapping[str, Any]) -> None:
    """Raise CaseError for a key that only other methods have in a section of the same name."""
    for section, values in given.items():
        own = _section(made, section)
        if own is None or not isinstance(values, dict):
            continue
        for key in (key for key in values if key not in known_keys(own)):
            every = {name: _section(case_class(name), section) for name in methods.METHODS}
            others = {n: known_keys(cls) for n, cls in every.items() if cls is not None}
            theirs = [name for name, keys in others.items() if key in keys]
            if theirs:
                alone = [k for k in known_keys(own) if not all(k in others[n] for n in theirs)]
                name = show(made._method.name)
                raise CaseError(
                    f"{section}.{key}: unknown key of method {name}, but one of {one_of(theirs)}; "
                    f"{name} has {', '.join(alone)} of its own"
                )


def _section(made: type[Case], name: str) -> Any:
    """The component of a section that is one table, None for others."""
    hint = typing.get_type_hints(made._method.sections, include_extras=True).get(name)
    return hint if is_component(hint) else None
