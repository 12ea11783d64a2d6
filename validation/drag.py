"""Slow flow past cylinders and spheres: drag, permeability, and one circle given in three ways."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from common import ANGLE, BLUE, GREEN, GREY, RED, RUNS, Page, found, long, main, plt, renamed
from PIL import Image, ImageDraw

import mesokit
from mesokit import (
    SRD,
    Box,
    Case,
    Comparison,
    Disk,
    Fluid,
    MaxwellBoltzmann,
    Picture,
    Plates,
    Run,
    Sampled,
    Sphere,
    Uniform,
    theory,
)
from mesokit.theory.channel_cylinder import CREEPING

HEIGHT, RADIUS, PUSH = 24, 3.0, 0.003  # of the channel, the cylinder in it, and the force
POST = 6.0  # radius of the posts of square arrays
PITCHES = (34, 24, 20)
SPEED = 0.06  # superficial, aimed at
NAMES = {"disk": "disk", "picture": "picture (PNG, 16 pixels a cell)", "mesh": "mesh (STL)",
         "sampled": "sampled distance (4 a cell)"}  # fmt: skip


def fluid(d: int, push: float) -> Fluid:
    """A viscous one, whose viscosity fluctuations raise by about a per cent only."""
    return Fluid(
        density=10, timestep=0.1, collision=SRD(angle=90 if d == 2 else ANGLE),
        thermostat=MaxwellBoltzmann(), force=Uniform(acceleration=(push, *[0.0] * (d - 1))),
    )  # fmt: skip


def viscosity(d: int) -> float:
    """Kinematic, of theory."""
    angle = 90 if d == 2 else ANGLE
    return theory.transport(
        "srd", d, 10, 0.1, angle=angle, thermostat="maxwell-boltzmann"
    ).viscosity


def circle(kind: str) -> Any:
    """The cylinder in the channel, as a shape, a picture, a mesh or samples."""
    centre, folder = np.array([HEIGHT, HEIGHT / 2]), RUNS / "circle"
    folder.mkdir(parents=True, exist_ok=True)
    if kind == "disk":
        return Disk(centre=tuple(centre), radius=RADIUS, name="body")
    if kind == "picture":
        pixels, side = 16, 2 * HEIGHT // 6
        image = Image.new("L", (8 * side * pixels, 8 * side * pixels), 255)  # drawn 8 times finer
        middle, r = 4 * side * pixels, 8 * RADIUS * pixels
        box = (middle - r - 0.5, middle - r - 0.5, middle + r - 0.5, middle + r - 0.5)
        ImageDraw.Draw(image).ellipse(box, fill=0)
        image.resize((side * pixels, side * pixels), Image.Resampling.BOX).save(folder / "c.png")
        corner = tuple(centre - side / 2)
        return Picture(file=str(folder / "c.png"), origin=corner, size=(side, side), name="body")
    if kind == "mesh":
        import trimesh

        trimesh.creation.cylinder(radius=RADIUS, height=2, sections=128).export(folder / "c.stl")
        return mesokit.Mesh(file=str(folder / "c.stl"), position=tuple(centre), name="body")
    grid = np.arange(-RADIUS - 3, RADIUS + 3.01, 0.25)
    x, y = np.meshgrid(grid, grid, indexing="ij")
    corner = tuple(centre + grid[0])
    return Sampled.from_array(
        np.hypot(x, y) - RADIUS, folder / "c.npy", 0.25, origin=corner, name="body"
    )


def creeping(kind: str) -> Case:
    """A cylinder in a channel, a row of them in fact."""
    return Case(
        run=Run(steps=long(6e4), warmup=long(2000), seed=5),
        box=Box([2 * HEIGHT, HEIGHT]),
        fluid=fluid(2, PUSH),
        walls=[Plates(axis="y"), circle(kind)],
        observe=[mesokit.FlowRate(every=10), mesokit.Forces(length=2 * RADIUS, every=10)],
    )


def array(pitch: int) -> Case:
    """A square array of posts: one in a periodic box."""
    concentration = math.pi * POST**2 / pitch**2
    push = viscosity(2) * SPEED / theory.square_array_permeability(concentration, pitch)
    steps = {34: 2.5e5, 24: 2e5, 20: 2e5}[pitch]
    return Case(
        run=Run(steps=long(steps), warmup=long(3000), seed=6),
        box=Box([pitch, pitch]),
        fluid=fluid(2, push),
        walls=[Disk(centre=[pitch / 2, pitch / 2], radius=POST)],
        observe=[mesokit.FlowRate(every=10), mesokit.Forces(every=10)],
    )


def spheres(radius: float, length: int) -> Case:
    """A sphere in a periodic box."""
    nu, concentration = viscosity(3), 4 * math.pi * radius**3 / (3 * length**3)
    push = nu * SPEED / theory.cubic_array_permeability(concentration, length)
    return Case(
        run=Run(steps=long(3e4), warmup=long(6000), seed=7),
        box=Box([length] * 3),
        fluid=fluid(3, push),
        walls=[Sphere(centre=[length / 2] * 3, radius=radius)],
        observe=[mesokit.FlowRate(every=5), mesokit.Forces(every=5)],
    )


def balanced(page: Page, what: str, files: Any) -> Comparison:
    """The force on all solids beside the body force."""
    total = found(files["forces"], "force on all solids")
    page.check(
        f"{what}: force on the solids {total.percent:+.2f} +- "
        f"{100 * total.error / total.expected:.2f} % off the body force (within 3 %)",
        abs(total.percent) < 3,
    )
    return renamed(total, f"{what}: {total.what}")


def in_a_channel(page: Page, axis: Any) -> None:
    """The creeping flow, with the cylinder given in every way."""
    page.heading("Cylinder in a channel")
    nu = viscosity(2)
    page.text(
        f"Slit of height H = {HEIGHT}, diameter H/4, periodic after 2H; 2D, SRD at 90 degrees, "
        f"density 10, timestep 0.1, g = {PUSH}. The Reynolds number is about 0.5. Reference: "
        "lattice Boltzmann at two resolutions; its mean velocity is that over the "
        "fluid. The viscosity is that of theory; in 2D it is "
        "known to 1 or 2 % only, which goes into the mean velocity, not into the share of the "
        "force. The circle is given as a disk, as a PNG, as a mesh and as samples of its distance: "
        "four runs, with the same seed but soon of different particles."
    )
    rows, shares = [], {}
    speed, share = (reference.value for reference in CREEPING)
    for kind, name in NAMES.items():
        files = page.run(f"creeping-{kind}", creeping(kind))
        mean = found(files["flow-rate"], "mean velocity")
        part = found(files["forces"], "share of body")
        rows.append(balanced(page, name, files))
        room = 2 * HEIGHT**2  # the reference is the mean over the fluid, not over the whole box
        scale = nu / (PUSH * HEIGHT**2) * room / (room - math.pi * RADIUS**2)
        rows.append(
            Comparison(f"{name}: mean velocity, in g H^2/nu", scale * mean.measured,
                       scale * mean.error, speed, "", "theoretical viscosity")
        )  # fmt: skip
        rows.append(
            Comparison(f"{name}: share of the force on the cylinder", part.measured, part.error,
                       100 * share, "%", "lattice Boltzmann")
        )  # fmt: skip
        drag = part.measured / mean.measured  # per velocity
        shares[kind] = (
            drag,
            drag * math.hypot(part.error / part.measured, mean.error / mean.measured),
        )
        for c, limit in ((rows[-2], 8), (rows[-1], 8)):
            page.check(
                f"{c.what} {c.percent:+.1f} +- {100 * c.error / c.expected:.1f} % off the "
                f"reference (within {limit} %)",
                abs(c.percent) < limit,
            )
    page.table(rows)
    first, error = shares["disk"]
    for kind in list(NAMES)[1:]:
        other, spread = shares[kind]
        off, sigma = 100 * (other / first - 1), 100 * math.hypot(error, spread) / first
        page.check(
            f"drag per velocity of the {NAMES[kind]} {off:+.1f} +- {sigma:.1f} % off that of the "
            "disk (within 3 s.e.)",
            abs(off) < 3 * sigma,
        )
    for place, kind in enumerate(NAMES):
        value, sigma = shares[kind]
        axis.errorbar(place, value / first, sigma / first, fmt="o", color=BLUE, mfc="white")
    axis.axhline(1, color=GREY, lw=1)
    axis.set(xticks=range(len(NAMES)), xticklabels=list(NAMES), ylim=(0.9, 1.1), title="one circle",
             xlim=(-0.5, 3.5), ylabel="drag per velocity / that of the disk")  # fmt: skip


def in_arrays(page: Page, axis: Any) -> None:
    """Permeability of square arrays."""
    page.heading("Square arrays of posts")
    page.text(
        f"One disk of radius {POST:g} in a periodic square; the same fluid, driven to a "
        f"superficial velocity of about {SPEED}, which is a Reynolds number (of the diameter) of "
        "1. Permeability k = nu U/g with the theoretical viscosity, beside Sangani and "
        "Acrivos (1982)."
    )
    rows = []
    for pitch in PITCHES:
        concentration = math.pi * POST**2 / pitch**2
        files = page.run(f"array-{pitch}", array(pitch))
        k = found(files["flow-rate"], "permeability")
        what = f"volume fraction {concentration:.3f}"
        rows += [renamed(k, f"{what}: permeability"), balanced(page, what, files)]
        percent = 100 * k.error / k.expected
        page.check(
            f"{what}: permeability {k.percent:+.1f} +- {percent:.1f} % off Sangani and Acrivos "
            "(within 5 %)",
            abs(k.percent) < 5,
        )
        axis.errorbar(concentration, k.measured / POST**2, k.error / POST**2, fmt="o", color=RED,
                      mfc="white", label="measured" if pitch == PITCHES[0] else "")  # fmt: skip
    c = np.linspace(0.08, 0.32, 40)
    lines = [
        theory.square_array_permeability(x, math.sqrt(math.pi / x) * POST) / POST**2 for x in c
    ]
    axis.semilogy(c, lines, "-", color=GREY, label="theory: Sangani and Acrivos")
    axis.set(xlabel="volume fraction", ylabel="$k/R^2$", title="square arrays")
    axis.legend()
    page.table(rows)


def in_three_dimensions(page: Page, axis: Any) -> None:
    """Drag on a sphere."""
    page.heading("Sphere")
    page.text(
        "One sphere in a periodic cube; 3D, SRD at 2.27 rad, density 10, timestep 0.1. K is the "
        "drag over that of Stokes, 6 pi eta R U, with the superficial velocity U; Hasimoto's K "
        "is what the periodic images make of it. The Reynolds number of the diameter is about "
        "0.6. Viscosity of theory, good to about 1 %. A slip length of 0.05 cells, as between "
        "turning cylinders, would make the drag 2 to 3 % too small."
    )
    rows = []
    for radius, length in ((4.0, 24), (5.0, 24)):
        concentration = 4 * math.pi * radius**3 / (3 * length**3)
        files = page.run(f"sphere-{radius:g}-{length}", spheres(radius, length))
        flow = found(files["flow-rate"], "mean velocity")
        push = files.case.fluid.force.acceleration[0]
        stokes = push * length**3 / (6 * math.pi * viscosity(3) * radius)
        drag, exact = stokes / flow.measured, theory.cubic_array_drag(concentration)
        hasimoto = theory.cubic_array_drag_dilute(concentration)
        what = f"R = {radius:g}, L = {length}"
        k = Comparison(f"{what}: drag over that of Stokes, K", drag,
                       drag * flow.error / flow.measured, exact, "",
                       f"Sangani and Acrivos; Hasimoto {hasimoto:.3f}")  # fmt: skip
        rows += [k, balanced(page, what, files)]
        page.check(
            f"{what}: drag {k.percent:+.1f} +- {100 * k.error / k.expected:.1f} % off Stokes with "
            "the correction of Hasimoto, Sangani and Acrivos (within 5 %)",
            abs(k.percent) < 5,
        )
        axis.errorbar(radius / length, drag, k.error, fmt="o", color=GREEN, mfc="white",
                      label="measured" if radius == 4 else "")  # fmt: skip
    ratio = np.linspace(0, 0.25, 50)[1:]
    fractions = 4 * math.pi * ratio**3 / 3
    axis.plot(
        ratio,
        [theory.cubic_array_drag(x) for x in fractions],
        color=GREY,
        label="theory: Sangani and Acrivos",
    )
    axis.set(xlabel="$R/L$", ylabel="drag / $6\\pi\\eta R U$", title="sphere in a cube")
    axis.legend()
    page.table(rows)


def make() -> int:
    """Write the page."""
    page = Page("drag", "Slow flow past cylinders and spheres")
    fig, axes = plt.subplots(1, 3, figsize=(11, 3.6))
    in_a_channel(page, axes[0])
    in_arrays(page, axes[1])
    in_three_dimensions(page, axes[2])
    page.figure(
        fig, "Left: drag on one circle given in four ways. Middle: permeability of square arrays. "
        "Right: drag on a sphere in a periodic box over that of Stokes. Error bars: one standard "
        "error, in the middle below the points.",
    )  # fmt: skip
    return page.write()


if __name__ == "__main__":
    main(make)
