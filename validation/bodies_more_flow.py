"""Bodies in a flow, what the other page left open: lattices, weak forces, 3D shear, long swimmers.

Usage: python validation/bodies_more_flow.py [parts...] [--short]

Parts are those of `PARTS`, all unless said.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from bodies_in_flow import by_images, by_slip, noisy_turning
from common import SHORT, Page, found, main, renamed
from moving_bodies import (
    DENSITY,
    PREFACE,
    SLIP,
    STEP,
    VISCOSITIES,
    WARMUP,
    case_of,
    fluid,
    gap_energy,
    kept,
    mean_of_parts,
    met,
    ran,
    recorded,
    steps,
    viscosity,
)
from rigid_in_stokes import settling_speed

from mesokit import (
    BodyDrift,
    BodyStart,
    Box,
    Case,
    Comparison,
    DiskBody,
    EllipseBody,
    Fluid,
    Run,
    Simulation,
    SphereBody,
    SpheroidBody,
    Squirming,
    SRDPlusA,
    Stress,
    theory,
)

ETA, B = viscosity("at+a", 3), SLIP["at+a", 3]
GRID = 8  # points of the grid of creeping flow in a radius


def wide_mobility(radius: float) -> float:
    """Mobility of a sphere in a wide fluid, AT+a, with slip."""
    return (1 + B / (radius + 2 * B)) / (6 * math.pi * ETA * radius)


# ---------------------------------------------------------------- settling


def lattices(page: Page) -> None:
    """Spheres on a lattice that have not left it yet."""
    page.heading("Settling of a lattice")
    page.text(
        "Eight spheres of R = 2 on a simple cubic lattice in a cube, each drawn by the same force "
        "with counter-force, AT+a: mean speed between 5 and 30 time units after the start, over "
        "many starts of the fluid, before they have gone far from their places. Theory is the "
        "friction of Sangani and Acrivos in the cube of one sphere, with slip. A lattice settles "
        "at half the speed of hard spheres at random, so places matter more than all else. A "
        "lattice that loosens becomes faster. So the speed stands also beside that of the creeping "
        "flow about the spheres where they are in the run (`rigid_in_stokes.py`), as below. "
        "At the larger fraction that explains a third of what it is too fast by."
    )
    rows, radius, force, number = [], 2.0, 20.0, 8
    starts, first, last = (4 if SHORT else 120), 50, 300
    for side in (12, 16):
        body = SphereBody(
            radius=radius, number=number, force=(force, 0.0, 0.0), counter_force=True,
            start=BodyStart("lattice"),
        )  # fmt: skip
        case = case_of(body, side, "at+a", last)

        def all_places(case: Case = case) -> np.ndarray:
            found = []
            for seed in range(starts):
                run = Run(steps=last, warmup=0, seed=seed)
                engine, seen = Simulation(replace(case, run=run), threads=1).engine, []
                for _ in range(first, last + 1, first):
                    engine.advance(first)
                    seen.append(engine.bodies.places(unwrapped=True))
                found.append(seen)
            return np.array(found)

        frames = kept(
            page, f"lattice-{side}", f"places {starts} {first} {case.to_toml()}", all_places
        )
        moved = frames[:, -1] - frames[:, 0]
        values = moved[:, :, 0].mean(axis=1) / ((last - first) * STEP)
        spread = moved.std(axis=1).max(axis=1).mean()
        unit = force * wide_mobility(radius)
        phi = number * 4 / 3 * math.pi * radius**3 / side**3
        known = 1 / theory.sphere_friction_in_cube(radius, side / 2, ETA, B) / wide_mobility(radius)
        rows.append(Comparison(
            f"phi = {phi:.3f}: V/V0", values.mean() / unit,
            values.std(ddof=1) / math.sqrt(starts) / unit, float(known), "",
            f"{starts} starts; spread at the end {spread:.2f} cells",
        ))  # fmt: skip
        met(page, f"lattice, {rows[-1].what}", rows[-1], 5)
        c, loosened = rows[-1], frames.reshape(-1, number, 3)
        value, error = speed_among(page, f"flow-lattice-{side}", loosened, side, radius)
        rows.append(Comparison(
            f"phi = {phi:.3f}: V/V0; theory: places in the run", c.measured,
            math.hypot(c.error, error), value,
        ))  # fmt: skip
        met(page, f"lattice, {rows[-1].what}", rows[-1], 5)
    page.table(rows)


def large_spheres(page: Page) -> None:
    """Hindered settling of larger spheres, whose gap law is short beside them."""
    page.heading("Hindered settling of larger spheres")
    gaps = np.linspace(1e-3, 0.5, 500)
    apart = float((1 - np.exp(-gap_energy(gaps))).mean() * 0.5)
    page.text(
        "18 spheres at phi = 0.147 as on the page of bodies in flow, with R = 2 and with R = 4 in "
        f"a cube twice as long. The gap law keeps surfaces {apart:.2f} cells apart at least, so "
        "that the spheres act as if 38 % and 18 % larger. Theory is (1 - phi)^5 of hard spheres; "
        "the note has the same law with the volume that the gap law keeps. Larger spheres are "
        "little nearer to the law of hard spheres, and 9 % below that with the gap law."
    )
    rows, drifts, number, force = [], [], 18, 20.0
    for radius, length in ((2.0, 7e3), (4.0, 2.8e4)):
        side, swollen = 8 * int(radius), (1 + apart / (2 * radius)) ** 3
        body = SphereBody(radius=radius, number=number, force=(force, 0.0, 0.0), counter_force=True)
        files, note = ran(page, f"settling-{radius:g}",
                          case_of(body, side, "at+a", length, BodyDrift()))  # fmt: skip
        c = found(files["body-drift"], "mobility along x")
        drifts.append(c)
        phi = number * 4 / 3 * math.pi * radius**3 / side**3
        x = phi * (1 + phi - 0.189 * phi**2)
        few = theory.settling_of_few(swollen * phi, number, viscosity=(1 + 1.5 * x) / (1 - x))
        few /= swollen ** (1 / 3)
        free = wide_mobility(radius)
        rows.append(Comparison(
            f"R = {radius:g}: V/V0", c.measured / free + few, c.error / free,
            theory.hindered_settling(phi, 5.0), "",
            f"Re {c.measured * force * radius / VISCOSITIES['at+a', 3][0]:.2f}; "
            f"{c.measured / free:.3f} in this box; {(1 - swollen * phi) ** 5:.3f} with the gap "
            f"law; {note}",
        ))  # fmt: skip
        met(page, f"settling, {rows[-1].what}", rows[-1], 5)
    page.table(rows)
    page.text(
        "Why: where spheres are decides. The speed of the creeping flow about rigid spheres at "
        "given places (`rigid_in_stokes.py`, all orders) is that of the run for the places in the "
        "run: no part of the lag is left. Slip is in it, as a smaller radius. For hard spheres at "
        "random (by Monte Carlo) it lies between that of the law (1 - phi)^5, less what 18 spheres "
        "lack, and (1 - phi)^6.5. So the exponent of 5 is not that of spheres at rest at random, "
        "and spheres that the gap law keeps apart settle still more slowly. Speeds of Rotne and "
        "Prager, a law of far spheres, are those of (1 - phi)^5 by chance: they lie 10 to 15 % "
        "above those of creeping flow. Theirs is the sum over waves of (1 - k_x^2/k^2) "
        "(sin kR/kR)^2/(eta L^3 k^2) times S(k) of the spheres."
    )
    radius, side = 2.0, 16
    rows = []
    phi = number * 4 / 3 * math.pi * radius**3 / side**3
    lack = theory.settling_of_few(phi, number, viscosity=(1 + 1.5 * x) / (1 - x))
    law = theory.hindered_settling(phi, 5.0) - lack
    for name, gap in (("hard spheres at random", 0.0), ("kept apart", apart)):
        frames = kept(page, f"random-{gap:.2f}", f"{number} {side} {radius} {gap}",
                      lambda gap=gap: at_random(number, side, 2 * radius + gap))  # fmt: skip
        value, error = mean_of_parts(speed_of_places(frames, side, radius))
        what = f"Rotne and Prager, {name}: V/V0"
        rows.append(Comparison(what, value, error, math.nan if gap else law))
        value, error = speed_among(page, f"flow-random-{gap:.2f}", frames, side, radius)
        steep = theory.hindered_settling(phi, 6.5) - lack
        rows.append(Comparison(f"creeping flow, {name}: V/V0", value, error,
                               math.nan if gap else law, "",
                               "" if gap else f"(1 - phi)^6.5 less the lack: {steep:.3f}")
                    )  # fmt: skip
    met(page, f"settling, {rows[0].what}", rows[0], 5)
    for radius, length, c in ((2.0, 7e3, drifts[0]), (4.0, 2.8e4, drifts[1])):
        side = 8 * int(radius)
        body = SphereBody(radius=radius, number=number, force=(force, 0.0, 0.0), counter_force=True)
        run = recorded(page, f"places-{radius:g}", case_of(body, side, "at+a", length), 50,
                       lambda engine: engine.bodies.places(unwrapped=False))  # fmt: skip
        value, error = speed_among(page, f"flow-places-{radius:g}", run, side, radius)
        far, _ = mean_of_parts(speed_of_places(run, side, radius))
        rows.append(Comparison(
            f"measured, R = {radius:g}; theory: creeping flow, places in the run: V/V0",
            c.measured / wide_mobility(radius),
            math.hypot(c.error / wide_mobility(radius), error), value, "",
            f"Rotne and Prager {far:.3f}",
        ))  # fmt: skip
        met(page, f"settling, R = {radius:g}: V/V0 over that of the places in the run", rows[-1],
            10)  # fmt: skip
    page.table(rows)


def at_random(number: int, side: float, apart: float) -> np.ndarray:
    """Places of spheres whose centres stay so far apart, by Monte Carlo (frames, number, 3)."""
    random, frames = np.random.default_rng(5), []
    along = math.ceil(number ** (1 / 3))
    places = np.indices((along,) * 3).reshape(3, -1).T[:number] * (side / along)
    for sweep in range(2200):
        for i in random.integers(0, number, number):
            new = places[i] + random.uniform(-1, 1, 3)
            away = places - new
            away -= side * np.rint(away / side)
            square = (away**2).sum(axis=1)
            square[i] = math.inf
            if square.min() >= apart**2:
                places[i] = new % side
        if sweep >= 200 and sweep % 5 == 0:
            frames.append(places.copy())
    return np.array(frames)


def speed_of_places(frames: np.ndarray, side: float, radius: float) -> np.ndarray:
    """Settling speed along x over that of one sphere in a wide fluid, of each frame.

    The sum for one sphere is Hasimoto's factor; the rest has S(k) - 1, which makes it short.
    """
    n = np.arange(-9, 10)
    k = 2 * math.pi / side * np.stack(np.meshgrid(n, n, n), -1).reshape(-1, 3)
    k = k[k.any(axis=1)]
    square = (k**2).sum(axis=1)
    weight = (1 - k[:, 0] ** 2 / square) / square
    weight *= np.sinc(np.sqrt(square) * radius / math.pi) ** 2 * 6 * math.pi * radius / side**3
    y = 4 / 3 * math.pi * radius**3 / side**3
    alone = 1 - 1.7601 * y ** (1 / 3) + y - 1.5593 * y**2
    between = [
        weight @ (abs(np.exp(1j * places @ k.T).sum(axis=0)) ** 2 / len(places) - 1)
        for places in frames
    ]
    return alone + np.array(between)


def speed_among(
    page: Page, name: str, frames: np.ndarray, side: float, radius: float, looks: int = 20
) -> tuple[float, float]:
    """Settling speed of creeping flow about spheres at places, over that of one in a wide fluid.

    It is that of Rotne and Prager in all frames, and what some of them lack or have too much. Slip
    makes spheres smaller, by as much as it makes one settle faster. The grid makes all slower, by
    as much as a lattice of the same fraction.
    """
    smaller = 1 / (6 * math.pi * ETA * wide_mobility(radius))
    points = int(side / radius) * GRID
    some = frames[np.linspace(0, len(frames) - 1, 2 if SHORT else looks).astype(int)]
    flows = kept(page, name, f"{smaller} {side} {points} {some.sum()!r}", lambda: np.array(
        [settling_speed(places, smaller, side, points) for places in some]
    ))  # fmt: skip
    flows = flows * grid_factor(len(some[0]) / side**3, radius, smaller)
    more = flows - speed_of_places(some, side, smaller)
    value, error = mean_of_parts(speed_of_places(frames, side, smaller))
    return value + float(more.mean()), math.hypot(error, more.std(ddof=1) / math.sqrt(len(more)))


def grid_factor(density: float, radius: float, smaller: float) -> float:
    """Speed of a cubic lattice of spheres by Sangani and Acrivos over that on the grid."""
    step = radius / GRID
    points = round(density ** (-1 / 3) / step)
    side = points * step
    known = 6 * math.pi * smaller / theory.sphere_friction_in_cube(smaller, side, 1.0)
    return float(known) / settling_speed(np.full((1, 3), side / 2), smaller, side, points)


# ---------------------------------------------------------------- weak forces


def weak(page: Page) -> None:
    """A spheroid drawn by a weak force."""
    page.heading("A spheroid under a weaker force")
    page.text(
        "The spheroid 8 x 4 of the page of bodies in flow, where it was 11 % too slow across its "
        "axis at a Reynolds number of its half length of 1: here with a third of the force. Theory "
        "as there."
    )
    side, axes, force = 18, [4.0, 2.0, 2.0], 25.0 / 3
    body = SpheroidBody(
        half_length=4.0, radius=2.0, start=BodyStart("given", positions=[(side / 2,) * 3]),
        counter_force=True, force=(force,) * 3, fixed=("orientation",),
    )  # fmt: skip
    files, note = ran(page, "weak", case_of(body, side, "at+a", 1.2e5, BodyDrift()))
    friction = theory.ellipsoid_friction(axes, ETA)
    x, y, z = (found(files["body-drift"], f"mobility along {axis}") for axis in "xyz")
    rows = []
    for way, k, value, error in (
        ("along", 0, x.measured, x.error),
        ("across", 1, 0.5 * (y.measured + z.measured), 0.5 * math.hypot(y.error, z.error)),
    ):
        known = 1 / friction.translation[k] + by_images(axes, k, side, ETA)
        known += by_slip(axes, k, B, ETA)
        rows.append(Comparison(f"spheroid 8 x 4, {way}: mobility", value, error, float(known),
                               x.unit, note))  # fmt: skip
        met(page, rows[-1].what, rows[-1], 5)
    page.table(rows)


# ---------------------------------------------------------------- shear


def turning(page: Page) -> None:
    """Turning in a shear flow."""
    page.heading("Turning in shear")
    page.text(
        "Lees-Edwards shear, AT+a, longer than on the page of bodies in flow. A disk and a sphere "
        "turn at half the rate. A spheroid turns about a hinge along the vorticity, so that its "
        "axis stays in the shear plane. Theory there is the mean of Jeffery's angular velocity "
        "over the steady distribution of angles, with D_r end over end of a wide fluid; without "
        "noise it is rate/(r + 1/r)."
    )
    rows = []
    half, wide = 3.0, 1.5
    spheroid = SpheroidBody(half_length=half, radius=wide, hinge=(0.0, 0.0, 1.0))
    D_r = 1 / theory.ellipsoid_friction([half, wide, wide], ETA).rotation[1]
    for name, body, side, length, rate in (
        ("disk R = 2", DiskBody(radius=2), 20, 1e6, 0.04),
        ("sphere R = 2", SphereBody(radius=2), 12, 2.5e5, 0.04),
        ("spheroid 6 x 3, 3D", spheroid, 14, 1e5, 0.04),
    ):
        d = body.dimensions[0]
        case = case_of(body, side, "at+a", length, BodyDrift(), shear_rate=rate)
        files, note = ran(page, f"turning-{d}-{side}", case)
        c = found(files["body-drift"], "angular velocity about z")
        known, reach = rate / 2, 2.0
        if isinstance(body, SpheroidBody):
            known, reach = noisy_turning(half / wide, D_r, rate), half
            note = f"without noise {rate / (half / wide + wide / half):.4f}; {note}"
        reynolds = rate * reach**2 / VISCOSITIES["at+a", d][0]
        rows.append(Comparison(f"{name}: angular velocity", abs(c.measured), c.error, known,
                               "1/tau", f"rate {rate:g}, Re {reynolds:.2f}; {note}"))  # fmt: skip
        met(page, rows[-1].what, rows[-1], 5)
    page.table(rows)


def einstein(page: Page) -> None:
    """Viscosity of a suspension of spheres."""
    page.heading("Einstein viscosity in 3D")
    rate, side, radius, number = 0.04, 16, 2.0, 6
    phi = number * 4 / 3 * math.pi * radius**3 / side**3
    page.text(
        f"Viscosity by `stress` of {number} spheres of R = 2 in a cube of side {side}, phi = "
        f"{phi:.3f}, AT+a, over that of the same cube without them, at the rate {rate:g}. Theory "
        "is 1 + 2.5 phi (1 + 2 b/R)/(1 + 5 b/R), to first order. Batchelor's 6.2 phi^2 of Brownian "
        f"spheres would add {6.2 * phi:.2f} to the gain over phi; these are kept apart, and "
        "Peclet's number is 0.04 R^2/D = 43."
    )
    length, rows = 1e5, []
    empty = Case(
        run=Run(steps=steps(length), warmup=WARMUP[3], seed=11), observe=[Stress()],
        box=Box([side] * 3, shear_rate=rate), fluid=fluid("at+a"),
    )  # fmt: skip
    body = SphereBody(radius=radius, number=number)
    full = case_of(body, side, "at+a", length, Stress(), shear_rate=rate)
    (files, note), (others, _) = ran(page, "einstein-0", empty), ran(page, "einstein-6", full)
    alone, c = found(files["stress"], "viscosity"), found(others["stress"], "viscosity")
    rows.append(renamed(alone, "without bodies: viscosity", note))
    ratio = c.measured / alone.measured
    error = ratio * math.hypot(c.error / c.measured, alone.error / alone.measured)
    known = theory.suspension_viscosity(phi, 3, slip=B / radius)
    rows.append(Comparison("eta/eta0", ratio, error, known, "", note))
    rows.append(Comparison("(eta/eta0 - 1)/phi", (ratio - 1) / phi, error / phi,
                           (known - 1) / phi, "", note))  # fmt: skip
    met(page, f"3D: {rows[-1].what}", rows[-1], 10)
    page.table(rows)


# ---------------------------------------------------------------- work of the border


def border(page: Page) -> None:
    """The work of the Lees-Edwards border beside that of the stress."""
    page.heading("The force at the border")
    starts = 4 if SHORT else 100
    page.text(
        "All work on a sheared box is done at its border: the force there times the speed at which "
        'images slide. Without thermostat and virtual particles (`virtual = "none"`) it stays '
        "in the box, so that the energy that fluid and bodies gain gives the force at the border "
        "without `stress`. The table has the energy over rate, stress, volume and time, SRD+a, "
        f"{starts} starts; the error bars are from the scatter of starts. The gain of the "
        "viscosity by that force stands below: without virtual particles surfaces slip, and the "
        "slip length is not known well enough for a theory of it. The note has the gain by "
        "`stress`."
    )
    rows: list[Comparison] = []
    for d, side, rate, body in (
        (2, 24, 0.05, DiskBody(radius=3, number=2, virtual="none")),
        (3, 16, 0.1, SphereBody(radius=3, number=2, virtual="none")),
    ):
        force, stress = [], []
        for bodies in ((), (body,)):
            case = Case(
                run=Run(steps=1000, warmup=0), box=Box([side] * d, shear_rate=rate), bodies=bodies,
                fluid=Fluid(density=DENSITY, timestep=STEP, collision=SRDPlusA(angle=90)),
                observe=[Stress()],
            )  # fmt: skip
            values = kept(page, f"border-{d}-{len(bodies)}", f"{starts} {case.to_toml()}",
                          lambda case=case: viscosities(case, starts))  # fmt: skip
            label = f"{d}D, {'with' if bodies else 'without'} bodies"
            ratio, error = mean_of_parts(values[:, 0] / values[:, 1], starts)
            rows.append(Comparison(f"{label}: work of the border over that of the stress",
                                   ratio, error, 1.0))  # fmt: skip
            met(page, rows[-1].what, rows[-1], 3)
            force.append(mean_of_parts(values[:, 0], starts))
            stress.append(float(values[:, 1].mean()))
        phi = 2 * body.solid(d).volume / side**d
        (alone, doubt), (both, unsure) = force
        rows.append(Comparison(
            f"{d}D, phi = {phi:.3f}: (eta/eta0 - 1)/phi by the force at the border",
            (both / alone - 1) / phi, both / alone * math.hypot(doubt / alone, unsure / both) / phi,
            note=f"{(stress[1] / stress[0] - 1) / phi:.2f} by stress; without slip {(d + 2) / 2:g}",
        ))  # fmt: skip
    page.table(rows)


def viscosities(case: Case, starts: int) -> np.ndarray:
    """Viscosities by the energy that fluid and bodies gain and by `stress`, of many starts."""
    box, values = case.box, []
    work = box.shear_rate**2 * math.prod(box.size) * case.run.steps * STEP * DENSITY
    for seed in range(starts):
        simulation = Simulation(replace(case, run=replace(case.run, seed=seed)), threads=1)
        _, _, before = simulation.engine.totals()
        simulation.run()
        _, _, after = simulation.engine.totals()
        by_stress = found(simulation.results["stress"], "viscosity from the stress").measured
        values.append([(after - before) / work, by_stress])
    return np.array(values)


# ---------------------------------------------------------------- swimmers


def squirmers(page: Page) -> None:
    """Speeds of an ellipse and of a spheroid that swim."""
    page.heading("Long swimmers")
    first = 0.15
    page.text(
        f"Neutral squirmers (B1 = {first:g}) with half axes of 4 and 2, AT+a: an ellipse in a "
        "square of side 30, a spheroid in a cube of side 18. Theory is B1 r/(1 + r) and that of "
        "Keller and Wu, times 1 - phi, with the first order of the slip length that rotation of "
        "balls gives (`slipping`)."
    )
    rows = []
    for name, body, side, length in (
        ("ellipse 8 x 4", EllipseBody(size=(8, 4), swim=Squirming(B1=first)), 30, 3e5),
        ("spheroid 8 x 4",
         SpheroidBody(half_length=4, radius=2, swim=Squirming(B1=first)), 18, 3e4),
    ):  # fmt: skip
        d = body.dimensions[0]
        files, note = ran(page, f"squirmer-{d}", case_of(body, side, "at+a", length, BodyDrift()))
        c = found(files["body-drift"], "velocity along its own axis")
        wide = theory.squirmer_speed(first, d, 2.0)
        slower = slipping(4.0, 2.0, SLIP["at+a", d], d)
        known = wide * (1 - body.solid(d).volume / side**d) * slower
        rows.append(renamed(c, f"{name}: swimming speed",
                            f"slip takes {100 * (1 - slower):.1f} %; {note}", known))  # fmt: skip
        met(page, rows[-1].what, rows[-1], 5)
    page.table(rows)


def slipping(half: float, wide: float, slip: float, d: int) -> float:
    """What a slip length leaves of the speed of a neutral squirmer, to first order.

    The flow about an ellipsoid that squirms as e.t along its tangent t has no vorticity, so that
    its shear at the surface is twice the curvature of the meridian times that velocity. The speed
    is minus the mean of the surface velocity with the weight n.x (Lorentz' reciprocal theorem).
    """
    angle = (np.arange(2000) + 0.5) * math.pi / 2000
    s2 = (half * np.sin(angle)) ** 2 + (wide * np.cos(angle)) ** 2
    weight = np.sin(angle) ** (d - 2)
    along = (half * np.sin(angle)) ** 2 / s2 * weight
    curvature = half * wide / s2**1.5
    return float(1 - 2 * slip * (along * curvature).sum() / along.sum())


PARTS: dict[str, Callable[[Page], None]] = {
    "lattices": lattices, "large_spheres": large_spheres, "weak": weak, "turning": turning,
    "einstein": einstein, "border": border, "squirmers": squirmers,
}  # fmt: skip


def make(parts: Sequence[str] = tuple(PARTS)) -> int:
    """Write the page, of all parts or those named."""
    page = Page("bodies_more_flow", "Bodies in a flow: lattices, weak forces, 3D")
    page.text(PREFACE)
    page.text(
        "It goes on where [bodies in flow](bodies_in_flow.md) left off. What is open here: [in a "
        "slow flow](bodies_slow_flow.md)."
    )
    for name in parts:
        PARTS[name](page)
    return page.write()


if __name__ == "__main__":
    main(lambda: make([name for name in PARTS if name in sys.argv[1:]] or tuple(PARTS)))
