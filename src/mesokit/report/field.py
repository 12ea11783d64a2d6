"""Maps: colours for the size, arrows for the direction."""

from __future__ import annotations

from typing import Any

import numpy as np

from mesokit.observe.flow_frames import average
from mesokit.observe.result import Result
from mesokit.report.style import labelled

ARROWS = 24  # along the longer axis


def draw_velocity(result: Result, figure: Any, ax: Any) -> None:
    """Speed in the plane of the map, with arrows."""
    ax = figure.subplots() if ax is None else ax
    first, second, _ = result.x
    components = [list(result.x["component"]).index(name) for name in (first, second)]
    u, v = (result.value[..., c] for c in components)
    _map(result, figure, ax, np.hypot(u, v), "speed in the plane", "viridis", 0.0)
    x, y = result.x[first], result.x[second]
    every = max(1, int(np.ceil(max(len(x), len(y)) / ARROWS)))
    start = every // 2
    pick = (slice(start, None, every), slice(start, None, every))
    ax.quiver(
        x[pick[0]], y[pick[1]], u[pick].T, v[pick].T, color="white", edgecolor="black",
        linewidth=0.3, pivot="mid", angles="xy",
    )  # fmt: skip
    error = np.nanmedian(result.error) if np.isfinite(result.error).any() else np.nan
    ax.set_title(f"mean velocity; median standard error {error:.2g}", fontsize=10)


def draw_frames(result: Result, figure: Any, ax: Any) -> None:
    """The mean over all frames."""
    draw_velocity(average(result), figure, ax)


def draw_density(result: Result, figure: Any, ax: Any) -> None:
    """Density, with colours that meet in the middle at what is expected."""
    ax = figure.subplots() if ax is None else ax
    middle = None if result.expected is None else float(np.nanmean(result.expected))
    colours = "viridis" if middle is None else "RdBu_r"
    _map(result, figure, ax, result.value, result.label, colours, None, middle)
    error = np.nanmedian(result.error) if np.isfinite(result.error).any() else np.nan
    ax.set_title(f"mean density; median standard error {error:.2g}", fontsize=10)


def _map(
    result: Result,
    figure: Any,
    ax: Any,
    values: Any,
    label: str,
    colours: str,
    lowest: float | None,
    middle: float | None = None,
) -> None:
    first, second = list(result.x)[:2]
    x, y = result.x[first], result.x[second]
    limits = {"vmin": lowest}
    if middle is not None:
        reach = float(np.nanmax(abs(values - middle))) or 1.0
        limits = {"vmin": middle - reach, "vmax": middle + reach}
    image = ax.imshow(
        values.T, origin="lower", cmap=colours, aspect="equal", interpolation="nearest",
        extent=(0, x[-1] + x[0], 0, y[-1] + y[0]), **limits,
    )  # fmt: skip
    wide = len(x) > len(y)
    figure.colorbar(
        image, ax=ax, label=labelled(label, result.units["value"]),
        location="bottom" if wide and (x[-1] + x[0]) > 1.5 * (y[-1] + y[0]) else "right",
    )  # fmt: skip
    ax.set_xlabel(labelled(f"${first}$", result.units[first]))
    ax.set_ylabel(labelled(f"${second}$", result.units[second]))
