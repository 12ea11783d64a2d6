"""Pictures and films of a run, whether it is in memory or read from its files."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mesokit.case.case import Case
from mesokit.case.component import require_known, show
from mesokit.errors import CaseError
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


def site_images(case: Case, path: str | Path, pixels: int | None) -> dict[str, Any]:
    """Writers of images of sites by the ending of the file. Raises CaseError for a wrong number of
    pixels, or pixels of other files."""
    from mesokit.report.flow.site_images import MOST_PIXELS, write

    if pixels is None:
        return {".png": write}
    if not isinstance(pixels, int) or not 1 <= pixels <= MOST_PIXELS:
        raise CaseError(f"pixels = {show(pixels)}: expected a whole number from 1 to {MOST_PIXELS}")
    if Path(path).suffix != ".png":
        raise CaseError(f"pixels = {show(pixels)}: only of sites in files .png; leave it out")
    return {".png": partial(write, pixels=pixels)}
