"""Small fluids, and what is measured on them, for tests of the laws that they obey."""

from __future__ import annotations

import dataclasses
import functools
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from mesokit.case.box import Box
from mesokit.case.case import Case
from mesokit.case.run import Run
from mesokit.method.mpcd import collision
from mesokit.method.mpcd.engine.cpu.engine import CPU
from mesokit.method.mpcd.field.uniform import Uniform
from mesokit.method.mpcd.fluid import Fluid, Species
from mesokit.method.mpcd.start.fluid import start

COLLIDING = [rule for rule in collision.RULES if rule.acts]
KNOWN = [rule for rule in COLLIDING if rule().in_theory()]  # whose viscosity there is a theory of
SMALL = 0.01  # value of a parameter that a component has no default for


def example(component: type, dimension: int) -> Any:
    """A component with its defaults, and something small where there is none."""
    required = {}
    for field in dataclasses.fields(component):
        # pydantic keeps the default of a field in its own place
        if component.__pydantic_fields__[field.name].is_required():
            if field.name == "file":
                required[field.name] = file_of_a_wave(dimension)
                continue
            if field.name == "of":
                required["of"] = Uniform((0.0, SMALL, *[0.0] * (dimension - 2)))
                continue
            if field.name in ("times", "factors"):  # a ramp over some steps
                required[field.name] = (0.0, 1.0)
                continue
            vector = "tuple" in str(component.__pydantic_fields__[field.name].annotation)
            required[field.name] = (SMALL,) + (0.0,) * (dimension - 1) if vector else SMALL
    return component(**required)


@functools.cache
def file_of_a_wave(dimension: int) -> str:
    """A small force along x that varies along y, at nodes."""
    values = np.zeros((dimension, *(3, 9, 2)[:dimension]))
    values[0] = SMALL * np.sin(np.linspace(0, 2 * np.pi, 9)).reshape((1, 9, 1)[:dimension])
    file = Path(tempfile.mkdtemp()) / "wave.npy"
    np.save(file, values)
    return str(file)


def make_case(
    size=(8, 8), observe=(), walls=(), trajectory=None, seed=1, solutes=None, shear=None,
    shear_rate=0.0, shear_frequency=0.0, bodies=(), **fluid,
) -> Case:  # fmt: skip
    """A case with one step to run; of rules for two species with two that are alike."""
    kinds = fluid["collision"].kinds if "collision" in fluid else None
    if kinds and "species" not in fluid:
        each = fluid.get("density", 10) / kinds
        fluid["species"] = (Species(mass=1, density=each),) * kinds
    return Case(
        run=Run(steps=1, seed=seed),
        box=Box(size, shear_rate=shear_rate, shear_frequency=shear_frequency, shear=shear),
        fluid=Fluid(**fluid),
        solutes=solutes,
        bodies=bodies,
        walls=walls,
        observe=observe,
        trajectory=trajectory,
    )


def make_fluid(size, positions=None, velocities=None, measures=(), threads=1, **parts) -> CPU:
    """A fluid in memory, ready to advance."""
    cpu = CPU(make_case(size, **parts), threads, measures)
    start(cpu, positions, velocities)
    return cpu


def fingerprint(fluid: CPU) -> list:
    """All that can be read of a fluid."""
    number, momentum, energy = fluid.totals()
    bins = fluid.moments((0, 1), (7, 5))
    waves = np.ones((1, fluid.dimension))
    taken = fluid.wall_impulse
    particles = fluid.positions(), fluid.velocities(), fluid.images()
    whole = fluid.positions(unwrapped=True), number, momentum, energy
    return [*particles, *whole, *bins, *fluid.modes(waves), taken]


def assert_same(one, other) -> None:
    """The same bits."""
    for a, b in zip(one, other, strict=True):
        np.testing.assert_array_equal(a, b)


def cells(fluid: CPU) -> np.ndarray:
    """The unshifted cell of each particle, by id."""
    index = np.zeros(fluid.n, int)
    place = np.floor(fluid.positions()).astype(int)
    for k, length in enumerate(fluid.box.astype(int)):
        index = index * length + place[:, k] % length
    return index


