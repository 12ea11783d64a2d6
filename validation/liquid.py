"""A Lennard-Jones liquid: energy, pressure and diffusion beside the benchmark of NIST."""

from __future__ import annotations

from typing import Any

import numpy as np
from common import Page, long, main, mean_and_error

from mesokit import (
    Box,
    Comparison,
    Langevin,
    LennardJones,
    RescaleAll,
    Run,
    Simulation,
    SoftSpheres,
    theory,
)

KT, CUTOFF, NUMBER, STEP, BLOCKS = 0.85, 3.0, 500, 0.002, 20
# density: energy and pressure by Monte Carlo, diffusion by NVE: NIST Standard Reference Simulation
# Website, Lennard-Jones, cut off at 3 with tail corrections, T = 0.85
NIST = {
    0.776: (-5.5121, 0.0068, 0.061),
    0.820: (-5.7947, 0.5536, 0.048),
    0.860: (-6.0305, 1.2660, 0.035),
}


def liquid(density: float, thermostat: Any, state: Any = None) -> Any:
    """An engine; from a lattice unless it goes on from a state."""
    engine = Simulation(
        run=Run(steps=0, method="soft-spheres"),
        box=Box([(NUMBER / density) ** (1 / 3)] * 3),
        spheres=SoftSpheres(
            number=NUMBER,
            kT=KT,
            pair=LennardJones(cutoff=CUTOFF, shift=False),
            timestep=STEP,
            thermostat=thermostat,
        ),
        threads=1,
    ).engine
    if state is not None:
        engine.restore({name: np.array(array) for name, array in state.items()})
    return engine


def diffusion(engine: Any) -> tuple[float, float]:
    """From mean square displacements between 2 and 6, with constant energy."""
    slopes, (early, late) = [], (round(2 / STEP), round(6 / STEP))
    for _ in range(max(4, long(20))):
        start = engine.positions(unwrapped=True)
        moved = []
        for steps in (early, late - early):
            engine.advance(steps)
            way = engine.positions(unwrapped=True) - start
            way -= way.mean(axis=0)
            moved.append((way**2).sum(1).mean())
        slopes.append((moved[1] - moved[0]) / (6 * (late - early) * STEP))
    return mean_and_error(slopes)


def make() -> int:
    """The page; how many requirements were not met."""
    page = Page("liquid", "A Lennard-Jones liquid", "epsilon, sigma and the mass are 1")
    page.text(
        f"{NUMBER} particles at T = 0.85, cut off at 3, with tail corrections (D5), beside the "
        "NIST Standard Reference Simulation Website: energy of each and pressure by Monte Carlo, "
        "diffusion by molecular dynamics of constant energy in boxes of the same sort (which "
        "boxes of this size lower by some percent)."
    )
    rows, off = [], {"U": 0.0, "p": 0.0, "D": 0.0}
    for density, known in NIST.items():
        tail = theory.lennard_jones_tail(density, CUTOFF)
        molten = liquid(density, RescaleAll(kT=2.0, every=10))
        molten.advance(max(500, long(10_000)))
        engine = liquid(density, Langevin(kT=KT, friction=1.0), molten.state())
        engine.advance(max(1000, long(40_000)))
        seen = []
        for _ in range(max(4 * BLOCKS, long(12_000))):
            engine.advance(20)
            pair = -float(np.trace(engine.stress["pair"])) / 3
            seen.append((engine.energies()["contact"] / NUMBER, pair))
        blocks = np.array_split(np.array(seen), BLOCKS)
        (u, p), (du, dp) = mean_and_error([block.mean(0) for block in blocks])
        u, p = u + tail.energy, p + density * KT + tail.pressure
        hot = liquid(density, RescaleAll(kT=KT, every=10), engine.state())
        hot.advance(1000)
        d, dd = diffusion(liquid(density, None, hot.state()))
        rows += [
            Comparison(f"U/N at {density}", u, du, known[0]),
            Comparison(f"p at {density}", p, dp, known[1]),
            Comparison(f"D at {density}", d, dd, known[2], "", "approximate: known to two digits"),
        ]
        off["U"] = max(off["U"], abs(u / known[0] - 1))
        off["p"] = max(off["p"], abs(p - known[1]))
        off["D"] = max(off["D"], abs(d / known[2] - 1))
    page.table(rows)
    page.check(f"energies within {100 * off['U']:.3f} % (0.1 %)", off["U"] < 0.001)
    page.check(f"pressures within {off['p']:.4f} (0.02)", off["p"] < 0.02)
    page.check(f"diffusion within {100 * off['D']:.1f} % (6 %)", off["D"] < 0.06)
    return page.write()


if __name__ == "__main__":
    main(make)
