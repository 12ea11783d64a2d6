"""Figures 5.1 to 5.12 of the thesis: decay of transverse velocity modes, at rest."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from common import BLUE, GREEN, GREY, PURPLE, RED, Page, plt

from mesokit import Case, Comparison, theory
from mesokit.method.mpcd.expected.molecules import without_bonds

COLOURS, MARKS = (BLUE, RED, GREY), ("o", "s", "^")
LONG_WAVES = ("5.3", "5.4", "5.5", "5.9")  # what the thesis draws in
SIMPLE = ("figure 5.1", "figure 5.2")
BEST, BASE = "finite k", "finite k, background of free particles"
FINE = 400  # points of a line
FLOOR = 1e-6  # what zero is drawn as: below all that is shown
DROWNED = 2.0  # standard errors below which theory has drowned in noise


class Curve(NamedTuple):
    """A measured correlation with its errors, and what gives theory by name for any time.

    n is the length of the wave.
    """

    figure: str
    n: float
    time: Any
    value: Any
    error: Any
    laws: Callable[[Any], dict[str, Any]]


def mode_time(files: Any) -> Comparison:
    """Time of the slowest normal mode."""
    return next(c for c in files["normal-modes"].comparisons if "time 1" in c.what)


def laws(case: Case, slowest: float, background: float, k: float, t: Any) -> dict[str, Any]:
    """Rouse theory with a measured time of the slowest mode.

    At finite k with the measured background viscosity and with that of free particles (BASE); and
    for long waves with the latter.
    """
    molecule, nu = case.fluid.molecule, without_bonds(case).viscosity
    modes = theory.linear_modes(molecule.length)
    times = theory.rouse_times_from_slowest(modes, mode_time=slowest).stress
    bond = theory.mean_square_bond(K=molecule.bond.K)
    diffusion = bond / 3 / (slowest * modes.eigenvalues[1]) / molecule.length
    share = 1 / molecule.length
    return {
        **{
            name: theory.transverse_correlation_finite_k(
                k, t, viscosity, share, theory.GaussianMolecule(modes, slowest, bond, diffusion)
            )
            for name, viscosity in ((BEST, background), (BASE, nu))
        },
        "long waves": theory.transverse_correlation_chain(k, t, nu, share, times),
    }


def simple_law(viscosity: float, k: float, t: Any) -> dict[str, Any]:
    """Of a simple fluid."""
    return {"theory": theory.transverse_correlation(k, t, viscosity)}


def curves(figure: str, case: Case, files: Any, background: Comparison | None) -> list[Curve]:
    """All measured correlations of a run."""
    result, found = files["transverse-modes"], []
    t = result.x["time"]
    for i, k in enumerate(result.x["wavenumber"]):
        if background is None:
            beside = functools.partial(simple_law, without_bonds(case).viscosity, k)
        else:
            beside = functools.partial(
                laws, case, mode_time(files).measured, background.measured, k
            )
        n = k * case.box.size[0] / (2 * math.pi)
        found.append(Curve(figure, n, t, result.value[:, i], result.error[:, i], beside))
    return found


def deviation(curve: Curve, name: str) -> Comparison:
    """The largest from a theory, as far as that is above noise."""
    law = curve.laws(curve.time)[name]
    use = slice(1, np.flatnonzero(np.abs(law) > DROWNED * curve.error)[-1] + 1)
    off = curve.value[use] - law[use]
    worst = int(np.argmax(np.abs(off)))
    rms = math.sqrt(np.mean(off**2))
    noise = math.sqrt(np.mean(curve.error[use] ** 2))
    what = f"largest deviation, k_n = {root(curve.n)}, {name}"
    note = f"of {len(off)} delays; rms {rms:.3f}, of the errors {noise:.3f}"
    return Comparison(what, float(off[worst]), float(curve.error[use][worst]), 0.0, "", note)


def root(n: float) -> str:
    """1, sqrt 2, 2."""
    square = round(n * n)
    whole = math.isqrt(square)
    return str(whole) if whole * whole == square else f"sqrt {square}"


def draw(ax: Any, curve: Curve, number: int, until: float, name: str) -> None:
    """Points with errors, and one theory."""
    colour, use = COLOURS[number], curve.time <= until
    step = max(1, int(use.sum()) // 45)
    some = np.flatnonzero(use)[::step]
    ax.errorbar(
        curve.time[some], curve.value[some], curve.error[some], fmt=MARKS[number], ms=3, lw=0.8,
        mfc="white", color=colour, label=f"$|k_n| = {root(curve.n).replace('sqrt ', chr(8730))}$",
    )  # fmt: skip
    fine = np.linspace(0, until, FINE)
    beside = curve.laws(fine)
    labels = ("theory", "theory, free particles") if number == 0 else (None, None)
    ax.plot(fine, beside[name], "-", color=colour, lw=1, label=labels[0])
    if BASE in beside:
        ax.plot(fine, beside[BASE], ":", color=colour, lw=1, label=labels[1])
    ax.axhline(0, color="k", lw=0.4)


def dressed(ax: Any, title: str, until: float) -> None:
    """Title, labels, legend."""
    ax.set(title=title, xlabel="time", ylabel="$C(k, t)/C(k, 0)$", xlim=(0, until))
    ax.legend(loc="upper right")


def picture(
    page: Page, panels: list[tuple[str, list[Curve], float]], text: str, suffix: str
) -> None:
    """Curves of several figures side by side."""
    rows = len(panels) // 2
    fig, axes = plt.subplots(rows, 2, figsize=(8.8, 3.8 * rows))
    for ax, (title, shown, until) in zip(axes.flat, panels, strict=True):
        for number, curve in enumerate(shown):
            draw(ax, curve, number, until, "theory" if title in SIMPLE else BEST)
        dressed(ax, title, until)
    page.figure(fig, text, suffix)


def dimer_panels(all_of: dict[str, list[Curve]], case: Case, slowest: float) -> Any:
    """Figures 5.3 to 5.5: sizes on a logarithmic scale, with the envelope; and one curve."""
    fig, axes = plt.subplots(1, 3, figsize=(13, 3.8))
    for ax, name, until in zip(axes, ("5.3", "5.4", "5.5"), (50, 30, 30), strict=True):
        for number, curve in enumerate(all_of[name]):
            colour, use = COLOURS[number], (curve.time <= until) & (curve.time > 0)
            seen = use & (np.abs(curve.value) > curve.error)
            size = np.abs(curve.value[seen])
            ax.errorbar(
                curve.time[seen], size, curve.error[seen], fmt=MARKS[number], ms=2.5, lw=0.6,
                mfc="white", color=colour,
                label=f"$|k_n| = {root(curve.n).replace('sqrt ', chr(8730))}$",
            )  # fmt: skip
            t = np.linspace(0, until, FINE)
            label = "theory" if number == 0 else None
            ax.plot(*size_with_zeros(t, curve.laws(t)[BEST]), "-", color=colour, lw=1, label=label)
        if name == "5.3":
            k, nu = 2 * math.pi / case.box.size[0], without_bonds(case).viscosity
            ax.plot(t, np.exp(-(2 / slowest + k * k * nu) * t / 2), "--", color=GREEN,
                    label="envelope, long waves")  # fmt: skip
        dressed(ax, f"figure {name}", until)
        ax.set(yscale="log", ylim=(6e-3, 1.2), ylabel="$|C(k, t)|/C(k, 0)$")
    return fig


def size_with_zeros(time: Any, curve: Any) -> tuple[Any, Any]:
    """Times and sizes of a curve, with a point at each change of sign: all dips reach the floor."""
    before = np.flatnonzero(curve[:-1] * curve[1:] < 0)
    step = (time[before + 1] - time[before]) / (curve[before] - curve[before + 1])
    time = np.insert(time, before + 1, time[before] + step * curve[before])
    return time, np.maximum(np.abs(np.insert(curve, before + 1, 0.0)), FLOOR)


def theory_panels(measured: dict[str, tuple[Case, float, Curve]]) -> Any:
    """Figures 5.10 to 5.12: curves of theory in the thesis' box, and one measured for each."""
    nu, k = 0.8705, 2 * math.pi / 30
    t = np.linspace(0, 100, 800)
    choices: dict[str, list[tuple[str, int, float]]] = {
        "5.10": [(f"N = {n}", n, 26.8) for n in (1, 2, 5, 10)],
        "5.11": [(rf"$\tau_1$ = {tau}", 1, tau) for tau in (3.35, 6.7, 13.4, 26.8)],
        "5.12": [(rf"$\tau_1$ = {tau}", 10, tau) for tau in (6.7, 13.4, 26.8, 53.6)],
    }
    fig, axes = plt.subplots(2, 3, figsize=(13, 7))
    for column, (name, lines) in enumerate(choices.items()):
        top, below = axes[:, column]
        looks = zip((BLUE, RED, GREEN, PURPLE), ("-", "--", "-.", ":"), strict=True)
        for (label, springs, tau), (colour, line) in zip(lines, looks, strict=True):
            modes = theory.linear_modes(springs + 1)
            times = theory.rouse_times_from_slowest(modes, stress_time=tau).stress
            c = theory.transverse_correlation_chain(k, t, nu, 1 / (springs + 1), times)
            top.semilogy(*size_with_zeros(t, c), line, color=colour, label=label)
        top.set(title=f"figure {name}, theory at $k = 2\\pi/30$", ylim=(1e-4, 1.2), xlim=(0, 100))
        top.set(xlabel="time", ylabel="$|C(k, t)|/C(k, 0)$")
        top.legend(loc="upper right", ncols=2)
        case, slowest, curve = measured[name]
        draw(below, curve, 0, 50, BEST)
        springs, length = case.fluid.molecule.length - 1, case.box.size[0]
        dressed(below, f"N = {springs}, stress time {slowest / 2:.1f}, box of {length}", 50)
    return fig


