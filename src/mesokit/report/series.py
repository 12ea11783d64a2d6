"""Time series: conserved quantities, a mean flow, and the velocity at a place."""

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from mesokit.report.caption import symbols
from mesokit.report.finish.legend import entries, legend_above
from mesokit.report.style import (
    COLOURS,
    HEIGHT,
    LINES,
    labelled,
    mean_line,
    sparse_logarithm,
    time_axis,
)
from mesokit.seam.result import Result

ROW = 1.25  # inches of a panel


def draw(result: Result, figure: Any, ax: Any) -> None:
    """Momentum, energy and temperature in time; in given axes the temperature alone.

    A number of particles that stays is a line above the panels. Where momentum or energy is
    conserved its change since the first sample is drawn, which is round-off. The kinetic energy is
    else drawn relative to theory, or per particle without theory. With a potential energy that and
    the kinetic one share a panel, and their sum has its own.
    """
    time, names = result.x["time"], [str(name) for name in result.x["component"]]
    if ax is not None:
        _temperature(result, ax, names.index("temperature"))
        ax.set_xlabel(labelled("time $t$", result.units["time"]))
        return
    bound = "potential_energy" in names
    number = result.value[:, names.index("number")]
    counted = int((number != number[:1]).any())
    rows = 3 + bound + counted
    figure.set_figheight(figure.get_figheight() + ROW * rows - HEIGHT)
    panels = figure.subplots(rows, 1, sharex=True)
    if counted:
        panels[0].plot(time, number, color=COLOURS[0], lw=1)
        panels[0].set_ylabel("particles\n$N$")
        panels[0].ticklabel_format(axis="y", useOffset=False)
    elif len(number):
        words = [f"$N = {number[0]:.0f}$ particles at all times", result.extra.get("not_steady")]
        panels[0].set_title("\n".join(filter(None, words)), loc="left", fontsize=9)
    momenta = [i for i, name in enumerate(names) if name.startswith("momentum")]
    _momentum(result, panels[counted], momenta)
    kinds = ("kinetic", "potential") if bound else ("kinetic",)
    energies = [result.value[:, names.index(f"{kind}_energy")] for kind in kinds]
    if bound:
        _energies(result, panels[counted + 1], energies)
    _energy(result, panels[-2], np.sum(energies, axis=0), "total" if bound else "kinetic")
    _temperature(result, panels[-1], names.index("temperature"))
    time_axis(panels[-1], time, result.units["time"])
    for panel in panels:
        panel.yaxis.label.set_size(9)
        panel.locator_params(axis="y", nbins=4)
    figure.align_ylabels()


def _energy(result: Result, ax: Any, energy: Any, kind: str) -> None:
    """Draw an energy relative to theory, or without theory that of a particle."""
    names = [str(name) for name in result.x["component"]]
    time, number = result.x["time"], result.value[:, names.index("number")]
    wanted = np.full(len(energy), np.nan)
    if result.expected is not None and kind == "kinetic":
        wanted = result.expected[:, names.index("kinetic_energy")]
    words = "change"
    if result.extra.get("conserves_energy") and len(energy):
        wanted = np.full(len(energy), energy[0])
    elif np.isfinite(wanted).any():
        words = "to theory"
    if not len(energy) or not np.isfinite(wanted).all() or not wanted.all():
        each = energy / np.where(number > 0, number, 1)
        unit = result.units["kinetic_energy"]
        return _scaled(ax, f"{kind} energy\nof a particle", [(time, each, {})], unit)
    ax.axhline(0.0, color="black", lw=1.3, label="theory", zorder=1)
    change = (energy - wanted) / abs(wanted)
    _scaled(ax, f"{kind} energy\nrel. {words}", [(time, change, {"zorder": 2})], "")
    _beside(ax)


def _energies(result: Result, ax: Any, energies: list[Any]) -> None:
    """Draw changes of the kinetic and the potential energy since the first sample."""
    curves = [
        (result.x["time"], energy - energy[:1], _look(k, word))
        for k, (energy, word) in enumerate(zip(energies, ("kinetic", "potential"), strict=True))
    ]
    _scaled(ax, "energy\nchange", curves, result.units["kinetic_energy"])
    _beside(ax)


def _momentum(result: Result, ax: Any, columns: list[int]) -> None:
    """Draw the components of the momentum, or their changes where these should be zero."""
    time, names = result.x["time"], [str(name) for name in result.x["component"]]
    expected, unit = result.expected, result.units[names[columns[0]]]
    value = result.value[:, columns]
    change = value - value[:1]
    flows = not bool(result.extra.get("conserves_momentum", _constant(expected, columns)))
    curves: list[Any] = [
        (time, (value if flows else change)[:, k], _look(k, f"${names[i][-1]}$"))
        for k, i in enumerate(columns)
    ]
    theory = {"color": "black", "lw": 1.3, "label": "theory"}
    if flows and expected is not None:
        known = [i for i in columns if np.isfinite(expected[:, i]).any()]
        curves += [(time, expected[:, i], theory) for i in known]
    _scaled(ax, "momentum" if flows else "momentum\nchange", curves, unit)
    _beside(ax)


