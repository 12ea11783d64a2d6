"""Few numbers with names: stresses and forces on plates, next to what is expected."""

import itertools
from typing import Any

import numpy as np

from mesokit.report.finish.legend import entries, legend_in_rows, legend_of
from mesokit.report.style import ERROR, labelled, lettered, points
from mesokit.seam.result import Result

SYMBOLS = {
    "stress": r"$\sigma_{\alpha\beta}$",
    "modulus": "modulus",
    "size of molecules": r"$\langle x_\alpha x_\beta\rangle$",
    "products of bond components": r"$\langle b_\alpha b_\beta\rangle$",
}

BELOW: Any = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.06)}  # of given axes, a legend
TITLES = {"products of bond components": ("off the diagonal", "on the diagonal")}  # of panels


def draw(result: Result, figure: Any, ax: Any) -> None:
    """Off-diagonal and diagonal parts in panels of their own, as their sizes differ.

    Of sizes each part has a panel: the ends of a chain are farther apart than its beads.
    """
    every = list(itertools.product(*(range(len(axis)) for axis in result.x.values())))
    normal = [e for e in every if _is_normal(result, e)]
    # xy but not yx, which is the same up to noise
    across = [e for e in every if not _is_normal(result, e) and (len(e) < 3 or e[1] < e[2])]
    shear, straight = TITLES.get(result.label, ("shear", "normal"))
    panels = [(across, shear), (normal, straight)]
    if result.label == "size of molecules":
        parts = result.x["part"]
        shown = sorted(normal + across, key=lambda e: not _is_normal(result, e))
        panels = [([e for e in shown if e[0] == k], str(part)) for k, part in enumerate(parts)]
    if ax is not None:
        _panel(ax, result, *panels[0])
        legend_in_rows(ax, entries([ax]), np.inf, most=2, **BELOW)
        return
    drawn = figure.subplots(1, len(panels), squeeze=False)[0]
    for axes, (chosen, title) in zip(drawn, panels, strict=True):
        _panel(axes, result, chosen, title)
    lettered(list(drawn))
    legend_of(figure, drawn)


def draw_moduli(result: Result, figure: Any, ax: Any) -> None:
    """Storage and loss modulus, by parts."""
    every = list(itertools.product(*(range(len(axis)) for axis in result.x.values())))
    panel = figure.subplots() if ax is None else ax
    _panel(panel, result, every, rf"$\omega = {result.extra['frequency']:g}\,\tau^{{-1}}$")
    if ax is None:
        legend_of(figure, [panel])
    else:
        legend_in_rows(ax, entries([ax]), np.inf, most=2, **BELOW)


def _panel(ax: Any, result: Result, entries: list[tuple[int, ...]], title: str) -> None:
    groups = next(iter(result.x.values()))
    inner = list(dict.fromkeys("".join(_names(result, e)) for e in entries))
    numbers = sorted({e[0] for e in entries})
    width = 0.6 / max(len(numbers), 1)
    known = bool(np.isfinite(result.error).any())
    for place_of, number in enumerate(numbers):
        chosen = [e for e in entries if e[0] == number]
        place = np.array([inner.index("".join(_names(result, e))) for e in chosen], float)
        place += (place_of - (len(numbers) - 1) / 2) * width
        value, error = (np.array([a[e] for e in chosen]) for a in (result.value, result.error))
        label = str(groups[number]) + f", {ERROR}" * (known and not number)  # said once
        points(ax, place, value, error, number, label=label, zorder=3)
        if result.expected is not None:
            expected = np.array([result.expected[e] for e in chosen])
            rough = _is_rough(result, str(groups[number])) & (expected != 0)
            for use, label, look in (
                (~rough, "theory", {"color": "black"}),
                (rough, "theory, approximate", {"color": "0.4", "ls": (0, (2, 1))}),
            ):
                if np.isfinite(expected[use]).any():
                    first, last = place[use] - width / 2, place[use] + width / 2
                    ax.hlines(expected[use], first, last, lw=1.5, label=label, **look)
    ax.set_xticks(range(len(inner)), [f"${name}$" for name in inner])
    ax.set_xlim(-0.6, len(inner) - 0.4)
    ax.set_title(title, fontsize=10)
    ax.margins(y=0.2)
    ax.set_ylabel(labelled(SYMBOLS.get(result.label, "force per area"), result.units["value"]))


def _is_rough(result: Result, part: str) -> bool:
    """Whether theory of a part is approximate: by comparisons that name it, or else by any."""
    known = [c for c in result.comparisons if np.isfinite(c.expected)]
    parts = [str(name) for name in next(iter(result.x.values()))]
    named = [c for c in known if any(c.what.startswith(name) for name in parts)]
    own = [c for c in named if c.what.startswith(part)]
    if named and not own:
        own = [c for c in known if c not in named]
    return any(c.approximate for c in own or known)


def _names(result: Result, entry: tuple[int, ...]) -> list[str]:
    axes = list(result.x.values())
    return [str(axis[i]) for axis, i in zip(axes[1:], entry[1:], strict=True)]


def _is_normal(result: Result, entry: tuple[int, ...]) -> bool:
    names = _names(result, entry)
    return names[0] == (names[1] if len(names) > 1 else result.extra.get("axis"))
