"""Bodies in a slow flow: small Reynolds numbers, little noise, inertia of squirmers.

Usage: python validation/bodies_slow_flow.py [parts...] [--short]

Parts are those of `PARTS`, all unless said.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from bodies_in_flow import noisy_turning
from bodies_more_flow import at_random, slipping, speed_among, speed_of_places, wide_mobility
from common import SHORT, Page, found, main, renamed
from moving_bodies import (
    DENSITY,
    PREFACE,
    SLIP,
    STEP,
    VISCOSITIES,
    WARMUP,
    case_of,
    coefficients,
    fluid,
    kept,
    mean_of_parts,
    met,
    ran,
    recorded,
    steps,
    viscosity,
)
from rigid_in_stokes import viscosity_gain
from scipy.special import jv

from mesokit import (
    BodyDisplacement,
    BodyDrift,
    BodyStart,
    Box,
    Case,
    Comparison,
    CounterForce,
    DiskBody,
    EllipseBody,
    Plates,
    Run,
    Sinusoidal,
    SphereBody,
    SpheroidBody,
    Squirming,
    Stress,
    theory,
)

RULE, FINE = "at+a", 0.02  # the timestep of the parts of small Reynolds numbers
# At the fine timestep, by dimension: kinematic viscosity and slip length, as `rotation` finds them.
NU: dict[int, float] = {}
SLIPS: dict[int, float] = {}


# ---------------------------------------------------------------- a viscous fluid


def rotation(page: Page) -> None:
    """Viscosities and slip lengths at the fine timestep."""
    page.heading("A viscous fluid")
    page.text(
        f"The timestep {FINE:g} makes the viscosity four times that of the other pages: bodies can "
        "go and turn as fast at a quarter of the Reynolds number, with less noise. The viscosity "
        "is measured by `stress` in Lees-Edwards shear (rate 0.1, side 12 and 32). It is 4 to 5 % "
        "below that of molecular chaos, as with [all rules](viscosity_rules.md) where flights are "
        "so short. R = 3 under a torque, as on the page of bodies in flow, gives the slip length. "
        "Both stand in theory below."
    )
    rows = []
    for d, wide, length, torque in ((2, 32, 1.5e5, 160.0), (3, 12, 1.5e4, 900.0)):
        sheared = Case(
            run=Run(steps=steps(1e5), warmup=1000, seed=5), observe=[Stress(every=1)],
            box=Box([wide] * d, shear_rate=0.1), fluid=fluid(RULE, FINE),
        )  # fmt: skip
        files, note = ran(page, f"viscosity-{d}", sheared)
        c = found(files["stress"], "viscosity")
        NU[d] = c.measured
        rows.append(Comparison(f"{d}D: viscosity; theory: molecular chaos", c.measured, c.error,
                               float(coefficients(RULE, d, FINE).viscosity), "a^2/tau", note)
                    )  # fmt: skip
        body = DiskBody(radius=3, torque=torque) if d == 2 else SphereBody(
            radius=3, torque=(0.0, 0.0, torque)
        )  # fmt: skip
        side = 24 if d == 2 else 16
        case = case_of(body, side, RULE, length, BodyDrift(), timestep=FINE)
        files, note = ran(page, f"rotation-{d}", case)
        c = found(files["body-drift"], "rotational mobility")
        unit = (4 if d == 2 else 8) * math.pi * DENSITY * NU[d] * 3.0**d
        left = 1 - body.solid(d).volume / side**d
        SLIPS[d] = 3 / d * (unit * c.measured - left)
        rows.append(renamed(c, f"{d}D: rotational mobility; theory: without slip", note,
                            left / unit))  # fmt: skip
        rows.append(Comparison(f"{d}D: slip length b", SLIPS[d], 3 / d * unit * c.error,
                               SLIP[RULE, d], "a", "theory: at the timestep 0.1"))  # fmt: skip
    page.table(rows)


def turning(page: Page) -> None:
    """Turning and Jeffery periods in shear."""
    page.heading("Turning in shear")
    page.text(
        "Lees-Edwards shear, AT+a. A disk and a sphere turn at half the rate. Long bodies: theory "
        "is the mean of Jeffery's angular velocity over the steady distribution of angles, with "
        "D_r of a wide fluid. The spheroid turns about a hinge along the vorticity, so that its "
        "axis stays in the shear plane. Re is rate R^2/nu, with the half length of a long body. "
        "The period is that of a whole turn."
    )
    rows = []
    spheroid = SpheroidBody(half_length=3.0, radius=1.5, hinge=(0.0, 0.0, 1.0))
    eta = {d: DENSITY * NU[d] for d in (2, 3)}
    for name, body, aspect, half, side, length, rate in (
        ("disk R = 2", DiskBody(radius=2), 1.0, 2.0, 20, 2e6, 0.025),
        ("sphere R = 2", SphereBody(radius=2), 1.0, 2.0, 12, 4e5, 0.02),
        ("ellipse 8 x 4", EllipseBody(size=(8, 4)), 2.0, 4.0, 28, 1e6, 0.03),
        ("ellipse 9 x 3", EllipseBody(size=(9, 3)), 3.0, 4.5, 30, 1e6, 0.03),
        ("spheroid 6 x 3, 3D", spheroid, 2.0, 3.0, 14, 3e5, 0.03),
    ):
        d = body.dimensions[0]
        case = case_of(body, side, RULE, length, BodyDrift(), shear_rate=rate, timestep=FINE)
        files, note = ran(page, f"turning-{name}".replace(" ", "").replace(",", ""), case)
        c = found(files["body-drift"], "angular velocity about z")
        known = plain = rate / (aspect + 1 / aspect)
        if aspect > 1:
            wide = half / aspect
            spread = (
                1 / (2 * math.pi * eta[2] * (half**2 + wide**2))
                if d == 2
                else float(1 / theory.ellipsoid_friction([half, wide, wide], eta[3]).rotation[1])
            )
            known = noisy_turning(aspect, spread, rate)
            note = f"without noise {plain:.5f}; rate/D_r {rate / spread:.0f}; {note}"
        rows.append(Comparison(f"{name}: angular velocity", abs(c.measured), c.error, known,
                               "1/tau", f"rate {rate:g}, Re {rate * half**2 / NU[d]:.3f}; {note}")
                    )  # fmt: skip
        met(page, rows[-1].what, rows[-1], 2 if aspect == 1 else 5)
        if aspect > 1:
            period = 2 * math.pi / rows[-1].measured
            rows.append(Comparison(f"{name}: period", period, period * c.error / abs(c.measured),
                                   2 * math.pi / known, "tau",
                                   f"Jeffery {theory.jeffery_period(aspect, rate):.0f}")
                        )  # fmt: skip
    page.table(rows)


def slit(page: Page) -> None:
    """A sphere drawn along the middle of a slit."""
    page.heading("Between plates")
    b, eta = SLIPS[3], DENSITY * NU[3]
    page.text(
        "A sphere drawn along the middle of a slit of half width h, kept there (z fixed), AT+a, "
        "the viscous fluid; the plates take the force. Theory is Faxen's mobility with the "
        "periodic part, without slip; the row below adds slip as on the page of bodies in flow. "
        "The periodic part holds where the box is wider than the slit: a side of 16 with h = 10 "
        "gave 10 % more than it."
    )
    rows = []
    for radius, wide, side in ((2.0, 20, 28), (2.8, 16, 24)):
        force = 60.0
        body = SphereBody(
            radius=radius, force=(force, 0.0, 0.0), fixed=("z",),
            start=BodyStart("given", positions=[(side / 2, side / 2, wide / 2)]),
        )  # fmt: skip
        case = case_of(body, side, RULE, 6e4, BodyDrift(), size=[side, side, wide],
                       walls=[Plates(axis="z")], timestep=FINE)  # fmt: skip
        case = replace(case, run=replace(case.run, warmup=3000))  # the flow of a slit builds up
        files, note = ran(page, f"slit-{radius:g}", case)
        c = found(files["body-drift"], "mobility along x")
        unit = 6 * math.pi * eta * radius
        known = theory.slit_mobility(radius, wide / 2, side**2)
        slipping_too = theory.slit_mobility(radius, wide / 2 + b, side**2) + b / (radius + 2 * b)
        what = f"R/h = {2 * radius / wide:.2f}: mobility over that of Stokes"
        note = f"Re {c.measured * force * radius / NU[3]:.2f}; {note}"
        rows.append(Comparison(what, c.measured * unit, c.error * unit, known, "", note))
        rows.append(renamed(rows[-1], f"{what}, theory with slip", note, slipping_too))
        met(page, rows[-1].what, rows[-1], 5)
    page.table(rows)


def disk(page: Page) -> None:
    """Drag of a disk."""
    page.heading("Drag of a disk")
    radius, side, force, eta = 3.0, 30, 6.0, DENSITY * NU[2]
    page.text(
        f"R = 3 in a square of side {side}, drawn by a force with counter-force, AT+a, the viscous "
        "fluid. Theory is that of Sangani and Acrivos, with the slip length above."
    )
    body = DiskBody(radius=radius, force=(force, 0.0), counter_force=True)
    case = case_of(body, side, RULE, 1e6, BodyDrift(), timestep=FINE)
    files, note = ran(page, "disk", case)
    c = found(files["body-drift"], "mobility along x")
    known = 1 / theory.disk_friction_in_square(radius, side, eta, max(SLIPS[2], 0.0))
    note = f"Re {c.measured * force * radius / NU[2]:.2f}; {note}"
    row = renamed(c, "2D: mobility", note, float(known))
    met(page, f"disk: {row.what}", row, 5)
    page.table([row])


# ---------------------------------------------------------------- a driven wave


def wave(page: Page) -> None:
    """Viscosity of a suspension of disks from the flow that a sinusoidal force drives."""
    page.heading("Einstein viscosity by a driven wave")
    side, radius, length, often = 30, 2.0, 5e5, 20
    page.text(
        "A force that is a sine across the flow acts on 2D AT+a and on disks of R = 2, in a square "
        "of side 30. The viscosity is the force over the amplitude of the flow, by volume of fluid "
        "and disks. The table has its ratio to the same without disks. It does not ask for "
        "`stress`. Theory is the creeping flow about hard "
        "disks at random in this box (`rigid_in_stokes.py`, all orders of phi), times (1 + 2 "
        "b/R)/(1 + 4 b/R) for slip; the gap law, which keeps disks apart, lowers it by 1 %. The "
        "note has the first order, 2, with slip: it is too low, as "
        "no suspension of rigid disks without slip has less than (1 + phi)/(1 - phi) (Hashin "
        "1965). Shear on the page of bodies in flow gave 2.01(17) and 2.17(8), as this theory "
        "does. The length of the wave changes it by less than 1 %, by the exact flow about one "
        "disk. The viscous fluid has a fourth of the Reynolds number, of the largest shear and R."
    )
    k = 2 * math.pi / side
    reach = k * radius
    even, odd = 2 * jv(1, reach) / reach, 2 * radius * jv(2, reach) / reach  # over a disk

    def amplitude(engine: Any) -> float:
        x, v = engine.positions(), engine.velocities()
        total = float(v[:, 0] @ np.sin(k * x[:, 1]))
        if engine.bodies:
            y, speed = engine.bodies.places(unwrapped=False)[:, 1], engine.bodies.velocities[:, 0]
            spin = engine.bodies.spins[:, 2]
            of_disks = even * speed * np.sin(k * y) - odd * spin * np.cos(k * y)
            total += DENSITY * math.pi * radius**2 * float(of_disks.sum())
        return 2 * total / (DENSITY * side**2)

    rows, alone, over, weights = [], (1.0, 0.0), list[tuple[float, float]](), list[float]()
    for timestep, most, slip in ((STEP, 0.004, SLIP[RULE, 2]), (FINE, 0.016, SLIPS[2])):
        for number in (0, 3, 6):
            case = Case(
                run=Run(steps=steps(length), warmup=4 * WARMUP[2], seed=11), box=Box([side, side]),
                fluid=replace(fluid(RULE, timestep), force=Sinusoidal(amplitude=most)), observe=[],
                bodies=(DiskBody(radius=radius, number=number),) if number else (),
            )  # fmt: skip
            seen = recorded(page, f"wave-{timestep:g}-{number}", case, often, amplitude)
            value, error = mean_of_parts(seen, 16)
            nu, note = most / (k * k * value), f"{case.run.steps} steps"
            if not number:
                alone = value, error
                rows.append(Comparison(
                    f"timestep {timestep:g}, without disks: viscosity", nu, nu * error / value,
                    float(coefficients(RULE, 2, timestep).viscosity), "a^2/tau",
                    f"theory: molecular chaos; Re {value * k * radius**2 / nu:.2f}; {note}",
                ))  # fmt: skip
                continue
            phi = number * math.pi * radius**2 / side**2
            ratio = alone[0] / value
            unsure = ratio * math.hypot(error / value, alone[1] / alone[0])
            first = (theory.suspension_viscosity(phi, 2, slip=slip / radius) - 1) / phi
            known, doubt = gain_at_random(page, number, radius, side)
            rows.append(Comparison(
                f"timestep {timestep:g}, phi = {phi:.3f}: (eta/eta0 - 1)/phi", (ratio - 1) / phi,
                math.hypot(unsure / phi, doubt), known * first / 2, "",
                f"first order {first:.2f}; Hashin without slip {2 / (1 - phi):.2f}; {note}",
            ))  # fmt: skip
            met(page, f"by a wave, {rows[-1].what}", rows[-1], 10)
            over.append((rows[-1].measured / rows[-1].expected, known / rows[-1].expected))
            weights.append((rows[-1].expected / rows[-1].error) ** 2)
    mean, slipless = np.average(over, axis=0, weights=weights)
    rows.append(Comparison(
        "the four gains over theory, weighted mean", float(mean), sum(weights) ** -0.5, 1.0, "",
        f"theory without slip: {slipless:.3f}",
    ))  # fmt: skip
    met(page, f"by a wave, {rows[-1].what}", rows[-1], 10)
    page.table(rows)
    page.text(
        "Each gain lies within three of its standard errors of theory, but all four are above it, "
        "together by 3.4 of them. They agree with theory without slip. Whether slip counts for "
        "less in a strain than its length from rotation says was not measured."
    )


def gain_at_random(page: Page, number: int, radius: float, side: int) -> tuple[float, float]:
    """Gain of the viscosity of creeping flow, over phi, with hard disks anywhere in the box."""

    def gains() -> np.ndarray:
        random, found = np.random.default_rng(number), []
        while len(found) < (4 if SHORT else 60):
            places = random.uniform(0, side, (number, 2))
            away = places[:, None] - places
            away -= side * np.rint(away / side)
            square = (away**2).sum(axis=-1) + np.diag(np.full(number, np.inf))
            if square.min() >= (2 * radius) ** 2:
                found.append(viscosity_gain(places, radius, side, 256))
        return np.array(found)

    values = kept(page, f"gains-{number}", f"{number} {radius} {side} 60", gains)
    return float(values.mean()), float(values.std(ddof=1) / math.sqrt(len(values)))


# ---------------------------------------------------------------- squirmers


def inertia(page: Page) -> None:
    """Speeds of pushers and pullers."""
    page.heading("Inertia of pushers and pullers")
    radius, first, beta = 2.0, 0.15, 2.0
    page.text(
        f"Squirmers of R = 2 with B1 = {first:g} and beta = -2 and 2 in cubes, AT+a, timestep 0.1. "
        "To first order in Re = U R/nu the speed is U (1 - 0.15 beta Re): a pusher is faster, a "
        "puller slower. The difference of pusher and puller over their sum stands beside 0.15 "
        "|beta| Re, so that box and slip of the first mode divide out. U is that of the neutral "
        "squirmer in this box, nu that of molecular chaos. The law is not met: it is that of a "
        "wide fluid, and these boxes are far from wide for it. The force of inertia is the sum of "
        "the momentum that the flow carries, weighted with the flow of a sphere that is drawn. "
        "This weight falls as R/r, and in a box it is zero about half a side away. If it falls to "
        "zero there as a line, 1 - 2 r/L, the share that is left is 1 - (2 R/L) (1 + log(L/2 R)). "
        "The table has it as an estimate, times (1 + 2 b/R)/(1 + 5 b/R) for the slip of the second "
        "mode. All three boxes lie below it, by 1.6 to 2.4 standard errors."
    )
    rows, nu = [], float(coefficients(RULE, 3).viscosity)
    for side, length in ((12, 2e5), (16, 1.2e5), (24, 6e4)):
        both = []
        for sign in (-1, 1):
            swim = Squirming(B1=first, B2=sign * beta * first)
            case = case_of(SphereBody(radius=radius, swim=swim), side, RULE, length, BodyDrift())
            files, note = ran(page, f"inertia-{side}-{sign * beta:g}", case)
            both.append(found(files["body-drift"], "velocity along its own axis"))
        pusher, puller = (c.measured for c in both)
        total = pusher + puller
        error = 2 * math.hypot(puller * both[0].error, pusher * both[1].error) / total**2
        fraction = 4 / 3 * math.pi * radius**3 / side**3
        speed = theory.squirmer_speed_in_box(
            theory.squirmer_speed(first), fraction, SLIP[RULE, 3] / radius
        )
        reynolds = speed * radius / nu
        known = theory.squirmer_speed_inertial(1.0, -beta, reynolds) - 1
        unsure = math.hypot(both[0].error, both[1].error) / 2
        rows.append(Comparison(
            f"side {side}: pusher less puller over their sum", (pusher - puller) / total, error,
            known, "", f"Re {reynolds:.2f}; mean {total / 2:.4f} +- {unsure:.4f}, without inertia "
            f"{speed:.4f}; {note} each",
        ))  # fmt: skip
        left = 1 - 2 * radius / side * (1 + math.log(side / (2 * radius)))
        left *= (1 + 2 * SLIP[RULE, 3] / radius) / (1 + 5 * SLIP[RULE, 3] / radius)
        rows.append(Comparison(f"side {side}: over 0.15 |beta| Re; theory: the estimate",
                               (pusher - puller) / total / known, error / known, left)
                    )  # fmt: skip
        met(page, f"pusher and puller: {rows[-2].what}", rows[-2], 10)
    page.table(rows)


def dumbbells(page: Page) -> None:
    """Speed of a body whose counter-force acts on the fluid behind or ahead of it."""
    page.heading("Dumbbell swimmers")
    radius, distance = 2.0, 5.0
    page.text(
        "A sphere or disk of R = 2 under a force along its own axis, with the counter-force on the "
        f"fluid in a ball of radius 1 at {distance:g} behind it (a pusher) or ahead (a puller), "
        "AT+a, the viscous fluid. Theory is `dumbbell_speed` with the viscosity and slip length "
        "above. To first order inertia makes a pusher as much faster as a puller slower. So the "
        "mean of both is to be that of theory. At the timestep 0.1, where U d/nu is 0.73, they "
        "swam at 0.0709(30) and 0.0525(33) in 3D (6000 steps). Theory without inertia is 0.0589."
    )
    rows = []
    for d, side, force, length in ((2, 30, 16.0, 2e5), (3, 16, 40.0, 4e4)):
        kind, both = DiskBody if d == 2 else SphereBody, []
        known = theory.dumbbell_speed(force, radius, distance, DENSITY * NU[d], side, d,
                                      slip=SLIPS[d])  # fmt: skip
        for name, at in (("", -distance), ("-puller", distance)):
            aside = [0.0] * (d - 1)
            body = kind(
                radius=radius, force=(force, *aside), frame="body",
                counter=CounterForce(at=(at, *aside)),
            )  # fmt: skip
            case = case_of(body, side, RULE, length, BodyDrift(), timestep=FINE)
            files, note = ran(page, f"dumbbell-{d}{name}", case)
            both.append(found(files["body-drift"], "velocity along its own axis"))
            note = f"U d/nu {known * distance / NU[d]:.2f}; {note}"
            rows.append(renamed(both[-1], f"{d}D: {name[1:] or 'pusher'}", note, known))
        mean = sum(c.measured for c in both) / 2
        rows.append(Comparison(f"{d}D: mean of both", mean,
                               math.hypot(*(c.error for c in both)) / 2, known, "a/tau")
                    )  # fmt: skip
        met(page, f"dumbbell, {rows[-1].what}", rows[-1], 5)
    page.table(rows)


def oblate(page: Page) -> None:
    """Speed of a flat spheroid that swims along its short axis."""
    page.heading("A flat squirmer")
    first, side = 0.15, 18
    page.text(
        f"A neutral squirmer (B1 = {first:g}) with a half axis of 2 along the way it swims and of "
        f"4 across, AT+a, timestep 0.1, in a cube of side {side}. Theory is B1 (1 - N), which is "
        "0.473 B1, times 1 - phi, with the first order of slip (`slipping`)."
    )
    body = SpheroidBody(half_length=2, radius=4, swim=Squirming(B1=first))
    files, note = ran(page, "oblate", case_of(body, side, RULE, 6e4, BodyDrift()))
    c = found(files["body-drift"], "velocity along its own axis")
    slower = slipping(2.0, 4.0, SLIP[RULE, 3], 3)
    known = theory.squirmer_speed(first, 3, 0.5) * (1 - body.solid(3).volume / side**3) * slower
    row = renamed(c, "spheroid 4 x 8: swimming speed",
                  f"slip takes {100 * (1 - slower):.1f} %; {note}", float(known))  # fmt: skip
    met(page, row.what, row, 5)
    page.table([row])


# ---------------------------------------------------------------- settling


def settling(page: Page) -> None:
    """Hindered settling of few and of many spheres."""
    page.heading("Hindered settling at small and large fractions")
    radius, side, force = 2.0, 16, 12.0
    page.text(
        "Spheres of R = 2 in a cube of side 16 as on the page of bodies in flow, each drawn by the "
        "same force with counter-force, AT+a, timestep 0.1. Theory of the measured speed is the "
        "creeping flow about the spheres at their places in the run, as on the page of "
        "[more flows](bodies_more_flow.md): the gap law decides where spheres are. The same for "
        "hard spheres at random (by Monte Carlo) stands below, beside the law (1 - phi)^5 less "
        "what so few spheres lack. The 37 spheres start at random sites of a crystal."
    )
    rows, free = [], wide_mobility(radius)
    for number, length, start in ((3, 6e4, BodyStart()), (37, 3e4, of_crystal(37, side))):
        body = SphereBody(
            radius=radius, number=number, force=(force, 0.0, 0.0), counter_force=True, start=start
        )
        case = case_of(body, side, RULE, length, BodyDrift())
        case = replace(case, run=replace(case.run, warmup=steps(8e3)))
        files, note = ran(page, f"settling-{number}", case)
        places = recorded(page, f"places-{number}", replace(case, observe=[]), 50,
                          lambda engine: engine.bodies.places(unwrapped=False))  # fmt: skip
        c = found(files["body-drift"], "mobility along x")
        phi = number * 4 / 3 * math.pi * radius**3 / side**3
        x = phi * (1 + phi - 0.189 * phi**2)
        law = theory.hindered_settling(phi, 5.0)
        law -= theory.settling_of_few(phi, number, viscosity=(1 + 1.5 * x) / (1 - x))
        value, error = speed_among(page, f"flow-places-{number}", places, side, radius, 10)
        far, _ = mean_of_parts(speed_of_places(places, side, radius))
        hard = kept(page, f"random-{number}", f"{number} {side} {radius}",
                    lambda number=number: at_random(number, side, 2 * radius))  # fmt: skip
        random, unsure = speed_among(page, f"flow-random-{number}", hard, side, radius, 10)
        reynolds = c.measured * force * radius / VISCOSITIES[RULE, 3][0]
        rows.append(Comparison(
            f"phi = {phi:.3f}, {number} spheres: V/V0 in this box", c.measured / free,
            math.hypot(c.error / free, error), value, "",
            f"Rotne and Prager {far:.3f}; Re {reynolds:.2f}; {note}",
        ))  # fmt: skip
        met(page, rows[-1].what, rows[-1], 10)
        rows.append(Comparison(f"phi = {phi:.3f}: creeping flow, hard spheres at random",
                               random, unsure, law, "", "theory: the law in this box")
                    )  # fmt: skip
    page.table(rows)


def of_crystal(number: int, side: float) -> BodyStart:
    """So many sites, drawn at random, of a body-centred lattice of 54."""
    cell = side / 3
    corners = np.indices((3, 3, 3)).reshape(3, -1).T * cell
    sites = np.concatenate([corners, corners + cell / 2])
    chosen = np.random.default_rng(3).permutation(len(sites))[:number]
    return BodyStart("given", positions=[tuple(map(float, sites[i])) for i in sorted(chosen)])


# ---------------------------------------------------------------- spread


def spread(page: Page) -> None:
    """Diffusion of a sphere."""
    page.heading("Diffusion of a sphere")
    page.text(
        "R = 2 in a cube of side 12, AT+a, timestep 0.1, as on the page of [bodies](bodies.md). "
        "There D, 0.00438(32), lies 1.9 standard errors above theory. Here are four runs with "
        "other seeds, each four times as long. Their scatter gives the last error bars. The "
        "mobility is that under a weak force with counter-force."
    )
    radius, side, eta, slip = 2.0, 12, viscosity(RULE, 3), SLIP[RULE, 3]
    case = case_of(
        SphereBody(radius=radius), side, RULE, 4e5,
        BodyDisplacement(of="places", max_lag=800, every=10),
        BodyDisplacement(name="angles", of="angles", max_lag=800, every=10),
    )  # fmt: skip
    friction = theory.sphere_friction_in_cube(radius, side, eta, slip)
    turning = theory.rotational_friction(radius, eta, 3, side, slip, 0.0)
    rows: list[Comparison] = []
    runs: dict[str, list[float]] = {"D": [], "D_r": []}
    for seed in (12, 31, 32, 33):
        files, note = ran(page, f"spread-{seed}", replace(case, run=replace(case.run, seed=seed)))
        for of, what, known in (("body-displacement", "D", friction), ("angles", "D_r", turning)):
            (c,) = files[of].comparisons
            runs[what].append(c.measured)
            rows.append(renamed(c, f"seed {seed}: {what} by displacement", note, 1 / known))
    for (what, values), c in zip(runs.items(), rows[:2], strict=True):
        value, error = np.mean(values), np.std(values, ddof=1) / math.sqrt(len(values))
        rows.append(Comparison(f"{what}, all runs", float(value), float(error), c.expected, c.unit,
                               "error bar: scatter of the runs"))  # fmt: skip
        met(page, f"sphere R = 2, at+a: {rows[-1].what}", rows[-1], 5)
    body = SphereBody(radius=radius, force=(8.0, 0.0, 0.0), counter_force=True)
    files, note = ran(page, "drawn", case_of(body, side, RULE, 5e5, BodyDrift()))
    c = found(files["body-drift"], "mobility along x")
    note = f"Re {c.measured * 8 * radius / VISCOSITIES[RULE, 3][0]:.2f}; {note}"
    rows.append(renamed(c, "mobility under the force 8", note, 1 / friction))
    met(page, f"sphere R = 2, at+a: {rows[-1].what}", rows[-1], 5)
    page.table(rows)


PARTS: dict[str, Callable[[Page], None]] = {
    "rotation": rotation, "turning": turning, "slit": slit, "disk": disk, "inertia": inertia,
    "dumbbells": dumbbells,
    "oblate": oblate, "wave": wave, "settling": settling, "spread": spread,
}  # fmt: skip


def make(parts: Sequence[str] = tuple(PARTS)) -> int:
    """Write the page, of all parts or those named."""
    page = Page("bodies_slow_flow", "Bodies in a slow flow")
    page.text(PREFACE)
    page.text("It goes on where [more flows](bodies_more_flow.md) left off.")
    for name in parts:
        PARTS[name](page)
    return page.write()


if __name__ == "__main__":
    main(lambda: make([name for name in PARTS if name in sys.argv[1:]] or tuple(PARTS)))
