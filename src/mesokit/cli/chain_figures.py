"""Figures that `mesokit theory` draws of fluids of chains, from theory alone."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.cli.chains import Beads, Chain
from mesokit.errors import CaseError

RATES = np.geomspace(1e-3, 100, 300)
POINTS, LEAST = 1500, 1e-4  # of a curve; the smallest correlation that is shown
FLOOR = 1e-6  # what zero is drawn as: below all that is shown


def velocity_modes(ax: Any, chains: Sequence[Chain], beads: Beads, wave: float, end: float) -> None:
    """Size of the correlation of transverse velocity modes: dips are where it changes its sign."""
    if not chains:
        raise CaseError("--draw velocity-modes: expected --length, with --K or --stress-time")
    from mesokit.report.style import legend_above, looks

    k, time = 2 * math.pi / wave, np.linspace(0, end, POINTS)
    for chain, (line, colour) in zip(chains, looks(), strict=False):
        elasticity = beads.density * beads.kT / (chain.length * beads.mass_density)
        curve = theory.transverse_correlation_chain(
            k, time, beads.viscosity, elasticity, chain.times.stress
        )
        springs = "1 spring" if chain.length == 2 else f"{chain.length - 1} springs"
        label = rf"{springs}, $\tau_1 = {chain.times.stress[0]:.3g}\,\tau$"
        ax.semilogy(
            *size_with_zeros(time, curve), linestyle=line, color=colour, lw=1.2, label=label
        )
    ax.set(xlim=(0, end), ylim=(LEAST, 1.2))
    ax.set_xlabel(r"time lag $t$  [$\tau$]")
    _say(ax, "Theory alone: Rouse chains in a simple fluid; approximate where tau follows from K")
    ax.set_ylabel(rf"$|C_v^T(k, t)|\,/\,C_v^T(k, 0)$ at $k = 2\pi/{wave:g}\,a^{{-1}}$")
    legend_above(ax)


def size_with_zeros(time: NDArray[Any], curve: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Times and sizes of a curve, with a point at each change of sign: all dips reach the floor.

    >>> time, size = size_with_zeros(np.array([0.0, 1, 2]), np.array([1.0, 0.5, -0.5]))
    >>> time.tolist(), size.tolist()
    ([0.0, 1.0, 1.5, 2.0], [1.0, 0.5, 1e-06, 0.5])
    """
    before = np.flatnonzero(curve[:-1] * curve[1:] < 0)
    step = (time[before + 1] - time[before]) / (curve[before] - curve[before + 1])
    time = np.insert(time, before + 1, time[before] + step * curve[before])
    return time, np.maximum(np.abs(np.insert(curve, before + 1, 0.0)), FLOOR)


def bond_lengths(ax: Any, chains: Sequence[Chain], beads: Beads, radii: Sequence[float]) -> None:
    """Root mean square length of bonds in shear, against the shear rate."""
    from mesokit.report.style import legend_above, looks

    if not chains:
        raise CaseError("--draw bonds: expected --length, with --K or --stress-time")
    several = itertools.product(chains, radii)
    for (chain, radius), (line, colour) in zip(several, looks(), strict=False):
        friction = 6 * math.pi * beads.eta * radius
        try:
            lengths = [
                theory.zimm_shear(chain.length, g, chain.K, friction, beads.eta, beads.kT)
                for g in RATES
            ]
        except ValueError as error:
            raise CaseError(f"--length {chain.length}, radius {radius:.3g}: {error}") from None
        label = rf"$n = {chain.length}$, $K = {chain.K:.3g}$, $R_H = {radius:.3g}\,a$"
        roots = np.sqrt([found.bond_squared for found in lengths])
        ax.loglog(RATES, roots, linestyle=line, color=colour, lw=1.2, label=label)
    _against_rate(ax, r"bond length  [$a$]")
    legend_above(ax, columns=2)


def spring_constants(
    ax: Any, lengths: Sequence[int], bond: float | None, beads: Beads, radii: Sequence[float]
) -> None:
    """Springs that hold the bonds of trimers at a length, against the shear rate."""
    if tuple(lengths) != (3,) or bond is None:
        raise CaseError("--draw springs: expected --length 3, of trimers, and --bond-length")
    from mesokit.report.style import legend_above, looks

    for radius, (line, colour) in zip(radii, looks(), strict=False):
        try:
            springs = [
                theory.trimer_spring_constant(bond, g, beads.eta, radius, beads.kT) for g in RATES
            ]
        except ValueError as error:
            raise CaseError(f"--bond-length = {bond:g}: {error}") from None
        label = rf"$l = {bond:g}\,a$, $R_H = {radius:.3g}\,a$"
        ax.loglog(RATES, springs, linestyle=line, color=colour, lw=1.2, label=label)
    _against_rate(ax, r"spring constant $K$  [$kT/a^2$]")
    legend_above(ax, columns=2)


def _say(ax: Any, words: str) -> None:
    """What a figure rests on, below it."""
    ax.figure.supxlabel(words, x=0.01, ha="left", fontsize=8)


def _against_rate(ax: Any, label: str) -> None:
    _say(ax, "Theory alone: hydrodynamic interaction averaged over all directions, approximate")
    ax.set_xlim(RATES[0], RATES[-1])
    ax.set_xlabel(r"shear rate $\dot\gamma$  [$\tau^{-1}$]")
    ax.set_ylabel(label)
