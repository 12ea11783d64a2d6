"""Few numbers with names: stresses and forces on plates, next to what is expected."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np

from mesokit.observe.shared.result import Result
from mesokit.report.style import COLOURS, MARKERS, labelled

SYMBOLS = {
    "stress": r"$\sigma_{\alpha\beta}$",
    "modulus": "modulus",
    "size of molecules": r"$\langle x_\alpha x_\beta\rangle$",
    "products of bond components": r"$\langle b_\alpha b_\beta\rangle$",
}


def draw(result: Result, figure: Any, ax: Any) -> None:
    """Off-diagonal and diagonal parts in panels of their own, as their sizes differ."""
    entries = list(itertools.product(*(range(len(axis)) for axis in result.x.values())))
    normal = [e for e in entries if _is_normal(result, e)]
    across = [e for e in entries if not _is_normal(result, e) and _once(result, e)]
    panels = [ax, None] if ax is not None else list(figure.subplots(1, 2))
    _panel(panels[0], result, across, "shear")
    if panels[1] is not None:
        _panel(panels[1], result, normal, "normal")


def draw_moduli(result: Result, figure: Any, ax: Any) -> None:
    """Storage and loss modulus, by parts."""
    entries = list(itertools.product(*(range(len(axis)) for axis in result.x.values())))
    ax = ax if ax is not None else figure.subplots()
    _panel(ax, result, entries, f"frequency {result.extra['frequency']:g}")


def _panel(ax: Any, result: Result, entries: list[tuple[int, ...]], title: str) -> None:
    groups, inner = next(iter(result.x.values())), _inner_names(result, entries)
    width = 0.6 / max(len(groups), 1)
    for number, group in enumerate(groups):
        chosen = [e for e in entries if e[0] == number]
        place = np.array([inner.index(_name(result, e)) for e in chosen], float)
        place += (number - (len(groups) - 1) / 2) * width
        value = np.array([result.value[e] for e in chosen])
        error = np.array([result.error[e] for e in chosen])
        ax.errorbar(
            place,
            value,
            error,
            fmt=MARKERS[number],
            mfc="white",
            color=COLOURS[number],
            label=str(group),
            zorder=3,
        )
        if result.expected is not None:
            expected = np.array([result.expected[e] for e in chosen])
            label = "theory" if number == len(groups) - 1 else None
            ax.hlines(
                expected, place - width / 2, place + width / 2, color="black", lw=1.5, label=label
            )
    ax.set_xticks(range(len(inner)), [f"${name}$" for name in inner])
    ax.set_xlim(-0.6, len(inner) - 0.4)
    ax.set_title(title, fontsize=10)
    ax.margins(y=0.2)
    ax.set_ylabel(labelled(SYMBOLS.get(result.label, "force per area"), result.units["value"]))
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.06), ncols=2)  # below: no data there


def _names(result: Result, entry: tuple[int, ...]) -> list[str]:
    axes = list(result.x.values())
    return [str(axis[i]) for axis, i in zip(axes[1:], entry[1:], strict=True)]


def _name(result: Result, entry: tuple[int, ...]) -> str:
    return "".join(_names(result, entry))


def _inner_names(result: Result, entries: list[tuple[int, ...]]) -> list[str]:
    return list(dict.fromkeys(_name(result, e) for e in entries))


def _is_normal(result: Result, entry: tuple[int, ...]) -> bool:
    names = _names(result, entry)
    return names[0] == (names[1] if len(names) > 1 else result.extra.get("axis"))


def _once(result: Result, entry: tuple[int, ...]) -> bool:
    """xy but not yx, which is the same up to noise."""
    return len(entry) < 3 or entry[1] < entry[2]
