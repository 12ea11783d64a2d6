"""Completions of the shell: pictures, templates, and keys of the case."""

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import click
from click.shell_completion import CompletionItem


def beginning(text: str, names: Iterable[str]) -> list[CompletionItem]:
    """The names that begin so."""
    return [CompletionItem(name) for name in names if name.startswith(text)]


def kinds(context: click.Context, option: click.Parameter, text: str) -> list[CompletionItem]:
    """Kinds of pictures of the flow."""
    from mesokit.report.flow import NAMES

    return beginning(text, NAMES)


def colours(context: click.Context, option: click.Parameter, text: str) -> list[CompletionItem]:
    """Quantities that colours of disks and spheres may show."""
    from mesokit.report.flow.colouring import COLOURS

    return beginning(text, COLOURS)


def keys(context: click.Context, option: click.Parameter, text: str) -> list[CompletionItem]:
    """Key paths of `--set`: those of the case on the command line, with what their parts have."""
    from mesokit.case.case import Case
    from mesokit.errors import MesokitError

    if "=" in text:
        return []
    try:
        given = context.params.get("case") or next(iter(context.args))  # as the line is not whole
        case = Case.from_toml(Path(str(given)))
    except (MesokitError, OSError, StopIteration):
        return []
    named = case._method.keys
    found = []
    for path, about in _keys(case, "", named):
        if path.startswith(text) and path.count(".") <= text.count(".") + 1:
            found.append(CompletionItem(f"{path}=", help=about))
    return found


def _keys(part: Any, start: str, named: Any) -> Iterator[tuple[str, str]]:
    """Paths and meanings of the keys of a part and of the parts in it."""
    fields = type(part).__pydantic_fields__
    for name, field in fields.items():
        value, path = getattr(part, name), f"{start}{named.get(name, name)}"
        if hasattr(type(value), "__pydantic_fields__"):
            yield from _keys(value, f"{path}.", {})
        elif isinstance(value, tuple) and value and hasattr(type(value[0]), "__pydantic_fields__"):
            for number, each in enumerate(value, start=1):
                of = getattr(each, "label", None) or number
                yield from _keys(each, f"{path}.{of}.", {})
        elif start or name == "title":
            yield path, field.description or ""
