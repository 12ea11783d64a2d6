"""An example of every shape, from the words of its fields, and what the tests ask of solids."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import trimesh
from numba import njit
from PIL import Image

from mesokit import (
    Box,
    Case,
    CaseError,
    Disk,
    MaxwellBoltzmann,
    Plates,
    Run,
    Solids,
    Sphere,
    Surface,
    Uniform,
)
from mesokit.case.component import tag_of
from mesokit.geometry.protocol import homed
from mesokit.geometry.shape import SHAPES
from mesokit.geometry.solids.bodies import NO_TERM
from mesokit.geometry.solids.flight import first_meeting
from mesokit.method.mpcd.engine.cpu.bounce import bounce
from mesokit.method.mpcd.streaming import fall
from mesokit.scalar.random import Counter
from tests.helpers.small_fluids import make_fluid

SIZE = {2: (12, 10), 3: (12, 10, 9)}
ROUND = {2: Disk, 3: Sphere}
FIRST, SECOND = (5.3, 4.6, 4.2), (6.9, 5.4, 4.9)  # places
SIDES = ("outside", "inside")
SCALE = 2.0**44

# Values of fields, by their names; vectors have as many numbers as the box has axes.
PLACES = {"centre": FIRST, "point": FIRST, "start": FIRST, "end": SECOND, "position": FIRST}
VECTORS = PLACES | {"size": (3.6, 2.8, 3.1), "normal": (0.0, 1.0, 0.0), "repeat": (2, 2, 2)}
NUMBERS = {"radius": 1.9, "half_length": 2.7, "width": 5.0, "amplitude": 0.8, "angle": 27.0}
NUMBERS |= {"spacing": 0.25}
WORDS = {"plates": {"axis": "y"}, "spheroid": {"axis": (1, 2, -2)}}  # for one shape
NAMES = [tag_of(shape)[1] for shape in SHAPES]
EVERY = [
    (name, d, side)
    for shape, name in zip(SHAPES, NAMES, strict=True)
    for d in shape.dimensions
    for side in (SIDES if "fluid" in shape.__pydantic_fields__ else SIDES[:1])
]


def of_name(name: str) -> Any:
    """The shape of that name."""
    return SHAPES[NAMES.index(name)]


def example(name: str, d: int, side: str, folder: Path, **others: Any) -> Any:
    """A shape of that name; a field that no table here knows wants an entry in one."""
    shape, given = of_name(name), dict(WORDS.get(name, {}))
    a, b = ROUND[d](FIRST[:d], 1.9), ROUND[d](SECOND[:d], 1.4)
    parts = {"parts": (a, b), "of": ROUND[d]((2.4, 1.7, 2.2)[:d], 1.1)}
    for field in shape.__pydantic_fields__:
        if field in VECTORS:
            given[field] = VECTORS[field][:d]
        elif field in NUMBERS:
            given[field] = NUMBERS[field]
        elif field in parts:
            given[field] = parts[field]
    if "file" in shape.__pydantic_fields__:
        given |= FILES[name](folder, d)
    if side == "inside":
        given["fluid"] = "inside"
    return shape(**given | others)


def _array(folder: Path, d: int) -> dict[str, Any]:
    grid = np.meshgrid(*[np.arange(-3.5, 3.6, 0.25)] * d, indexing="ij")
    file = folder / f"ball-{d}.npy"
    np.save(file, np.sqrt(sum(x**2 for x in grid)) - 1.9)
    origin = tuple(x - 3.5 for x in FIRST[:d])
    return {"file": str(file), "spacing": 0.25, "origin": origin, "centre": FIRST[:d]}


def _picture(folder: Path, d: int) -> dict[str, Any]:
    pixels, fine = 8, 4
    x, y = (
        (np.arange(n * pixels * fine) + 0.5) / (pixels * fine) - c
        for n, c in zip(SIZE[2], FIRST, strict=False)
    )
    white = (np.hypot(*np.meshgrid(x, y)) > 1.9).astype(float)
    shape = len(y) // fine, fine, len(x) // fine, fine
    grey = np.round(255 * white.reshape(shape).mean(axis=(1, 3))).astype(np.uint8)
    file = folder / "disk.png"
    Image.fromarray(grey[::-1]).save(file)
    return {"file": str(file), "size": None}


def _mesh(folder: Path, d: int) -> dict[str, Any]:
    file = folder / "ball.stl"
    trimesh.creation.icosphere(subdivisions=4, radius=1.9).export(file)
    return {"file": str(file)}


FILES = {"sampled": _array, "picture": _picture, "mesh": _mesh}


def walls_of(wall: Any, d: int) -> tuple[Any, ...]:
    """The shape, and plates beside it if it does not fit the periodic box alone."""
    try:
        case_of((wall,), d)
    except CaseError as error:
        assert "do not fit the periodic box" in str(error)
        return wall, Plates("y")
    return (wall,)


def case_of(walls: tuple[Any, ...], d: int, **parts: Any) -> Case:
    """A case with these walls."""
    return Case(run=Run(1), box=Box(SIZE[d]), walls=walls, **parts)


def solids_of(walls: tuple[Any, ...], d: int) -> Solids:
    """Those walls in the box of the tests."""
    return Solids(walls, Box(SIZE[d]))


def with_surface(wall: Any, surface: Any) -> Any:
    """The same shape with another surface."""
    names = ("lower", "upper") if wall.shape == "plates" else ("surface",)
    return dataclasses.replace(wall, **dict.fromkeys(names, surface))


def walls_in(case, folder):
    """Walls of the example of a shape."""
    name, d, side = case
    return walls_of(example(name, d, side, folder), d)


def fluid_between(walls, d, rule, timestep, threads=1, seed=1):
    """A driven fluid between the walls, which has them measured."""
    walls = tuple(with_surface(wall, Surface(rule)) for wall in walls)
    push = (0.05, *(0.0,) * (d - 1))
    return make_fluid(
        SIZE[d], density=4.3, walls=walls, timestep=timestep, thermostat=MaxwellBoltzmann(),
        force=Uniform(push), measures=("walls",), threads=threads, seed=seed,
    )  # fmt: skip


def from_ellipse(half_x: Any, half_y: Any, x: Any, y: Any) -> Any:
    """Signed distance of places with x, y >= 0 from an ellipse, by bisection of the angle."""
    low, high = np.zeros(np.shape(x)), np.full(np.shape(x), 0.5 * np.pi)
    for _ in range(60):
        middle = 0.5 * (low + high)
        out_x, out_y = half_x * np.cos(middle) - x, half_y * np.sin(middle) - y
        farther = half_y * np.cos(middle) * out_y > half_x * np.sin(middle) * out_x
        low, high = np.where(farther, low, middle), np.where(farther, middle, high)
    away = np.hypot(half_x * np.cos(low) - x, half_y * np.sin(low) - y)
    return np.copysign(away, np.hypot(x / half_x, y / half_y) - 1.0)


# --- places and flights -------------------------------------------------------------------------


def anywhere(d: int, n: int, seed: int = 0) -> np.ndarray:
    """Places in the box."""
    return np.random.default_rng(seed).random((n, d)) * SIZE[d]


def on_surface(solids: Solids, n: int, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Places on the surfaces, and the normals there."""
    r = anywhere(solids.dimension, 40 * n, seed)
    for _ in range(30):
        _, distance, normal = solids.nearest(r)
        r = r - distance[:, None] * normal
    body, distance, normal = solids.nearest(r)
    good = (body >= 0) & (np.abs(distance) < 1e-10)
    return r[good][:n], normal[good][:n]