def rows_of(
    shown: list[Curve], case: Case, files: Any, background: Comparison | None, friction: float
) -> list[Comparison]:
    """What a run measured beside theory."""
    if background is None:
        return [
            Comparison(c.what, c.measured, c.error, c.expected, c.unit, "molecular chaos")
            for c in files["transverse-modes"].comparisons
            if c.what.startswith("viscosity")
        ]
    names = [BEST, BASE] + (["long waves"] if shown[0].figure in LONG_WAVES else [])
    slowest, expected = mode_time(files), hydrodynamic_time(case, friction)
    molecule = case.fluid.molecule
    alone = theory.rouse_times(theory.linear_modes(molecule.length), friction, K=molecule.bond.K)
    note = f"hydrodynamic; without, {alone.mode[0]:.2f}"
    return [
        *(deviation(curve, name) for curve in shown for name in names),
        Comparison(
            "time of the slowest mode", slowest.measured, slowest.error, expected, "tau", note
        ),
        background,
    ]


def hydrodynamic_time(case: Case, friction: float) -> float:
    """Time of the slowest mode with hydrodynamic interaction, from the friction of a free bead."""
    molecule = case.fluid.molecule
    length = math.sqrt(theory.mean_square_bond(K=molecule.bond.K))
    eta = without_bonds(case).dynamic_viscosity
    return float(theory.zimm_times(molecule.length, friction, eta, length).mode[0])
