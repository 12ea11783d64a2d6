"""Nobody inside: a thousand million particle-steps around every shape, and not one in a solid.

Usage: python validation/solids_inside.py [--short]
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from common import Page, main

import mesokit
from mesokit import Box, Case, CaseError, Fluid, MaxwellBoltzmann, Plates, Run, Surface, Uniform
from mesokit.case.component import tag_of
from mesokit.geometry.shape import SHAPES
from mesokit.method.mpcd.engine.cpu.engine import CPU
from mesokit.method.mpcd.start.fluid import start

PARTICLE_STEPS, SHORT = 10**9, 10**6
LOOKS = 20  # besides the one at the end
SIZE = {2: (96, 64), 3: (24, 20, 16)}
RULES = ("no-slip", "slip", "diffuse")


def examples(d: int, folder: Path) -> list[tuple[str, Any]]:
    """A solid of every shape in the middle of the box, by name."""
    size = SIZE[d]
    middle, radius = tuple(0.5 * n for n in size), 0.3 * min(size)
    ball = mesokit.Disk if d == 2 else mesokit.Sphere
    aside = tuple(x + 0.4 * radius for x in middle)
    two = ball(middle, radius), ball(aside, 0.8 * radius)
    sides = tuple(1.3 * radius * (1 + 0.2 * k) for k in range(d))
    found = [
        Plates("y"),
        mesokit.HalfSpace(tuple(0.2 * n for n in size), (0.0, 1.0, 0.0)[:d]),
        mesokit.Capsule(middle, aside, 0.7 * radius),
        mesokit.CosineChannel(width=0.6 * size[1], amplitude=0.2 * size[1], waves=2),
        mesokit.Union(two),
        mesokit.Intersection(two),
        mesokit.Array(of=ball(tuple(0.5 * x for x in middle), 0.4 * radius), repeat=(2,) * d),
        sampled(d, middle, radius, folder),
    ]
    if d == 2:
        found += [ball(middle, radius), mesokit.Rectangle(middle, sides, 27.0)]
        found.append(mesokit.Ellipse(middle, (2 * radius, radius), 27.0))
        found.append(picture(middle, radius, folder))
    else:
        found += [ball(middle, radius), mesokit.Cuboid(middle, sides, 27.0)]
        found.append(mesokit.Spheroid(middle, radius, 0.5 * radius, axis=(1, 2, -2)))
        found.append(mesokit.Cylinder(middle, radius, axis="x", fluid="inside"))
    found.append(mesh(middle, radius, folder))
    return [(wall.shape, wall) for wall in found]


def sampled(d: int, middle: tuple[float, ...], radius: float, folder: Path) -> Any:
    """A torus, or in 2D a ring."""
    steps = np.arange(-1.5 * radius, 1.5 * radius + 0.1, 0.25)
    x, y, *z = np.meshgrid(*[steps] * d, indexing="ij")
    ring = np.hypot(np.hypot(x, y) - radius, z[0] if z else 0.0) - 0.3 * radius
    origin = tuple(c - 1.5 * radius for c in middle)
    return mesokit.Sampled.from_array(ring, folder / f"ring-{d}.npy", 0.25, origin=origin)


def picture(middle: tuple[float, ...], radius: float, folder: Path) -> Any:
    """A star."""
    from PIL import Image

    grids = [(np.arange(8 * n) + 0.5) / 8 - c for n, c in zip(SIZE[2], middle, strict=True)]
    x, y = np.meshgrid(*grids)
    star = np.hypot(x, y) < radius * (1 + 0.3 * np.cos(5 * np.arctan2(y, x)))
    Image.fromarray(np.where(star, 0, 255).astype(np.uint8)).save(folder / "star.png")
    return mesokit.Picture(str(folder / "star.png"))


def mesh(middle: tuple[float, ...], radius: float, folder: Path) -> Any:
    """A cube on its corner."""
    import trimesh

    cube = trimesh.creation.box((1.4 * radius,) * 3)
    cube.apply_transform(trimesh.transformations.euler_matrix(0.6, 0.5, 0.4))
    cube.export(folder / "cube.stl")
    return mesokit.Mesh(str(folder / "cube.stl"), position=middle)


def fluid_around(wall: Any, d: int, rule: str) -> CPU:
    """A fluid that is driven along the solid, with plates beside it where the box needs them."""
    key = ("lower", "upper") if wall.shape == "plates" else ("surface",)
    parts = {name: getattr(wall, name) for name in wall.__pydantic_fields__}
    solid = type(wall)(**parts | dict.fromkeys(key, Surface(rule)))
    fluid = Fluid(
        density=10, timestep=0.1, thermostat=MaxwellBoltzmann(),
        force=Uniform((0.01, *(0.0,) * (d - 1))),
    )  # fmt: skip
    try:
        case = Case(run=Run(1), box=Box(SIZE[d]), fluid=fluid, walls=(solid,))
    except CaseError:
        case = Case(run=Run(1), box=Box(SIZE[d]), fluid=fluid, walls=(solid, Plates("y")))
    cpu = CPU(case)
    start(cpu)
    return cpu


def count(cpu: CPU, wanted: int) -> tuple[int, int, float]:
    """Particle-steps done, particles found inside, and particle-steps per second."""
    steps = max(wanted // cpu.n, LOOKS)
    inside, seconds = 0, 0.0
    cpu.advance(1)  # compiles
    for look in range(LOOKS):
        part = steps * (look + 1) // LOOKS - steps * look // LOOKS
        began = time.perf_counter()
        cpu.advance(part)
        seconds += time.perf_counter() - began
        assert cpu.numbers.solids is not None
        inside += int((cpu.numbers.solids.distance(cpu.positions()) < 0).sum())
    return steps * cpu.n, inside, steps * cpu.n / seconds


def make(short: bool = False) -> int:
    """Write the page, but not after a short run."""
    page = Page("solids_inside", "Nobody inside: every shape and every rule of surfaces")
    wanted = SHORT if short else PARTICLE_STEPS
    page.text(
        f"SRD, density 10, timestep 0.1, driven along x, in {' x '.join(map(str, SIZE[2]))} and "
        f"{' x '.join(map(str, SIZE[3]))} cells; a third of the particle-steps with each rule of "
        f"surfaces ({', '.join(RULES)}). All particles are looked at {LOOKS} times in each run, "
        "the last time at its end."
    )
    rows, shown, done, total = [], set(), 0, 0
    with tempfile.TemporaryDirectory() as folder:
        for d in (2, 3):
            for name, wall in examples(d, Path(folder)):
                shown.add((name, d))
                found = [count(fluid_around(wall, d, rule), wanted // 3) for rule in RULES]
                particle_steps = sum(n for n, _, _ in found)
                inside = sum(n for _, n, _ in found)
                rate = 1e-6 * len(found) / sum(1 / r for _, _, r in found)
                rows.append([name, f"{d}D", f"{particle_steps:.3g}", inside, f"{rate:.1f}"])
                print(*rows[-1], flush=True)
                done, total = done + particle_steps, total + inside
    head = ["shape", "", "particle-steps", "particles inside", "million particle-steps/s"]
    page.grid(head, rows)
    page.check(f"{total} particles inside a solid in {done:.3g} particle-steps (0)", total == 0)
    missing = {
        (tag_of(shape)[1], d)
        for shape in SHAPES
        for d in shape.dimensions  # type: ignore[index]
    } - shown
    page.check(f"every shape is here (missing: {sorted(missing) or 'none'})", not missing)
    return sum(not met for _, met in page.checks) if short else page.write()


if __name__ == "__main__":
    main(lambda: make("--short" in sys.argv[1:]))
