"""Figures and films inside a page, and links to files beside it."""

import base64
import io
import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple
from urllib.parse import quote

from mesokit.case.amounts import size_text
from mesokit.case.case import Case
from mesokit.seam.result import Result

LARGEST_SVG = 250_000  # bytes; larger drawings are kept as PNG
LARGEST_FILM = 8_000_000  # bytes of a film that goes into the page
DPI = 160
TYPES = {".png": "image/png", ".svg": "image/svg+xml", ".gif": "image/gif", ".mp4": "video/mp4"}


class Picture(NamedTuple):
    """The name, the data URI and the caption of a figure."""

    name: str
    source: str
    words: str


class Reel(NamedTuple):
    """The file, size in words, link, and data URI or nothing of a film; `moving` if it is MP4."""

    name: str
    size: str
    link: str
    source: str
    moving: bool


def embedded(data: bytes, ending: str) -> str:
    """A file as a data URI.

    >>> embedded(b"<svg/>", ".svg")
    'data:image/svg+xml;base64,PHN2Zy8+'
    """
    return f"data:{TYPES[ending]};base64,{base64.b64encode(data).decode()}"


def link_to(path: Path, page: Path) -> str:
    """A link from a page to a file or folder, relative so that both can be moved together.

    >>> link_to(Path("study/runs/a=1,b=2/seed 3"), Path("study/report.html"))
    'runs/a=1,b=2/seed%203'
    """
    try:
        relative = os.path.relpath(path, page.parent)
    except ValueError:  # another drive of Windows: no relative path leads there
        return path.resolve().as_uri()
    return quote(Path(relative).as_posix(), safe="/=,+")


def figures(results: Iterable[Result], case: Case) -> list[Picture]:
    """A figure of each result that has samples, of equal ones one."""
    from mesokit.report.figures import drawn_once, plot

    return [
        Picture(result.name, drawn(plot(result, case=case)), caption(result))
        for result in drawn_once(results)
    ]


def drawn(figure: Any) -> str:
    """A Matplotlib figure as a data URI: SVG, which is sharp in print, or PNG if that is large."""
    import matplotlib as mpl

    from mesokit.report.style import STYLE

    with mpl.rc_context(STYLE | {"svg.hashsalt": "mesokit"}):  # the same picture, the same bytes
        data = io.BytesIO()
        figure.savefig(data, format="svg", metadata={"Date": None})
        if data.tell() <= LARGEST_SVG:
            return embedded(data.getvalue(), ".svg")
        data = io.BytesIO()
        figure.savefig(data, format="png", dpi=DPI)
        return embedded(data.getvalue(), ".png")


def caption(result: Result) -> str:
    """The content of a figure, its theory, and notes of lower bounds."""
    theory = [f"theory: {result.theory}"] if result.theory and result.expected is not None else []
    notes = dict.fromkeys(c.note for c in result.comparisons if c.lower_bound)
    return "; ".join([result.about, *theory, *notes]) + "."


def pictures_of_flow(folder: Path, but: Iterable[str]) -> list[Picture]:
    """Pictures of the flow that were drawn into the folder of a run, `but` for some names."""
    names = set(but)
    return [
        Picture(path.stem, embedded(path.read_bytes(), path.suffix), f"drawn into {path.name}.")
        for path in sorted(folder.glob("flow-*.png"))
        if path.stem not in names
    ]


def films_of(folder: Path, page: Path, inline: bool) -> list[Reel]:
    """The films in the folder of a run, linked from the page, or inside it if they are small."""
    found = []
    for path in sorted([*folder.glob("*.mp4"), *folder.glob("*.gif")]):
        size, moving = path.stat().st_size, path.suffix == ".mp4"
        inside = inline and size <= LARGEST_FILM
        source = embedded(path.read_bytes(), path.suffix) if inside else ""
        found.append(Reel(path.name, size_text(size), link_to(path, page), source, moving))
    return found
