"""Oxidation of CO on a catalyst (Ziff, Gulari and Barshad 1986): what covers it, and what it makes.

python draw_catalyst.py      prints the rates and writes catalyst.png; half a minute

Below y = 0.387 of CO in the gas the surface is full of O, above 0.526 of CO: it is poisoned.
"""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from mesokit import Box, Run, Simulation
from mesokit.method.kinetic_monte_carlo.model.lattice_gas import GasProcess, LatticeGas
from mesokit.method.kinetic_monte_carlo.section import Lattice
from mesokit.method.kinetic_monte_carlo.start import UniformStart
from mesokit.report.style import COLOURS, LINES, STYLE, lettered

SIDE, BEFORE, TIME = 96, 600, 200
PARTS = (0.36, 0.38, 0.40, 0.42, 0.44, 0.46, 0.48, 0.50, 0.515, 0.535, 0.56)  # y
FIRST, SECOND = 0.387, 0.5256  # known transitions
SHOWN = 0.50


def covered(y):
    """Part of the sites with CO and with O, CO2 of a site and unit of time, and the surface."""
    gas = LatticeGas(
        species=("empty", "CO", "O"),
        process=(
            GasProcess(name="CO adsorbs", site="empty -> CO", rate=y),
            GasProcess(
                name="O2 adsorbs", site="empty -> O", neighbour="empty -> O", rate=(1 - y) / 4
            ),
            GasProcess(name="react", site="CO -> empty", neighbour="O -> empty", rate=1e4),
        ),
    )
    lattice = Lattice(timestep=1.0, model=gas, start=UniformStart())
    run = Run(steps=0, method="kinetic-monte-carlo")
    engine = Simulation(run=run, box=Box([SIDE, SIDE]), lattice=lattice).engine
    engine.advance(BEFORE)
    before, parts = engine.happened().sum(axis=1), []
    for _ in range(TIME):
        engine.advance(1)
        parts.append(np.bincount(engine.sites(), minlength=3)[1:] / engine.n)
    made = dict(zip(gas.events(), engine.happened().sum(axis=1) - before, strict=True))["react"]
    return *np.mean(parts, axis=0), made / (TIME * engine.n), engine.sites().reshape(SIDE, SIDE)


def main():
    """Vary the gas."""
    found = [covered(y) for y in PARTS]
    for y, (co, o, rate, _) in zip(PARTS, found, strict=True):
        print(f"y = {y:.3f}: CO {co:.3f}, O {o:.3f}, CO2 made {rate:.4f}")
    figure, (left, right) = plt.subplots(1, 2, figsize=(8, 3.4), layout="constrained")
    for k, name in enumerate(("CO on the surface", "O on the surface", "CO$_2$ made, per time")):
        values = [row[k] for row in found]
        left.plot(PARTS, values, LINES[k], marker="o", ms=4, color=COLOURS[k], label=name)
    for known in (FIRST, SECOND):
        left.axvline(known, color="0.6", lw=1, ls=":")
    left.set(xlabel="part $y$ of CO in the gas", ylabel="part of the sites", ylim=(0, 1.02))
    left.legend(fontsize=8, loc=(0.18, 0.28))
    from matplotlib.colors import ListedColormap

    surface = found[PARTS.index(SHOWN)][3]
    right.imshow(surface.T, origin="lower", cmap=ListedColormap(["white", *COLOURS[:2]]))
    right.set(xlabel="$x$  [$a$]", ylabel="$y$  [$a$]", title=f"$y = {SHOWN}$; colours of (a)")
    lettered([left, right])
    figure.savefig("catalyst.png", dpi=150)


if __name__ == "__main__":
    plt.rcParams.update(STYLE)
    main()
