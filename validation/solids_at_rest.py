"""Density and temperature up to the surface, for every shape and every surface."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from common import BLUE, GREEN, RED, RUNS, Page, found, long, main, plt
from PIL import Image

import mesokit
from mesokit import (
    Array,
    Box,
    Capsule,
    Case,
    CosineChannel,
    Cuboid,
    Cylinder,
    Disk,
    Ellipse,
    Fluid,
    HalfSpace,
    Intersection,
    MaxwellBoltzmann,
    Picture,
    Plates,
    Rectangle,
    Run,
    Sampled,
    Sphere,
    Spheroid,
    Surface,
    Union,
)

SURFACES = {
    "no-slip": {}, "turning": {"rotation": 0.02}, "slip": {"rule": "slip"},
    "diffuse": {"rule": "diffuse"},
}  # fmt: skip
TURNS = ("disk", "drum", "cylinder", "pipe", "sphere")  # shapes that can turn
SIZE = {2: (24, 24), 3: (14, 14, 14)}


def curved(d: int) -> Any:
    """A trefoil, or a torus, by its signed distance or what has its sign."""
    folder = RUNS / "shapes"
    folder.mkdir(parents=True, exist_ok=True)
    steps = np.arange(-7, 7.1, 0.25)
    x, y, *z = np.meshgrid(*[steps] * d, indexing="ij")
    if d == 2:  # a ring would close in fluid, whose number never changes
        values = np.hypot(x, y) - 4.5 - 1.2 * np.cos(3 * np.arctan2(y, x))
    else:
        values = np.hypot(np.hypot(x, y) - 4, z[0]) - 1.5
    return {"file": folder / f"curved-{d}.npy", "values": values}


def star() -> str:
    """A star, as a picture."""
    folder = RUNS / "shapes"
    folder.mkdir(parents=True, exist_ok=True)
    x, y = np.meshgrid(*[(np.arange(24 * 16) + 0.5) / 16 - 12] * 2)
    inside = np.hypot(x, y) < 6 * (1 + 0.25 * np.cos(5 * np.arctan2(y, x)))
    Image.fromarray(np.where(inside, 0, 255).astype(np.uint8)).save(folder / "star.png")
    return str(folder / "star.png")


def shapes(d: int, rule: dict[str, Any]) -> dict[str, list[Any]]:
    """Walls of each kind, with this surface."""
    s = {"surface": Surface(**rule)}
    plates = Plates("y", lower=Surface(**rule), upper=Surface(**rule))
    if d == 2:
        middle = (12.0, 12.0)
        data = curved(2)
        return {
            "plates": [plates],
            "half-space": [plates, HalfSpace((0, 5.3), (0, 1), **s)],
            "disk": [Disk(middle, 5.2, **s)],
            "drum": [Disk(middle, 10.3, fluid="inside", **s)],
            "rectangle": [Rectangle(middle, (9, 5), 27, **s)],
            "capsule": [Capsule((8, 9), (15, 14), 3, **s)],
            "ellipse": [Ellipse(middle, (13, 7), 27, **s)],
            "cosine channel": [CosineChannel(width=13, amplitude=3, **s)],
            "union": [Union((Disk((9, 12), 4), Rectangle((15, 12), (7, 5))), **s)],
            "intersection": [Intersection((Disk(middle, 6), HalfSpace(middle, (1, 2))), **s)],
            "array": [Array(of=Disk((6, 6), 3.1), repeat=(2, 2), **s)],
            "picture": [Picture(star(), **s)],
            "sampled": [Sampled.from_array(data["values"], data["file"], 0.25, origin=(5, 5), **s)],
        }
    middle, data = (7.0, 7.0, 7.0), curved(3)
    return {
        "plates": [plates],
        "half-space": [plates, HalfSpace((0, 4.3, 0), (0, 1, 0), **s)],
        "sphere": [Sphere(middle, 4.2, **s)],
        "cylinder": [Cylinder(middle, 3.6, **s)],
        "pipe": [Cylinder(middle, 6.1, axis="x", fluid="inside", **s)],
        "cuboid": [Cuboid(middle, (6, 5, 4), 27, **s)],
        "capsule": [Capsule((5, 5, 6), (9, 8, 7), 2.5, **s)],
        "spheroid": [Spheroid(middle, 4.5, 2.5, axis=(1, 2, -2), **s)],
        "union": [Union((Sphere((5, 7, 7), 3), Cuboid((9, 7, 7), (4, 4, 3))), **s)],
        "array": [Array(of=Sphere((3.5, 3.5, 3.5), 2.2), repeat=(2, 2, 2), **s)],
        "sampled": [Sampled.from_array(data["values"], data["file"], 0.25, origin=(0, 0, 0), **s)],
    }


def case(d: int, walls: list[Any], steps: int) -> Case:
    """A fluid at rest, or turned by its wall."""
    return Case(
        run=Run(steps=steps, warmup=200, seed=12),
        box=Box(SIZE[d]),
        fluid=Fluid(density=10, timestep=0.1, thermostat=MaxwellBoltzmann()),
        walls=walls,
        observe=[
            mesokit.SurfaceProfile(of="density", depth=2, every=20),
            mesokit.SurfaceProfile(of="temperature", depth=2, every=20, name="temperature"),
            mesokit.Forces(every=10),
        ],
    )


def drawn(shells: dict[str, tuple[list[Any], list[Any]]]) -> Any:
    """Density and temperature in each shell, and the mean over shapes for each surface."""
    fig, axes = plt.subplots(1, 2, figsize=(9.5, 3.8))
    looks = dict(zip(shells, (("o", BLUE), ("s", GREEN), ("^", RED)), strict=True))
    for axis, which, level in zip(axes, (0, 1), (10, 1), strict=True):
        for number, (surface, (mark, colour)) in enumerate(looks.items()):
            distance, value, error = np.array(shells[surface][which]).swapaxes(0, 1)
            aside = 0.03 * (number - 1)
            axis.plot(distance.T + aside, value.T, ".", ms=1.5, color="0.75", zorder=0)
            weight = 1 / error**2
            mean = (weight * value).sum(axis=0) / weight.sum(axis=0)
            axis.errorbar(
                distance[0] + aside, mean, weight.sum(axis=0) ** -0.5, fmt=mark, ms=3, mfc="white",
                color=colour, label=surface, zorder=3,
            )  # fmt: skip
        axis.axhline(level, color="k", lw=0.8, label="expected")
        axis.set(xlabel="distance from the surface", xlim=(0, 2))
    axes[0].set(ylabel="density  [$a^{-2}$ or $a^{-3}$]")
    axes[1].set(ylabel="temperature")
    axes[0].legend(ncols=2, loc="upper left")
    return fig


def make() -> int:
    """Write the page."""
    page = Page("solids_at_rest", "Density and temperature next to solids")
    page.text(
        "SRD, density 10, timestep 0.1, Maxwell-Boltzmann thermostat, at rest; 'turning' surfaces "
        "move along themselves, at up to 0.2. Shells of an eighth of a cell about each solid, 2 "
        "cells deep. 'At the surface' is the mean over the cell next to it; chi-square is over all "
        "shells, with the correlations between them. Where a surface turns, the fluid turns with "
        "it: it is denser outside, its temperature counts the flow, and neither is compared. "
        "Forces: the largest component of force or torque on any solid at rest, in standard errors."
    )
    rows, tests, off = [], [], []
    # of density and temperature about each shape
    shells = {surface: ([], []) for surface in SURFACES if surface != "turning"}
    for d in (2, 3):
        for surface, rule in SURFACES.items():
            for name, walls in shapes(d, {} if surface == "turning" else rule).items():
                if surface == "turning":
                    if name not in TURNS:
                        continue
                    walls = shapes(d, rule)[name]
                files = page.run(
                    f"{d}-{surface}-{name}", case(d, walls, long(6000 if d == 2 else 3000))
                )
                density, temperature = files["surface-profile"], files["temperature"]
                near = found(density, "density in the cell")
                cells = [f"{d}D {name}", surface, f"{near.measured:.3f} +- {near.error:.3f}"]
                profiles = [(density, "density")]
                if surface != "turning":
                    off.append((near.deviation, f"{d}D {name}, {surface}: density"))
                    warm = found(temperature, "temperature in the cell")
                    off.append((warm.deviation, f"{d}D {name}, {surface}: temperature"))
                    cells.append(f"{warm.measured:.4f} +- {warm.error:.4f}")
                    profiles.append((temperature, "temperature"))
                else:
                    cells.append("")
                for result, what in profiles:
                    chi = next((c for c in result.comparisons if c.what.startswith("chi")), None)
                    if chi is None:
                        cells.append("")
                        continue
                    p = float(chi.note.split("p = ")[1].split(",")[0])
                    tests.append((p, f"{d}D {name}, {surface}: {what}"))
                    cells.append(f"{chi.measured:.2f} ({p:.2g})")
                if surface == "turning":
                    cells += [""] * (6 - len(cells)) + [""]
                else:
                    forces = files["forces"]
                    ratio = np.abs(forces.value / np.where(forces.error > 0, forces.error, np.inf))
                    if name not in ("plates", "half-space"):  # these feel the pressure
                        cells.append(f"{ratio.max():.1f}")
                        off.append((float(ratio.max()), f"{d}D {name}, {surface}: force or torque"))
                    else:
                        cells.append("")
                rows.append(cells)
                if surface != "turning":
                    for shown, result in zip(shells[surface], (density, temperature), strict=True):
                        shown.append([result.x["distance"], result.value, result.error])
    page.grid(
        ["solid", "surface", "density at the surface (10)", "temperature at the surface (1)",
         "density: chi-square per degree (p)", "temperature: chi-square per degree (p)",
         "largest force"], rows,
    )  # fmt: skip
    # of so many tests, the smallest p and the largest deviation there should be
    least, which = min(tests)
    page.check(
        f"uniform up to the surface: smallest p of {len(tests)} chi-square tests {least:.2g} "
        f"({which}; above {0.01 / len(tests):.1g}, which is 1 % for all together)",
        least > 0.01 / len(tests),
    )
    share = float(np.mean([p < 0.05 for p, _ in tests]))
    page.check(
        f"p below 0.05 in {100 * share:.0f} % of them (5 % by chance; at most 15 %)", share < 0.15
    )
    worst, which = max((abs(x), name) for x, name in off)
    page.check(
        f"density, temperature and force at the surface: largest of {len(off)} deviations "
        f"{worst:.1f} s.e. ({which}; below 4.5)", worst < 4.5,
    )  # fmt: skip
    for name in ("density", "temperature"):
        values = [x for x, which in off if which.endswith(name)]
        mean, error = float(np.mean(values)), 1 / math.sqrt(len(values))
        page.check(
            f"{name} at the surface: mean of {len(values)} deviations {mean:+.2f} +- {error:.2f} "
            "s.e. (within 3 of its errors)",
            abs(mean) < 3 * error,
        )
    page.figure(
        drawn(shells),
        "Dots: every shell of every shape at rest, in 2D and 3D. Over them the means of all shapes "
        "with the same surface, weighted by their errors, with one standard error.",
    )
    return page.write()


if __name__ == "__main__":
    main(make)
