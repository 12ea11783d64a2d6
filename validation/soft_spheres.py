"""Soft disks and spheres: collisions of two, friction, energy, fluids, the limit of hard ones."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from common import BLUE, RED, Page, long, main, mean_and_error, plt
from scipy.integrate import quad

from mesokit import (
    Box,
    Comparison,
    HertzLaw,
    Langevin,
    LennardJones,
    Plates,
    RandomStart,
    Run,
    Simulation,
    SoftSpheres,
    SphereKind,
    SpringDashpot,
    theory,
)
from mesokit.potential.protocol import central
from mesokit.potential.wca import WCA

UNITS = "diameter and mass of a sphere, kT at the start are 1"
BLOCKS = 20
STEP = "approximate: finite step"
LOOKS = 1500  # at the forces of a block: few spheres touch at a time
PHASES = np.arange(20) / 20  # of a step, at which spheres first touch
NIST = Path(__file__).parent.parent / "tests" / "laws" / "nist_lj_cfg4.txt"


def soft(
    size: Any, walls: Any = (), positions: Any = None, velocities: Any = None, **given: Any
) -> Any:
    """The engine of some soft spheres; those that are placed are at rest unless said."""
    arrays = {}
    if positions is not None:
        n, d = np.shape(positions)
        still = np.zeros((n, d)) if velocities is None else velocities
        spins = np.zeros(n if d == 2 else (n, 3))
        arrays = {"positions": positions, "velocities": still, "spins": spins}
    return Simulation(
        run=Run(steps=0, method="soft-spheres"),
        box=Box(size),
        walls=walls,
        spheres=SoftSpheres(**given),
        **arrays,
    ).engine


def total(engine: Any) -> float:
    """Energy of motion and of contacts."""
    return float(sum(engine.energies()[name] for name in ("translation", "rotation", "potential")))


def collision(law: Any, speed: float, steps: float, phase: float = 0.0) -> tuple[float, ...]:
    """Restitution, duration and largest overlap of two disks that meet head on; `steps` are those
    of a contact, `phase` the part of a step by which they are apart at first."""
    dt = law.contact_time_of(0.5, speed) / steps
    away = 0.5 + 0.5 * speed * dt * (1 + phase)
    places = [[5 - away, 5.0], [5 + away, 5.0]]
    velocities = np.array([[speed / 2, 0.0], [-speed / 2, 0.0]])
    engine = soft([10, 10], (), places, velocities, number=2, pair=law, timestep=dt)
    gaps = []
    for _ in range(int(3 * steps) + 10):
        engine.advance(1)
        x = engine.positions(unwrapped=True)[:, 0]
        gaps.append(x[1] - x[0] - 1)
    overlap, v = -np.array(gaps), engine.velocities()[:, 0]
    return (v[1] - v[0]) / speed, duration(overlap, dt, speed), largest(overlap)


def duration(overlap: Any, dt: float, speed: float) -> float:
    """From the first to the last touch, of which straight lines tell the parts of a step."""
    inside = np.flatnonzero(overlap > 0)
    first, last = inside[0], inside[-1]
    before = overlap[first] / (speed * dt)
    after = overlap[last] / (overlap[last] - overlap[last + 1])
    return float((last - first + before + after) * dt)


def largest(overlap: Any) -> float:
    """The top of the parabola through the three largest values."""
    i = int(np.argmax(overlap))
    a, b, c = overlap[i - 1 : i + 2]
    return float(b - (a - c) ** 2 / (8 * (a - 2 * b + c)))


def spring_and_dashpot(page: Page) -> None:
    """D1: restitution and duration of a spring and dashpot."""
    page.heading("Spring and dashpot (D1)")
    page.text(
        "Two disks meet head on, k = 1e5: restitution and duration, means over where in a step "
        "they touch first, with the spread of single collisions; beside the closed forms "
        "(Schwager and Poeschel 2007 where the force never pulls)."
    )
    laws = {
        "g = 20": SpringDashpot(stiffness=1e5, damping=20),
        "g = 20, never pulls": SpringDashpot(stiffness=1e5, damping=20, pulls=False),
        "g = 200": SpringDashpot(stiffness=1e5, damping=200),
        "g = 400, never pulls": SpringDashpot(stiffness=1e5, damping=400, pulls=False),
    }
    grid, worst, slowest = [], 0.0, 0.0
    for name, law in laws.items():
        e, time = law.restitution_of(0.5, 1.0), law.contact_time_of(0.5, 1.0)
        row = [name, f"{e:.6f}"]
        for steps in (10, 20, 50, 100):
            found = np.array([collision(law, 1.0, steps, phase)[0] for phase in PHASES]) / e - 1
            row.append(f"{100 * found.mean():+.3f} ({100 * found.std():.3f})")
            if steps == 50:
                worst = max(worst, abs(found.mean()))
        if law.pulls:
            lasted = [collision(law, 1.0, 50, phase)[1] for phase in PHASES]
            slowest = max(slowest, abs(np.mean(lasted) / time - 1))
        grid.append(row)
    head = ["", "restitution", *(f"off in % with {steps} steps" for steps in (10, 20, 50, 100))]
    page.grid(head, grid)
    page.check(f"restitution within {100 * worst:.3f} % with 50 steps (0.1 %)", worst < 0.001)
    page.check(f"duration within {100 * slowest:.3f} % with 50 steps (0.1 %)", slowest < 0.001)


def hertz(page: Page) -> None:
    """D2: Hertz."""
    page.heading("Hertz (D2)")
    page.text("The same with F = k x^(3/2), k = 1e5, without damping, 50 steps in a contact.")
    law, expected = HertzLaw(stiffness=1e5), theory.hertz_contact(1e5, 0.5, 1.0)
    found = np.array([collision(law, 1.0, 50, phase) for phase in PHASES])
    e, time, deepest = found.mean(0)
    linear = SpringDashpot(stiffness=1e5, damping=0)
    flat = np.array([collision(linear, 1.0, 50, phase)[2] for phase in PHASES])
    rows = [
        Comparison("largest overlap", deepest, 0.0, expected.overlap, "", STEP),
        Comparison("duration", time, 0.0, expected.time, "", STEP),
        Comparison("restitution", e, 0.0, 1.0, "", STEP),
        Comparison("overlap of a linear spring", flat.mean(), 0.0, math.sqrt(0.5 / 1e5), "", STEP),
    ]
    page.table(rows)
    worst = max(abs(row.percent) for row in rows)
    page.check(f"within {worst:.3f} % (0.1 %)", worst < 0.1)


def energy(page: Page) -> None:
    """D3, and 6.1: energy and time."""
    page.heading("Energy and time (D3)")
    page.text(
        "400 particles of a WCA fluid (whose force has no jump) at a density of 0.78 and T = 1: "
        "noise of the total energy over the square of the step, momentum, and how far they are "
        "from where they were when velocities are turned round for as long."
    )
    given: dict[str, Any] = {"number": 400, "kT": 1.0, "pair": WCA()}
    engine = soft([8.0] * 3, timestep=0.005, **given)
    engine.advance(400)
    state, noise, momenta = engine.state(), [], []
    for step in (0.004, 0.002, 0.001):
        engine = soft([8.0] * 3, timestep=step, **given)
        engine.restore({name: array.copy() for name, array in state.items()})
        first, seen = total(engine), []
        for _ in range(400):
            engine.advance(round(0.02 / step))
            seen.append(total(engine) - first)
        noise.append(np.std(seen))
        momenta.append(np.abs(engine.totals()[1]).max() / 400)
    before = engine.positions(unwrapped=True)
    engine.advance(100)
    engine.system.bodies.velocity[:, :3] *= -1
    engine.advance(100)
    back = np.abs(engine.positions(unwrapped=True) - before).max()
    ratios = [noise[0] / noise[1], noise[1] / noise[2]]
    steps = "0.004 over 0.002, and 0.002 over 0.001"
    page.text(f"Noise at steps of {steps}: {ratios[0]:.3f} and {ratios[1]:.3f}.")
    page.check(f"ratio {ratios[1]:.3f} (4 within 0.2)", abs(ratios[1] - 4) < 0.2)
    page.check(f"momentum of each below {max(momenta):.1e} (1e-12)", max(momenta) < 1e-12)
    page.check(f"comes back within {back:.1e} (1e-8)", back < 1e-8)
    elastic_contacts(page)


def elastic_contacts(page: Page) -> None:
    """What energy contacts without damping gain or lose."""
    law, phases = SpringDashpot(1.0, contact_time=0.01), (np.arange(400) + 0.5) / 400
    gains = np.array([collision(law, 1.0, 50, phase)[0] ** 2 - 1 for phase in phases])
    page.text(
        f"A collision of two elastic disks, 50 steps in a contact: of its energy {gains.std():.1e} "
        "comes or goes, by where in a step they touch, and as much comes as goes: on the mean "
        f"over 400 such places {gains.mean():.1e}. Two disks pressed together between plates "
        "swing for 10^6 steps, never apart: the energy of the last tenth beside that of the first."
    )
    places, velocities = [[2.0, 0.5], [2.0, 1.5]], np.array([[0.0, 0.5], [0.0, -0.7]])
    given: dict[str, Any] = {"number": 2, "pair": law, "kinds": [SphereKind(1.02)]}
    engine = soft([4.0, 2.0], [Plates("y")], places, velocities, **given)
    seen = []
    for _ in range(max(10, long(1000))):
        for _ in range(10):
            engine.advance(97)
            seen.append(total(engine))
    tenths = np.array_split(seen, 10)
    drift = abs(tenths[-1].mean() - tenths[0].mean()) / tenths[0].mean()
    page.check(f"drift over 10^6 steps: {drift:.1e} (1e-6)", drift < 1e-6)


def liquid(page: Page) -> None:
    """D4: a configuration of NIST."""
    page.heading("A configuration of NIST (D4)")
    page.text(
        "30 particles in a box of 8, cut at 3 and not shifted: configuration 4 of the NIST "
        "Standard Reference Simulation Website."
    )
    places = np.loadtxt(NIST) + 4.0
    law = LennardJones(cutoff=3.0, shift=False)
    engine = soft([8.0] * 3, (), places, number=30, pair=law)
    found = engine.energies()["contact"], float(np.trace(engine.stress["pair"])) * 512
    rounded = 5e-4 / math.sqrt(3)  # standard deviation of what the table's last digit leaves open
    note = "error of the table's last digit"
    rows = [
        Comparison("energy", found[0], rounded, -16.790, "", note),
        Comparison("virial", abs(found[1]), rounded, 46.249, "", note),
    ]
    page.table(rows)
    worst = max(abs(row.percent) for row in rows)
    page.check(f"five digits: within {worst:.4f} % (0.002 %)", worst < 0.002)


def virial(law: Any, kT: float) -> tuple[float, float]:
    """Second and third virial coefficient by quadrature."""
    kernel, end = law.kernel(), law.reach

    def mayer(r: float) -> float:
        return math.expm1(-central(kernel, r * r)[0] / kT) if 0 < r < end else -float(r == 0)

    inner = 0.85 * law.diameter
    parts = ((0.0, inner), (inner, law.diameter), (law.diameter, end))
    second = -2 * math.pi * sum(quad(lambda r: r * r * mayer(r), a, b)[0] for a, b in parts)
    r = np.arange(1, 4096) * (2.5 * end / 4096)
    f = np.array([mayer(x) for x in r])
    q = np.pi * np.arange(1, 4096) / (r[0] * 4096)
    waves = np.sin(np.outer(q, r))
    transformed = 4 * math.pi / q * (waves @ (r * f)) * r[0]
    product = transformed**2
    twice = (waves.T @ (q * product)) * (q[0] / (2 * math.pi**2)) / r
    third = -4 * math.pi / 3 * np.sum(r * r * f * twice) * r[0]
    return second, float(third)


def dilute(page: Page) -> None:
    """D6: pressure of dilute gases."""
    page.heading("Dilute gases (D6)")
    page.text(
        "800 particles in a box of 30 at T = 2, held by a weak bath of Langevin: excess pressure "
        "over the square of the density beside kT (B_2 + n B_3), by quadrature."
    )
    rows, kT, density = [], 2.0, 800 / 30**3
    for name, law in (("Lennard-Jones", LennardJones()), ("WCA", WCA())):
        engine = soft(
            [30.0] * 3,
            number=800,
            kT=kT,
            pair=law,
            timestep=0.005,
            thermostat=Langevin(kT=kT, friction=0.1),
        )
        engine.advance(4000)
        found = []
        for _ in range(max(BLOCKS, long(10_000))):
            engine.advance(25)
            found.append(-np.trace(engine.stress["pair"]) / 3)
        second, third = virial(law, kT)
        rounded = len(found) // BLOCKS * BLOCKS
        blocks = np.reshape(found[:rounded], (BLOCKS, -1)).mean(1) / density**2
        rows.append(Comparison(name, *mean_and_error(blocks), kT * (second + density * third)))
    page.table(rows)
    away = max(abs(row.deviation) for row in rows)
    page.check(f"within {away:.1f} standard errors (2.5)", away < 2.5)


def friction(page: Page) -> None:
    """D7: slopes, sliding and rolling."""
    page.heading("Friction (D7, C2, C3)")
    page.text(
        "Disks and spheres put on a slope of 40 degrees roll or slide by Coulomb's law; thrown "
        "along a floor without spin they slide until they roll. A disk that resistance to "
        "rolling holds on a slope of 20 degrees stays where springs along the surface have a "
        "memory, and creeps where there are dashpots alone."
    )
    rows = []
    for d, kappa in ((2, 0.5), (3, 0.4)):
        what = "disk" if d == 2 else "sphere"
        for mu in (0.5, 0.2):
            expected = theory.down_slope(math.radians(40), mu, 10.0, kappa)
            engine = on_floor(d, 40.0, 10.0, friction=mu)
            engine.advance(2000)
            v, t = engine.velocities()[0, 0], engine.time
            engine.advance(4000)
            slope = (engine.velocities()[0, 0] - v) / (engine.time - t)
            how = "rolls" if expected.rolls else "slides"
            rows.append(Comparison(f"{what}, mu {mu}: {how}", slope, 0.0, expected.acceleration))
        end = theory.end_of_sliding(3.0, 0.4, 10.0, kappa)
        engine = on_floor(d, 0.0, 10.0, speed=3.0, friction=0.4)
        engine.advance(round(3 * end.time / engine.timestep))
        rolled = Comparison(f"{what}: rolls in the end at", engine.velocities()[0, 0], 0, end.speed)
        engine = on_floor(d, 0.0, 10.0, speed=3.0, friction=0.4)
        while 3.0 - engine.velocities()[0, 0] < 0.999 * (3.0 - rolled.measured):
            engine.advance(1)
        rows += [rolled, Comparison(f"{what}: rolls from", engine.time, 0.0, end.time)]
    page.table([Comparison(r.what, r.measured, 0.0, r.expected, "", "exact") for r in rows])
    worst = max(abs(row.percent) for row in rows)
    page.check(f"within {worst:.2f} % (1 %)", worst < 1)
    crept = {}
    for tangential in ("history", "viscous"):
        engine = on_floor(2, 20.0, 1.0, friction=0.9, tangential=tangential, rolling=0.9)
        engine.advance(20_000)
        place = engine.positions(unwrapped=True)[0, 0]
        engine.advance(long(100_000))
        crept[tangential] = abs(engine.positions(unwrapped=True)[0, 0] - place)
    page.check(f"with a memory it creeps by {crept['history']:.1e} (1e-6)", crept["history"] < 1e-6)
    page.check(f"with none by {crept['viscous']:.2f} (more than 0.01)", crept["viscous"] > 0.01)


def on_floor(d: int, degrees: float, g: float, speed: float = 0.0, **law: Any) -> Any:
    """A sphere that rests on a floor, which is turned by an angle."""
    angle = math.radians(degrees)
    pull = [g * math.sin(angle), *[0.0] * (d - 2), -g * math.cos(angle)]
    pair = SpringDashpot(0.3, contact_time=0.005, **law)
    k, _ = pair.constants(1.0)
    place = [[1.0, *[2.0] * (d - 2), 0.5 + pull[-1] / k]]
    velocity = np.array([[speed, *[0.0] * (d - 1)]])
    size = [30.0, *[4.0] * (d - 2), 5.0]
    axis = "y" if d == 2 else "z"
    return soft(size, [Plates(axis)], place, velocity, number=1, pair=pair, gravity=pull)


def hard_limit(page: Page) -> None:
    """6.1: a gas of stiff spheres is one of hard spheres."""
    page.heading("Stiff spheres beside hard ones")
    page.text(
        "400 elastic disks at packing fractions of 0.1 and 0.3, with contact times of so many "
        "mean free times: pressure by the virial of the forces, beside the series of hard disks."
    )
    rows, measured = [], []
    for phi in (0.1, 0.3):
        free = 1 / theory.enskog_rate(4 * phi / math.pi, 1.0, 1.0, phi, 2)
        known = theory.compressibility(phi, 2)
        for share in (0.1, 0.02, 0.005):
            engine = soft(
                [math.sqrt(100 * math.pi / phi)] * 2,
                number=400,
                start=RandomStart(),
                timestep=share * free / 25,
                pair=SpringDashpot(1.0, contact_time=share * free),
            )
            time = long(400) * free
            z, dz = mean_and_error([compression(engine, time / BLOCKS) for _ in range(BLOCKS)])
            note = "approximate: hard disks" if share > 0.005 else ""
            rows.append(Comparison(f"Z at {phi}, contact time {share}", z, dz, known, "", note))
            measured.append((share, z / known - 1, dz / known))
    page.table(rows)
    worst = max(abs(row.percent) for row in rows[2::3])
    page.check(f"within {worst:.2f} % at 0.005 (2 %)", worst < 2)
    fig, ax = plt.subplots(figsize=(5, 3.6))
    for k, (phi, colour, mark) in enumerate(((0.1, BLUE, "o"), (0.3, RED, "s"))):
        x, y, error = np.array(measured[3 * k : 3 * k + 3]).T
        ax.errorbar(x, 100 * y, 100 * error, fmt=mark, color=colour, mfc="white", label=f"{phi}")
    ax.axhline(0, color="black", lw=1)
    ax.set_xscale("log")
    ax.set_xlabel("contact time over mean free time")
    ax.set_ylabel("Z off that of hard disks, %")
    ax.legend(title="packing fraction")
    page.figure(fig, "The softer the disks, the lower the pressure; the line is that of hard ones.")


def compression(engine: Any, time: float) -> float:
    """Pressure over n kT, mean over a time."""
    d, n = engine.dimension, engine.n
    volume, found = float(np.prod(engine.box)), []
    for _ in range(LOOKS):
        engine.advance(max(1, round(time / engine.timestep / LOOKS)))
        kT = 2 * engine.totals()[2] / (d * (n - 1))
        found.append(1 - float(np.trace(engine.stress["pair"])) / d * volume / (n * kT))
    return float(np.mean(found))


def make() -> int:
    """The page; how many requirements were not met."""
    page = Page("soft_spheres", "Soft disks and spheres", UNITS)
    for part in (spring_and_dashpot, hertz, energy, liquid, dilute, friction, hard_limit):
        part(page)
    page.heading("The same forces as another program (D8)")
    page.text(
        "`python benchmarks/lammps_contacts.py` puts the forces and torques of 1,000 grains with "
        "friction that remembers beside those of LAMMPS: benchmark.md has the figures."
    )
    return page.write()


if __name__ == "__main__":
    main(make)
