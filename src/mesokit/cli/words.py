"""Numbers, tables and reasons in words."""

from __future__ import annotations

import errno
from collections.abc import Sequence


def show_table(rows: Sequence[tuple[str, str, str]]) -> None:
    """Print rows in aligned columns."""
    from rich.console import Console
    from rich.table import Table

    table = Table(box=None, show_header=False, padding=(0, 2, 0, 0))
    for row in rows:
        table.add_row(*row)
    Console(highlight=False, soft_wrap=True).print(table)


def number(value: float | None, unit: str = "") -> str:
    """A number with its unit, or that there is none."""
    return "no formula" if value is None else f"{value:.4g} {unit}".rstrip()


def reason(error: OSError) -> str:
    """What the system refused, in a few words."""
    words = {errno.ENOSPC: "no space left on the disk", errno.EDQUOT: "disk quota exceeded"}
    text = words.get(error.errno or 0) or error.strerror or str(error)
    name = f"{error.filename}: " if error.filename else ""
    return f"{name}{text[0].lower()}{text[1:]}" if text else repr(error)