def _look(k: int, label: str) -> dict[str, Any]:
    return {"ls": LINES[k], "color": COLOURS[k], "label": label}


def _constant(expected: Any, columns: list[int]) -> bool:
    """Whether theory says that these stay as they were."""
    if expected is None or not len(expected):
        return False
    wanted = expected[:, columns]
    return bool(np.isfinite(wanted).all() and (wanted == wanted[:1]).all())


def _scaled(ax: Any, label: str, curves: Iterable[tuple[Any, Any, Any]], unit: str) -> None:
    """Draw curves, with their power of ten and unit in a second line of the label."""
    curves = list(curves)
    sizes = [abs(y[np.isfinite(y)]).max(initial=0.0) for _, y, _ in curves]
    largest = max(sizes, default=0.0)
    power = math.floor(math.log10(largest)) if largest > 0 else 0
    power = power if not -2 <= power < 4 else 0
    for x, y, style in curves:
        ax.plot(x, y / 10.0**power, **{"color": COLOURS[0], "lw": 1, **style})
    times = rf"$10^{{{power}}}$" if power else ""
    words = " ".join(filter(None, (times, symbols(unit))))
    ax.set_ylabel(f"{label}\n[{words}]" if words else label)


def _beside(ax: Any) -> None:
    """A legend to the right of the panel, where it hides no data."""
    if handles := entries([ax]):
        ax.legend(handles.values(), handles, loc="center left", bbox_to_anchor=(1.0, 0.5))


def draw_flow(result: Result, ax: Any) -> None:
    """Mean velocity in time, its average with the error as a band, and the theory."""
    time = result.x["time"]
    names = {"hagen-poiseuille": "Hagen-Poiseuille", "poiseuille": "Poiseuille, no slip"}
    ax.plot(time, result.value, color=COLOURS[0], lw=0.8, label="measured")
    mean_line(ax, result.extra["mean"], result.extra["mean_error"])
    if result.expected is not None and len(time):
        label = f"theory: {names.get(result.theory, result.theory)}"
        ax.axhline(result.expected[0], color="black", lw=1.5, label=label)
    time_axis(ax, time, result.units["time"])
    ax.set_ylabel(labelled(f"mean velocity along ${result.extra['axis']}$", result.units["value"]))
    legend_above(ax)


def draw_signal(result: Result, figure: Any, ax: Any) -> None:
    """Velocity at a place over its power spectrum; in given axes the velocity alone."""
    bottom = None
    if ax is None:
        ax, bottom = figure.subplots(2, 1, height_ratios=[2, 3])
    time, letter = result.extra["time"], result.extra["component"]
    ax.plot(time, result.extra["velocity"][:, "xyz".index(letter)], color=COLOURS[0], lw=0.8)
    time_axis(ax, time, result.units["time"])
    ax.set_ylabel(labelled(f"velocity $v_{letter}$", result.units["velocity"]))
    if bottom is None:
        return
    bottom.set_xlabel(labelled("frequency $f$", result.units["frequency"]))
    bottom.set_ylabel(labelled(f"power of $v_{letter}$", result.units["value"]))
    use = result.value > 0
    if not use.any():
        bottom.text(0.5, 0.5, "too few samples", ha="center", transform=bottom.transAxes)
        return
    frequency, power, error = result.x["frequency"][use], result.value[use], result.error[use]
    low, band = np.maximum(power - error, 1e-3 * power), {"color": COLOURS[0], "alpha": 0.25}
    bottom.fill_between(frequency, low, power + error, lw=0, label="one standard error", **band)
    bottom.plot(frequency, power, color=COLOURS[0], lw=1.2, label="measured")
    peak = result.extra["dominant"]
    if np.isfinite(peak):
        bottom.axvline(peak, color=COLOURS[1], ls="--", lw=1.3, label="dominant frequency")
    bottom.set(xscale="log", yscale="log")
    sparse_logarithm(bottom.xaxis, frequency[0], frequency[-1])
    sparse_logarithm(bottom.yaxis, float(low.min()), float(power.max()))
    legend_above(bottom)


def _temperature(result: Result, ax: Any, index: int) -> None:
    value, expected = result.value[:, index], result.expected
    known = expected is not None and bool(np.isfinite(expected[:, index]).any())
    time, label = result.x["time"], "measured" if known else None
    ax.plot(time, value, color=COLOURS[0], lw=0.8, label=label)
    if expected is not None and known:
        ax.plot(time, expected[:, index], color="black", lw=1.3, label="theory")
        level = float(np.nanmean(expected[:, index]))
        reach = 1.6 * max(float(np.nanmax(abs(value - level))), 1e-3 * abs(level))
        ax.set_ylim(level - reach, level + reach)
    words = "$k_BT$ with\nthe flow" if result.extra.get("driven") else "temperature\n$k_BT$"
    ax.set_ylabel(labelled(words, result.units[str(result.x["component"][index])]))
    ax.ticklabel_format(axis="y", useOffset=False)
    _beside(ax)