def per_cell(index: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Sums over the particles of each cell, (cells, ...)."""
    values = values.reshape(len(index), -1)
    return np.stack([np.bincount(index, weights=column) for column in values.T], axis=1)


def conserved_sums(fluid: CPU, velocities: np.ndarray) -> dict[str, np.ndarray]:
    """What each unshifted cell holds of everything that a collision rule may conserve."""
    index, m = cells(fluid), fluid.masses()[:, None]
    r = fluid.positions() % 1.0 - 0.5
    if fluid.dimension == 2:
        angular = r[:, :1] * velocities[:, 1:] - r[:, 1:] * velocities[:, :1]
    else:
        angular = np.cross(r, velocities)
    return {
        "mass": per_cell(index, m),
        "momentum": per_cell(index, m * velocities),
        "energy": per_cell(index, 0.5 * (m * velocities**2).sum(axis=1)),
        "angular momentum": per_cell(index, m * angular),
    }


def relative_energy(fluid: CPU) -> tuple[np.ndarray, np.ndarray]:
    """Number of particles of each unshifted cell, and kinetic energy about its centre of mass."""
    sums = conserved_sums(fluid, fluid.velocities())
    number = np.bincount(cells(fluid))
    occupied = number > 0
    mass, momentum = sums["mass"][occupied, 0], sums["momentum"][occupied]
    energy = sums["energy"][occupied, 0] - 0.5 * (momentum**2).sum(axis=1) / mass
    return number[occupied], energy


@dataclasses.dataclass(frozen=True)
class Measured:
    """A number and its standard error."""

    value: float
    error: float

    def agrees(self, expected: float, systematic: float = 0.0, sigmas: float = 3.5) -> bool:
        """Within so many standard errors, plus a systematic deviation relative to the expected."""
        return abs(self.value - expected) <= sigmas * self.error + systematic * abs(expected)

    def __str__(self) -> str:
        return f"{self.value:.5g} +- {self.error:.2g}"


def mean(samples) -> Measured:
    """Mean of independent samples."""
    samples = np.asarray(samples, float)
    return Measured(samples.mean(), samples.std(ddof=1) / np.sqrt(len(samples)))


def shear_viscosity(
    length, amplitude=0.5, drift=0.0, runs=3, decays=2.5, viscosity=0.8, every=5, **parts
) -> Measured:
    """Viscosity from the decay of a helical shear wave in a cube.

    The velocity (cos ky, 0, sin ky) has the same energy everywhere, so that it heats evenly, and
    decays as exp(-nu k^2 t) without any nonlinear term. Each of its two modes is an
    autoregressive process driven by thermal noise; the decay is its maximum-likelihood estimate,
    whose error the noise of equipartition gives. `drift` moves the whole fluid along y.
    """
    k = 2 * np.pi / length
    products = squares = 0.0
    for seed in range(1, runs + 1):
        fluid = make_fluid((length,) * 3, seed=seed, **parts)
        r, v = fluid.positions(), fluid.velocities()
        v[:, 0] += amplitude * np.cos(k * r[:, 1])
        v[:, 2] += amplitude * np.sin(k * r[:, 1])
        v[:, 1] += drift
        start(fluid, r, v)
        steps = int(decays / (viscosity * k * k * fluid.numbers.timestep))
        fluid.advance(10)  # until the stress has grown to its steady value
        modes = []
        for _ in range(steps // every):
            _, momentum = fluid.modes(np.array([[0.0, k, 0.0]]))
            phase = np.exp(1j * k * drift * fluid.time)
            modes.append(momentum[0, [0, 2]] * phase / fluid.n)
            fluid.advance(every)
        x = np.array(modes)
        products += np.sum((x[1:] * x[:-1].conj()).real)
        squares += np.sum(abs(x[:-1]) ** 2)
    kept = products / squares
    noise = (1 - kept**2) * parts.get("kT", 1.0) / (2 * fluid.n)  # of the part along x
    elapsed = every * fluid.numbers.timestep * k * k
    return Measured(-np.log(kept) / elapsed, np.sqrt(noise / squares) / kept / elapsed)
