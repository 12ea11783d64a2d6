"""One figure for each result: data with error bars, theory, and what the comparison says.

Matplotlib is imported when a figure is made, and drawn without a display.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mesokit.errors import RunError
from mesokit.io.atomic import replacing
from mesokit.observe.shared.result import Result
from mesokit.report import correlation, curve, field, forces, probe, profile, series, tensor, wake
from mesokit.report.caption import LINE, below, compared
from mesokit.report.finish.several import add
from mesokit.report.style import HEIGHT, STYLE, WIDTH

if TYPE_CHECKING:
    from mesokit.case.case import Case

# What a result says that it is drawn as. Maps know their own figure.
DRAW: dict[str, Callable[[Result, Any, Any], None]] = {
    "curve": curve.draw,
    "series": series.draw,
    "flow series": series.draw_flow,
    "profile": profile.draw,
    "displacement": correlation.draw_displacement,
    "memory": correlation.draw_memory,
    "normal modes": correlation.draw_normal_modes,
    "modes": correlation.draw_modes,
    "modulus": correlation.draw_modulus,
    "tensor": tensor.draw,
    "moduli": tensor.draw_moduli,
    "per solid": forces.draw,
    "centreline": wake.draw,
    "signal": probe.draw,
}
MAPS = ("map", "frames")


def plot(
    result: Result,
    ax: Any = None,
    case: Case | None = None,
    *,
    label: str = "",
    colour: str = "",
) -> Any:
    """Draw a result into a new figure, which is returned, or into the axes `ax`, which are then.

    In given axes the main panel alone is drawn, without the comparisons; a second result in the
    same axes has another colour. `label` is its name in the legend, `colour` that of its data. The
    case of the run adds its solids to a map.
    """
    import matplotlib as mpl

    from mesokit.report.notebook import ShownFigure

    with mpl.rc_context(STYLE):
        if ax is not None:
            into = partial(_draw_into, result, ax, case)
            into() if result.drawing in MAPS else add(ax, into, label, colour)
            return ax
        if result.drawing in MAPS:
            return field.draw(result, None, case)
        text = compared(result.comparisons, WIDTH)
        lines = LINE * len(text.splitlines())
        figure = ShownFigure(figsize=(WIDTH, HEIGHT + lines), layout="constrained")
        DRAW[result.drawing](result, figure, None)
        below(figure, text)
        return figure


def _draw_into(result: Result, ax: Any, case: Case | None) -> None:
    if result.drawing in MAPS:
        field.draw(result, ax, case)
    else:
        DRAW[result.drawing](result, ax.figure, ax)


def save(result: Result, path: str | Path, case: Case | None = None) -> Path:
    """Draw a result into a file (PNG, PDF, SVG by its ending). Raises RunError."""
    return save_figure(plot(result, case=case), path)


def save_figure(figure: Any, path: str | Path) -> Path:
    """Write a figure into a file (PNG, PDF, SVG by its ending). Raises RunError."""
    import matplotlib as mpl

    path = Path(path)
    kind = path.suffix[1:].lower() or "png"
    if kind not in figure.canvas.get_supported_filetypes():
        known = ", ".join(sorted(figure.canvas.get_supported_filetypes()))
        raise RunError(f"{path}: no figure of that kind; choose one of {known}")
    with mpl.rc_context(STYLE), replacing(path) as temporary:
        figure.savefig(temporary, format=kind)
    return path


def save_all(results: Iterable[Result], folder: str | Path, case: Case | None = None) -> list[Path]:
    """Draw each result that has samples into `folder`/name.png; returns the files."""
    return [save(r, Path(folder) / f"{r.name}.png", case) for r in results if r.samples]
