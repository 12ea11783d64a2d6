"""Fluids of chains by theory alone: velocity modes, and the bonds of trimers in shear.

python draw_chains.py        writes chains.png; some seconds

Figures 5.10, 5.11, 5.12, 6.1 and 6.2 of D. Toneian, TU Wien (2015). The numbers below may be
changed.
"""

import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from mesokit import theory
from mesokit.report.style import STYLE, lettered, looks

DENSITY = 10
FLUID = theory.transport("srd", 3, DENSITY, timestep=0.1, angle=130)
WAVE, END = 30, 100  # wave length of velocity modes in cells, and their latest time
CHAINS = (  # panels of velocity modes: beads of a chain and its slowest stress time
    [(2, 26.8), (3, 26.8), (6, 26.8), (11, 26.8)],
    [(2, 3.35), (2, 6.7), (2, 13.4), (2, 26.8)],
    [(11, 6.7), (11, 13.4), (11, 26.8), (11, 53.6)],
)
RADII = (0.3, 0.104)  # hydrodynamic, of a bead: of the thesis, and of a particle of this fluid
BOND, SPRING = 2.0, 1.0  # length that springs hold in (d), and K of the bonds in (e)
RATES = np.geomspace(1e-3, 100, 300)
FLOOR = 1e-6  # what zero is drawn as: below all that is shown


def velocity_modes(beads, stress_time):
    """Times and correlation of the transverse velocity modes of a wave: Rouse, long waves."""
    time = np.linspace(0, END, 1500)
    modes = theory.linear_modes(beads)
    times = theory.rouse_times_from_slowest(modes, stress_time=stress_time).stress
    k = 2 * math.pi / WAVE
    return time, theory.transverse_correlation_chain(k, time, FLUID.viscosity, 1 / beads, times)


def size_with_zeros(time, curve):
    """Times and sizes of a curve, with a point at each change of sign: all dips reach the floor."""
    before = np.flatnonzero(curve[:-1] * curve[1:] < 0)
    step = (time[before + 1] - time[before]) / (curve[before] - curve[before + 1])
    time = np.insert(time, before + 1, time[before] + step * curve[before])
    return time, np.maximum(np.abs(np.insert(curve, before + 1, 0.0)), FLOOR)


def springs(radius):
    """K that holds the bonds of trimers at a length, for each shear rate."""
    eta = FLUID.dynamic_viscosity
    return [theory.trimer_spring_constant(BOND, rate, eta, radius) for rate in RATES]


def bonds(radius):
    """Root mean square length of the bonds of trimers, for each shear rate."""
    eta = FLUID.dynamic_viscosity
    friction = 6 * math.pi * eta * radius
    found = [theory.zimm_shear(3, rate, SPRING, friction, eta) for rate in RATES]
    return [math.sqrt(chain.bond_squared) for chain in found]


def main():
    """Draw five panels, and print a number of each kind."""
    figure, axes = plt.subplots(2, 3, figsize=(12, 7.5), layout="constrained")
    *modes, held, free = axes.flat[:5]
    axes.flat[5].axis("off")
    for ax, chains in zip(modes, CHAINS, strict=True):
        for (beads, slowest), (line, colour) in zip(chains, looks(), strict=False):
            label = rf"{beads} beads, $\tau_1 = {slowest:g}\,\tau$"
            curve = size_with_zeros(*velocity_modes(beads, slowest))
            ax.semilogy(*curve, linestyle=line, color=colour, lw=1.2, label=label)
        ax.set(xlim=(0, END), ylim=(1e-4, 40), xlabel=r"time lag $t$  [$\tau$]")
        ax.set_ylabel(rf"$|C_v^T(k, t)|\,/\,C_v^T(k, 0)$ at $k = 2\pi/{WAVE}\,a^{{-1}}$")
    for radius, (line, colour) in zip(RADII, looks(), strict=False):
        label = rf"$R_H = {radius:g}\,a$"
        for ax, values in ((held, springs(radius)), (free, bonds(radius))):
            ax.loglog(RATES, values, linestyle=line, color=colour, lw=1.2, label=label)
    held.set_ylabel(rf"$K$ for bonds of ${BOND:g}\,a$  [$kT/a^2$]")
    free.set_ylabel(rf"bond length at $K = {SPRING:g}\,kT/a^2$  [$a$]")
    for ax in (held, free):
        ax.set(xlim=(RATES[0], RATES[-1]), xlabel=r"shear rate $\dot\gamma$  [$\tau^{-1}$]")
    lettered([*modes, held, free])
    for ax in (*modes, held, free):
        ax.legend(loc="upper right" if ax in modes else "upper left")
    for beads, slowest in ((2, 26.8), (11, 26.8)):
        at = np.interp([5, 20], *velocity_modes(beads, slowest))
        print(f"{beads} beads, stress time {slowest:g}: {at[0]:.5f} at time 5, {at[1]:.5f} at 20")
    for radius in RADII:
        K, length = (np.interp(0.1, RATES, found(radius)) for found in (springs, bonds))
        print(
            f"trimers at rate 0.1, R_H {radius:g}: K {K:.3f} holds bonds, bond length {length:.3f}"
        )
    figure.savefig("chains.png", dpi=100)


if __name__ == "__main__":
    plt.rcParams.update(STYLE)
    main()
