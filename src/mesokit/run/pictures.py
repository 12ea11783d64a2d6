"""Pictures and films of a run, whether it is in memory or read from its files."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mesokit.case.case import Case
from mesokit.case.component import require_known
from mesokit.seam.result import Result

if TYPE_CHECKING:  # it loads the libraries of pictures
    from mesokit.report.flow import Film


def flow(
    case: Case,
    results: Mapping[str, Result],
    frames: Any,
    run: str,
    kind: str | None,
    choices: dict[str, Any],
) -> Any:
    """A picture of a run of this name, with the choices of `mesokit.report.flow.picture` and the
    `width` of the figure."""
    from mesokit.report.finish.origin import origin_of
    from mesokit.report.flow import CHOICES, page_width, picture

    with page_width(choices.pop("width", None)):
        require_known(choices, CHOICES)
        figure = picture(case, results, frames, kind, **choices)
    figure.origin = origin_of(case, run)
    return figure


def film(
    case: Case,
    results: Mapping[str, Result],
    frames: Any,
    run: str,
    kind: str | None,
    choices: dict[str, Any],
    path: str | Path,
) -> Film:
    """Write a film of it, with the choices of `mesokit.report.flow.animate`."""
    from mesokit.report.flow import CHOICES, animate

    require_known(choices, [*CHOICES, "fps", "progress"])
    return animate(case, results, frames, path, kind, run=run, **choices)
