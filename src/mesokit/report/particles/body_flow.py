"""Mean flow around a body in its own frame: a map, that of theory, and the velocity ahead."""

from typing import Any

import numpy as np

from mesokit.report.finish.legend import legend_above
from mesokit.report.style import MEASURED, labelled, lettered, points, theory_of
from mesokit.seam.result import Array, Result

MORE = 2.0  # inches of a figure that has theory too
LARGEST = 99.0  # percent of the bins: where colours end
ARROWS = 16  # at most along a side
LONGEST = 1.8  # of the distance between arrows
NO_FLUID, BODY = "0.85", "#f0dfae"


def draw(result: Result, figure: Any, ax: Any) -> None:
    """Speed and arrows, measured and of theory, and the velocity on the axis; in given axes the
    measured map alone."""
    shown, wanted = _mirrored(result, result.value), None
    if result.expected is not None:
        wanted = _mirrored(result, result.expected)
    fastest = float(np.nanpercentile(_speed(shown), LARGEST)) if np.isfinite(shown).any() else 1.0
    if wanted is not None:
        fastest = float(np.nanpercentile(_speed(wanted), LARGEST))
    if ax is not None:
        _bar(figure, _map(ax, result, shown, fastest), [ax], result)
        return
    if wanted is None:
        figure.set_figheight(0.75 * figure.get_figheight())
        panels = list(figure.subplots(1, 2))
        maps, line = panels[:1], panels[1]
    else:
        figure.set_figheight(figure.get_figheight() + MORE)
        grid = figure.add_gridspec(2, 2, height_ratios=[3, 2])
        maps = [figure.add_subplot(grid[0, k]) for k in range(2)]
        line = figure.add_subplot(grid[1, :])
        maps[1].set_title("theory", loc="left", fontsize=10)
        _map(maps[1], result, wanted, fastest)
        maps[1].set_ylabel("")
    maps[0].set_title("measured", loc="left", fontsize=10)
    _bar(figure, _map(maps[0], result, shown, fastest), maps, result)
    _on_the_axis(line, result)
    lettered(maps)


def _mirrored(result: Result, values: Array) -> Array:
    """Velocities (along, across, 2) on both sides of the axis."""
    plane = values[..., :2]
    if result.x["across"][0] < 0:
        return plane
    other = plane[:, ::-1] * np.array([1.0, -1.0])
    return np.concatenate([other, plane], axis=1)


def _speed(velocity: Array) -> Array:
    return np.hypot(velocity[..., 0], velocity[..., 1])


def _map(ax: Any, result: Result, velocity: Array, fastest: float) -> Any:
    """Colours, arrows and the body; returns the colours."""
    side, along = result.extra["side"], result.x["along"]
    across = (np.arange(velocity.shape[1]) - (velocity.shape[1] - 1) / 2) * side
    look: Any = {"cmap": "viridis", "vmin": 0.0, "vmax": fastest, "rasterized": True}
    drawn = ax.pcolormesh(along, across, _speed(velocity).T, **look)
    ax.set_facecolor(NO_FLUID)
    block = max(1, -(-len(along) // ARROWS))
    (x, nx), (y, ny) = ((s[: len(s) // block * block], len(s) // block) for s in (along, across))
    cut = velocity[: len(x), : len(y)].reshape(nx, block, ny, block, 2)
    arrows = cut.mean(axis=(1, 3))
    centres = x.reshape(nx, block).mean(axis=1), y.reshape(ny, block).mean(axis=1)
    scale = fastest / (LONGEST * block * side)
    units: Any = {"angles": "xy", "scale_units": "xy", "scale": scale, "pivot": "mid"}
    limited = arrows * np.minimum(1.0, fastest / np.maximum(_speed(arrows), 1e-300))[..., None]
    ax.quiver(*centres, *limited.T, color="white", width=0.006, **units)
    if np.isfinite(result.extra["radius"]):
        from matplotlib.patches import Circle

        ax.add_patch(Circle((0, 0), result.extra["radius"], fc=BODY, ec="black", lw=0.9))
    reach = float(along[-1] + side / 2)
    ax.annotate("", (0.25 * reach, 0), (-0.25 * reach, 0), arrowprops={"arrowstyle": "->"})
    ax.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
    ax.set_xlabel(labelled("along the axis", result.units["along"]))
    ax.set_ylabel(labelled("across", result.units["across"]))
    return drawn


def _bar(figure: Any, drawn: Any, axes: list[Any], result: Result) -> None:
    label = labelled("speed in the plane", result.units["value"])
    figure.colorbar(drawn, ax=axes, label=label, shrink=0.8, extend="max")


def _on_the_axis(ax: Any, result: Result) -> None:
    """The velocity along the axis, in the bins next to it."""
    along, middle = result.x["along"], len(result.x["across"]) // 2
    near = [0] if result.x["across"][0] > 0 else [middle - 1, middle]

    def of(values: Array) -> Array:
        return np.asarray(values[:, near, 0].mean(axis=1))

    error = of(result.error) / np.sqrt(len(near))  # those of two bins hardly depend on one another
    points(ax, along, of(result.value), error, ms=3, lw=0.8, label=MEASURED)
    if result.expected is not None:
        ax.plot(along, of(result.expected), color="black", lw=1.4, label=theory_of(result))
    if np.isfinite(result.extra["radius"]):
        ax.axvspan(*np.array([-1, 1]) * result.extra["radius"], color=BODY, lw=0, zorder=0)
    ax.axhline(0, color="black", lw=0.8, ls=":", zorder=1)
    ax.set_xlim(along[0] - result.extra["side"] / 2, along[-1] + result.extra["side"] / 2)
    ax.set_xlabel(labelled("place on the axis", result.units["along"]))
    ax.set_ylabel(labelled("velocity along it", result.units["value"]))
    legend_above(ax)