@njit
def _meets(solid, r, v, a, time):
    gone, x, u = 0.0, homed(solid, r), v
    for _ in range(1000):
        t, _, term = first_meeting(solid.tables, x, u, a, time - gone, 0, NO_TERM)
        if t > time - gone:
            break
        gone += t
        x, u = fall(x, u, a, t)
        x = homed(solid, x)
        if term != NO_TERM:
            return gone
    return np.inf


def meets(solids: Solids, r: Any, v: Any, a: Any, time: float) -> float:
    """When a flight first meets a solid; infinity if it does not."""
    return _meets(solids.kernel, tuple(r), tuple(v), tuple(a), time)


@njit
def _bounced(physics, number, r, v, a, impulse):
    return bounce(physics, physics.timestep, Counter(1, 1), (number, 1.0), r, v, a, impulse)


class Step(NamedTuple):
    """What a bounce asks of the physics of a step."""

    solid: Any
    timestep: float
    kT: float
    momentum_scale: float


def bounced(solids: Solids, r: Any, v: Any, a: Any, time: float, number: int = 0) -> Any:
    """Place and velocity after a step, and the momentum that the bodies took (bodies, d)."""
    d = solids.dimension
    impulse = np.zeros((len(solids.bodies), d + (1 if d == 2 else 3)), np.int64)
    step = Step(solids.kernel, time, 1.0, SCALE)
    r, v = _bounced(step, number, tuple(r), tuple(v), tuple(a), impulse.ravel())
    return np.array(r), np.array(v), impulse[:, :d] / SCALE
