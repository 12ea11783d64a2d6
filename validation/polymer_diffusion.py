"""Diffusion of polymers in the fluid (Zimm) and in a random solvent (Rouse)."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from common import BLUE, GREY, RED, Page, found, long, main, plt

import mesokit
from mesokit import SRD, Box, Case, Comparison, Fluid, Harmonic, MaxwellBoltzmann, Run, theory
from mesokit.method.mpcd.solutes import Polymer, Solutes

LENGTH, DENSITY, TIMESTEP, ANGLE, MASS = 20, 10, 0.1, 130.0, 10.0
BEADS = 240  # in the box, in chains of one length
RUNS = {10: 2, 15: 3, 20: 3, 30: 4, 40: 5, 60: 6}  # beads of a chain: independent runs
STEPS, RANDOM_STEPS = 40_000, 100_000  # of one run
BOND = Harmonic(K=1.5)  # U = K r^2: root-mean-square length 1
VISCOSITY = (
    DENSITY
    * theory.transport(
        "srd", 3, DENSITY, TIMESTEP, angle=ANGLE, thermostat="maxwell-boltzmann"
    ).viscosity
)  # dynamic
ALONE = theory.bead_diffusion("srd", 3, DENSITY, TIMESTEP, ANGLE, MASS)
BY_IMAGES = 1.0 - theory.diffusion_in_box(1.0, LENGTH, VISCOSITY)  # what a periodic box takes


class Value(NamedTuple):
    """A number and its standard error."""

    value: float
    error: float


def case(chain: int, solvent: str, seed: int, steps: int) -> Case:
    """Chains of so many beads, enough of them for `BEADS`."""
    return Case(
        run=Run(steps=long(steps), warmup=500, seed=seed),
        box=Box([LENGTH] * 3),
        fluid=Fluid(
            density=DENSITY, timestep=TIMESTEP, collision=SRD(angle=ANGLE),
            thermostat=MaxwellBoltzmann(),
        ),
        solutes=Solutes(
            polymers=[Polymer(number=BEADS // chain, length=chain)], mass=MASS,
            bond=BOND if chain > 1 else None, solvent=solvent,
        ),
        observe=[mesokit.MeanSquareDisplacement(of="centres", every=10, max_lag=2000)],
    )  # fmt: skip


def diffusion(page: Page, chain: int, solvent: str) -> Value:
    """Mean over independent runs, as it is in the periodic box."""
    runs, steps = RUNS.get(chain, 1), STEPS if solvent == "fluid" else RANDOM_STEPS
    values = []
    for seed in range(1, runs + 1):
        files = page.run(f"{solvent}-{chain}-{seed}", case(chain, solvent, seed, steps))
        values.append(found(files["mean-square-displacement"], "diffusion coefficient"))
    mean = sum(c.measured for c in values) / runs
    return Value(mean, math.sqrt(sum(c.error**2 for c in values)) / runs)


def crowded(chain: int) -> float:
    """Diffusion coefficient of an ideal chain in a random solvent, beads of a cell counted.

    k beads in one cell lose the share turned M'/(k M + M') of their momentum to solvent of mass
    M', a Poisson number; k is drawn from ideal chains, with others spread evenly between them.
    """
    random = np.random.default_rng(1)
    number = np.arange(60)
    log_factorial = np.concatenate([[0.0], np.cumsum(np.log(number[1:]))])
    chance = np.exp(number * math.log(DENSITY) - DENSITY - log_factorial)
    turned = 2 / 3 * (1 - math.cos(math.radians(ANGLE)))
    k = np.arange(1, chain + 60)
    loss = turned * (chance * number / (k[:, None] * MASS + number)).sum(axis=1)
    losses = []
    for _ in range(4000):
        steps = random.normal(0, 1 / math.sqrt(3), (chain, 3))
        steps[0] = random.random(3)
        cells = np.floor(np.cumsum(steps, axis=0)).astype(int)
        _, own, count = np.unique(cells, axis=0, return_inverse=True, return_counts=True)
        others = random.poisson((BEADS - chain) / LENGTH**3, len(count))
        losses.append(loss[(count + others)[own.ravel()] - 1].mean())
    return TIMESTEP / (chain * MASS) * (1 / float(np.mean(losses)) - 0.5)


def exponent(values: dict[int, Value]) -> Value:
    """Slope of a straight line through the logarithms, weighted by their errors."""
    x = np.log(list(values))
    y = np.log([v.value for v in values.values()])
    weight = np.array([(v.value / v.error) ** 2 for v in values.values()])
    x = x - np.average(x, weights=weight)
    spread = (weight * x**2).sum()
    return Value(float((weight * x * y).sum() / spread), float(1 / math.sqrt(spread)))


def slope_of(law: Any, like: dict[int, Value]) -> float:
    """The same of a theory, at the same lengths with the same weights."""
    return exponent({n: Value(law(n), v.error * law(n) / v.value) for n, v in like.items()}).value


def smeared(n: int) -> float:
    """Kirkwood's formula with what the fluid has in place of Oseen's tensor at short distances.

    A bead hands its momentum to a cell that lies anywhere around it, and takes the velocity of such
    a cell: this adds four numbers uniform in [-1/2, 1/2] to each component of a distance, of
    variance 1/3 together. So n bonds of variance 1/3 each give <1/r> = sqrt(6/pi/(n + 1)), which of
    a bead with itself is finite: no friction has to be measured. Derived here.
    """
    return theory.kirkwood_in_cells(n, 1 / ALONE, VISCOSITY, 1.0)


def make() -> int:
    """Write the page."""
    page = Page("polymer_diffusion", "Diffusion of polymers with and without hydrodynamics")
    page.text(
        f"Ideal chains (U = K r^2, root-mean-square bond 1) of beads of mass {MASS:g} in SRD at "
        f"{ANGLE:g} degrees, density {DENSITY}, timestep {TIMESTEP}, {LENGTH}^3 cells, {BEADS} "
        f"beads in a box; eta = {VISCOSITY:.3f} (theory). D is the slope of the displacement of "
        "centres of mass up to 200 tau, in the fluid from five times the time in which momentum "
        "spreads over the box (L^2/(4 pi^2 nu)) on; errors are from the scatter of chains. In the "
        "fluid what the images of a periodic cube take, 2.837 kT/(6 pi eta L) = "
        f"{BY_IMAGES:.6f}, is added. In the random solvent (`solvent = 'random'`) the beads of a "
        "cell collide with as many particles as the cell would hold, which have no memory."
    )
    one = diffusion(page, 1, "fluid")
    bead = one.value + BY_IMAGES
    inside = {n: diffusion(page, n, "fluid") for n in RUNS}
    free = {n: Value(v.value + BY_IMAGES, v.error) for n, v in inside.items()}
    random = {n: diffusion(page, n, "random") for n in RUNS}
    local = {n: crowded(n) for n in RUNS}

    def kirkwood(n: int) -> float:
        return theory.kirkwood_diffusion(n, 1 / bead, VISCOSITY, 1.0)

    page.heading("In the fluid")
    page.text(
        "Kirkwood's formula has Oseen's tensor between beads, and the friction of a bead alone, "
        "which diffuses as the first line says. The fluid smears momentum over a cell, and so has "
        "less of a flow at short distances: with <1/r> smeared likewise (the theory of this table) "
        "nothing is fitted, and the bead alone comes out as well. In the note is how far D lies "
        "from Kirkwood's formula as it is. Without hydrodynamics a bead would have "
        f"{ALONE:.5f} (molecular chaos). The longest chains test the box: with an end-to-end "
        f"distance of {math.sqrt(59):.1f} they are not small in one of {LENGTH}, as the correction "
        "for its images has it, and four of them are not quite dilute."
    )
    rows = [Comparison("D, bead alone", bead, one.error, smeared(1), "a^2/tau")]
    for n, v in free.items():
        off = 100 * (v.value / kirkwood(n) - 1)
        note = f"{off:+.1f} % off Kirkwood's {kirkwood(n):.5f}"
        rows.append(Comparison(f"D, N = {n}", v.value, v.error, smeared(n), "a^2/tau", note))
    page.table(rows)
    page.heading("In the random solvent")
    page.text(
        "Theory is kT/(N zeta), zeta the friction of a bead that shares its cell with as many "
        "others as an ideal chain has there (drawn, not fitted): k beads in one cell lose together "
        f"less momentum than apart. Beads that are always alone would give {ALONE:.6f}/N."
    )
    page.table(
        [
            Comparison(f"D, N = {n}", v.value, v.error, local[n], "a^2/tau", "Rouse, cells shared")
            for n, v in random.items()
        ]
    )
    exponents(page, free, random, kirkwood, local)
    draw(page, free, random, kirkwood, local)
    return page.write()


def exponents(
    page: Page, free: dict[int, Value], random: dict[int, Value], kirkwood: Any,
    local: dict[int, float],
) -> None:  # fmt: skip
    """Of both, beside those of theory at the same lengths and of long chains."""
    page.heading("Exponents")
    zimm, rouse = exponent(free), exponent(random)
    both = f"{slope_of(kirkwood, free):.3f} (Kirkwood), {slope_of(smeared, free):.3f} (smeared)"
    shared = f"{slope_of(lambda n: local[n], random):.3f} (cells shared)"
    page.grid(
        ["D ~ N^x", "x measured", "theory at these N", "long chains"],
        [
            ["fluid", f"{zimm.value:.3f} +- {zimm.error:.3f}", both, "-0.5 (Zimm)"],
            ["random solvent", f"{rouse.value:.3f} +- {rouse.error:.3f}", shared, "-1 (Rouse)"],
        ],
    )
    page.check(
        f"in the fluid D falls with N^({zimm.value:.3f} +- {zimm.error:.3f}): within 0.1 of Zimm's "
        f"-0.5, and {abs(zimm.value + 1) / zimm.error:.0f} standard errors from Rouse's -1",
        abs(zimm.value + 0.5) < 0.1 and zimm.value + 1 > 5 * zimm.error,
    )
    page.check(
        f"in the random solvent D falls with N^({rouse.value:.3f} +- {rouse.error:.3f}): within "
        "0.1 of Rouse's -1",
        abs(rouse.value + 1) < 0.1,
    )


def draw(
    page: Page, free: dict[int, Value], random: dict[int, Value], kirkwood: Any,
    local: dict[int, float],
) -> None:  # fmt: skip
    """Both in one picture."""
    fig, ax = plt.subplots(figsize=(6, 4.5))
    n = np.arange(9, 67)
    ax.plot(n, [kirkwood(int(i)) for i in n], "--", color=BLUE, lw=1, label="Kirkwood")
    ax.plot(n, [smeared(int(i)) for i in n], "-", color=BLUE, lw=1, label="Kirkwood, smeared")
    zimm = [theory.zimm_diffusion(int(i), VISCOSITY, 1.0) for i in n]
    ax.plot(n, zimm, ":", color=BLUE, lw=1, label="Zimm, long chains ($N^{-1/2}$)")
    ax.plot(n, ALONE / n, ":", color=RED, lw=1, label="Rouse, beads alone ($N^{-1}$)")
    ax.plot(list(local), list(local.values()), "-", color=RED, lw=1, label="Rouse, cells shared")
    for values, colour, mark, label in (
        (free, BLUE, "o", "fluid"), (random, RED, "s", "random solvent"),
    ):  # fmt: skip
        ax.errorbar(
            list(values), [v.value for v in values.values()], [v.error for v in values.values()],
            fmt=mark, color=colour, mfc="white", label=label,
        )  # fmt: skip
    ax.set(xscale="log", yscale="log", xlabel="beads $N$", ylabel=r"$D$ ($a^2/\tau$)")
    ax.set_xticks(list(free), [str(i) for i in free])
    ticks = [0.0003, 0.0006, 0.001, 0.002, 0.004, 0.008]
    ax.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
    ax.minorticks_off()
    ax.legend(fontsize=8, labelcolor=GREY)
    page.figure(
        fig, "Diffusion coefficient of chains of N beads, in the fluid (circles, for an infinite "
        "box) and in the random solvent (squares).",
    )  # fmt: skip


if __name__ == "__main__":
    main(make)
