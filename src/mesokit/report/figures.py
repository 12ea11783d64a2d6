"""One figure for each result: data with error bars, theory, and what the comparison says.

Matplotlib is imported when a figure is made, and drawn without a display.
"""

import warnings
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from mesokit.case.case import Case
from mesokit.report import (
    correlation,
    curve,
    field,
    forces,
    histogram,
    profile,
    series,
    stress_in_time,
    tensor,
)
from mesokit.report.caption import LINE, below, compared
from mesokit.report.finish.labels import fit_labels
from mesokit.report.finish.origin import origin_of
from mesokit.report.finish.saving import save_figure
from mesokit.report.finish.several import add
from mesokit.report.flow.layout import page_width
from mesokit.report.flow.source import axes_of
from mesokit.report.particles import (
    body_drift,
    body_flow,
    body_profile,
    body_tracks,
    flocks,
    snapshots,
    tracks,
)
from mesokit.report.style import STYLE, WIDTH, fonts, height_of
from mesokit.seam.in_units import showing
from mesokit.seam.result import Result

# By `Result.drawing`: figures of one panel, and those of several or of their main one alone
ONE_PANEL: dict[str, Callable[[Result, Any], None]] = {
    "curve": curve.draw,
    "flow series": series.draw_flow,
    "memory": correlation.draw_memory,
    "normal modes": correlation.draw_normal_modes,
    "modes": correlation.draw_modes,
    "structure factor": curve.draw_structure_factor,
    "number fluctuations": curve.draw_number_fluctuations,
    "cooling": curve.draw_cooling,
    "growth": curve.draw_growth,
    "logarithmic": curve.draw_logarithmic,
    "path": curve.draw_path,
    "centreline": profile.draw_wake,
    "histogram": histogram.draw,
    "clusters": flocks.draw_clusters,
}
DRAW: dict[str, Callable[[Result, Any, Any], None]] = {
    "series": series.draw,
    "profile": profile.draw,
    "displacement": correlation.draw_displacement,
    "modulus": correlation.draw_modulus,
    "stress in time": stress_in_time.draw,
    "tensor": tensor.draw,
    "moduli": tensor.draw_moduli,
    "per solid": forces.draw,
    "histograms": histogram.draw_several,
    "snapshots": snapshots.draw,
    "signal": series.draw_signal,
    "tracks": tracks.draw,
    "body tracks": body_tracks.draw,
    "body drift": body_drift.draw,
    "body flow": body_flow.draw,
    "body profile": body_profile.draw,
    "order": flocks.draw_order,
    "bands": flocks.draw_bands,
}
MAPS = ("map", "frames")
FEW, FLAT = (
    4,
    ("tensor", "moduli", "body drift"),
)  # places of a curve that fill no page; drawings of few numbers
LOW = 0.6  # of the usual height, of a figure of few numbers


def plot(
    result: Result,
    ax: Any = None,
    case: Case | None = None,
    *,
    label: str = "",
    colour: str = "",
    width: float | None = None,
) -> Any:
    """Draw a result into a new figure, which is returned, or into the axes `ax`, which are then.

    In given axes the main panel alone is drawn, without the comparisons; a second result in the
    same axes has another colour. `label` is its name in the legend, `colour` that of its data. The
    case of the run adds its solids to a map; `width` is that of a new figure, in inches.
    """
    import matplotlib as mpl

    from mesokit.report.notebook import ShownFigure

    with mpl.rc_context(STYLE), showing(case):
        if ax is not None:
            if result.drawing in MAPS:
                field.draw(result, ax, case)
            else:
                add(ax, partial(_draw, result, ax.figure, ax), label, colour)
            return ax
    wide = WIDTH if width is None else width
    with mpl.rc_context(STYLE | fonts(wide)), page_width(width), showing(case):
        if result.drawing in MAPS:
            return field.draw(result, None, case)
        text = compared(result.comparisons, wide)
        places = len(next(iter(result.x.values()), ()))
        few = result.drawing in FLAT or (result.drawing == "curve" and places <= FEW)
        height = height_of(wide) * (LOW if few else 1.0) + LINE * len(text.splitlines())
        figure = ShownFigure(figsize=(wide, height), layout="constrained")
        _draw(result, figure, None)
        for one in figure.axes:
            _around_one_place(one)
        below(figure, text)
        fit_labels(figure)
        return figure


def _draw(result: Result, figure: Any, ax: Any) -> None:
    if result.drawing in ONE_PANEL:
        ONE_PANEL[result.drawing](result, figure.subplots() if ax is None else ax)
    else:
        DRAW[result.drawing](result, figure, ax)


def _around_one_place(ax: Any) -> None:
    """Give a logarithmic axis that has data at one place alone limits around it."""
    for name, ends in (("x", ax.dataLim.intervalx), ("y", ax.dataLim.intervaly)):
        low, high = (float(end) for end in ends)
        if getattr(ax, f"get_{name}scale")() == "log" and 0 < low == high:
            getattr(ax, f"set_autoscale{name}_on")(False)  # which would warn of it
            getattr(ax, f"set_{name}lim")(low / 2, 2 * high)


def save(
    result: Result,
    path: str | Path,
    case: Case | None = None,
    *,
    width: float | None = None,
    run: str = "",
) -> Path:
    """Draw a result into a file (PNG, PDF, SVG by its ending). Raises RunError.

    The case, and the name of the `run`, stand below the figure and in the metadata of the file.
    """
    figure = plot(result, case=case, width=width)
    if case is not None:
        figure.origin = origin_of(case, run)
    return save_figure(figure, path)


def save_all(
    results: Iterable[Result],
    folder: str | Path,
    case: Case | None = None,
    *,
    ending: str = ".png",
    width: float | None = None,
    run: str = "",
) -> list[Path]:
    """Draw each result of `drawn_once` into `folder`/name.png; returns the files.

    `run` is the name of the run, that of the folder unless said. A result with samples, but without
    a number so far, has a warning in place of a figure.
    """
    folder, results = Path(folder), list(results)
    for result in results:
        if result.samples and not _has_numbers(result):
            warnings.warn(f"{result.name}: no figure, as no number is known yet", stacklevel=2)
    how: Any = {"width": width, "run": run or folder.resolve().name}
    return [save(r, folder / f"{r.name}{ending}", case, **how) for r in drawn_once(results)]


def drawn_once(results: Iterable[Result]) -> list[Result]:
    """Results with samples and numbers, without frames whose mean is a map among them."""
    found = [result for result in results if result.samples and _has_numbers(result)]
    maps = [set(axes_of(r)) for r in found if r.drawing == "map" and "component" in r.x]
    return [r for r in found if r.drawing != "frames" or set(axes_of(r)) not in maps]


def _has_numbers(result: Result) -> bool:
    """Whether there is something to draw: values, or a series beside them."""
    return bool(result.value.size) or any(np.size(each) > 1 for each in result.extra.values())
