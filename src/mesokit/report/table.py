"""Measured against expected, as a table on a terminal and as plain lines elsewhere."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from mesokit.case.describe.digits import two_digits
from mesokit.seam.result import Comparison, Result, in_percent, signed, with_error

if TYPE_CHECKING:
    from rich.console import Console

HEADINGS = ("result", "what", "measured", "expected", "unit", "deviation", "note")
SUSPICIOUS = 4.0  # standard errors


def comparison_table(results: Iterable[Result]) -> Any:
    """A Rich table of all comparisons; deviations beyond 4 standard errors stand out."""
    from rich.table import Table

    table = Table(*HEADINGS[:-1], box=None, pad_edge=False, header_style="bold")
    for result in results:
        name = result.name
        for comparison in result.comparisons:
            style = "bold yellow" if abs(comparison.deviation) > SUSPICIOUS else None
            table.add_row(name, *cells(comparison)[:-1], style=style)
            name = ""
    return table


def print_comparisons(results: Iterable[Result], console: Console | None = None) -> None:
    """Print all comparisons: a table on a terminal, one line each elsewhere."""
    from rich.console import Console

    console = console or Console()
    found = [r for r in results if r.comparisons]
    if not found:
        return
    if console.is_terminal:
        console.print(comparison_table(found))
        return
    for result in found:
        for comparison in result.comparisons:
            console.print(f"{result.name}: {comparison}", soft_wrap=True, highlight=False)


def cells(c: Comparison) -> tuple[str, str, str, str, str, str]:
    """The texts of one comparison under all `HEADINGS` but the first."""
    expected = "" if math.isnan(c.expected) else f"{c.expected:.4g}"
    deviation = ""
    if math.isfinite(c.deviation):
        deviation = f"{signed(c.deviation)} s.e."
        if math.isfinite(c.percent) and c.expected:
            deviation += f" ({in_percent(c.percent)})"
    elif c.approximate and math.isfinite(c.percent):
        expected, deviation = f"about {expected}", f"{two_digits(c.percent, sign='+')} %"
    return c.what, with_error(c.measured, c.error), expected, c.unit, deviation, c.note
