"""A figure as a file, with where it comes from."""

import contextlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import RunError
from mesokit.io.atomic import replacing
from mesokit.report.finish.origin import Origin
from mesokit.report.style import STYLE

FOOT, SIZE, LETTERS = 0.18, 6.0, 23  # inches below a figure, points, letters in an inch


def save_figure(figure: Any, path: str | Path) -> Path:
    """Write a figure into a file (PNG, PDF, SVG by its ending). Raises RunError.

    Where the figure says its `origin`, that stands in a line below it and in the file's metadata.
    """
    import matplotlib as mpl

    path = Path(path)
    kind = path.suffix[1:].lower() or "png"
    if kind not in figure.canvas.get_supported_filetypes():
        known = ", ".join(sorted(figure.canvas.get_supported_filetypes()))
        raise RunError(f"{path}: no figure of that kind; choose one of {known}")
    origin: Origin | None = getattr(figure, "origin", None)
    about = None if origin is None else origin.metadata(kind) or None
    with mpl.rc_context(STYLE), replacing(path) as temporary, _foot(figure, origin) as options:
        figure.savefig(temporary, format=kind, metadata=about, **options)
    return path


@contextlib.contextmanager
def _foot(figure: Any, origin: Origin | None) -> Iterator[dict[str, Any]]:
    """The line below a figure, beyond its own area; how to save it with that."""
    if origin is None:
        yield {}
        return
    from matplotlib.transforms import Bbox

    width, height = figure.get_size_inches()
    line = _line(figure, origin, -0.06 / height)
    line.set_in_layout(False)
    try:
        yield {"bbox_inches": Bbox.from_extents(0, -FOOT, width, height)}
    finally:
        line.remove()


def foot_strip(origin: Origin, width: float, dpi: float) -> NDArray[np.uint8]:
    """The line below a figure `width` inches wide, as pixels (height, width, 3) of its own."""
    import matplotlib as mpl

    from mesokit.report.notebook import ShownFigure

    with mpl.rc_context(STYLE):
        strip = ShownFigure(figsize=(width, FOOT), dpi=dpi)
        _line(strip, origin, 1 - 0.06 / FOOT)
        canvas: Any = strip.canvas
        canvas.draw()
        return np.array(canvas.buffer_rgba())[..., :3]


def _line(figure: Any, origin: Origin, top: float) -> Any:
    """Where a figure comes from, written at its right side; `top` in heights of the figure."""
    width = figure.get_size_inches()[0]
    text, most = origin.line(), int(LETTERS * width)
    if len(text) > most:
        text = f"{text[: most - 3]}..."
    look: dict[str, Any] = {"fontsize": SIZE, "color": "0.4", "parse_math": False}
    return figure.text(1 - 0.06 / width, top, text, ha="right", va="top", **look)
