"""A NumPy fluid with known physics that answers what observers may ask."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from mesokit import Disk, Harmonic, Plates, Sphere, Uniform
from mesokit.errors import CaseError
from mesokit.geometry.solids.solids import solids_of
from mesokit.method.mpcd.body.disk import DiskBody
from mesokit.method.mpcd.body.sphere import SphereBody
from mesokit.method.mpcd.fluid import Species
from mesokit.method.mpcd.molecule import Molecule
from mesokit.statistics import Tally
from tests.helpers.whole_fluid import AtOnce

FINE = 2.0**40  # whole numbers in a unit of momentum
TWO = (Species(1.0, 3.0), Species(4.0, 2.0))


def case_for(observable, make_case, size, **fluid):
    """A case in which it can be measured: without walls, in a slit, in a flow about a body, in a
    shear that oscillates, in a fluid of molecules, also between plates, of two species, or with
    bodies that move."""
    middle = [length / 2 for length in size]
    body = Disk(centre=middle, radius=1) if len(size) == 2 else Sphere(centre=middle, radius=1)
    push = {"force": Uniform((0.01,) + (0.0,) * (len(size) - 1))}
    shear = {"shear_rate": 0.01, "shear_frequency": 1.0}
    alone = {key: value for key, value in fluid.items() if key != "species"}
    pairs = {"density": 9, "molecule": Molecule(bond=Harmonic(K=1.0))} | alone
    for walls, parts in (
        ((), fluid), ((Plates(axis="y"),), fluid), ((body,), push | fluid), ((), shear | fluid),
        ((), pairs), ((Plates(axis="y"),), pairs), ((), fluid | {"species": TWO}),
    ):  # fmt: skip
        try:
            return make_case(size, [observable], walls=walls, **parts)
        except CaseError:
            pass  # another may do
    wide = [max(length, 6) for length in size]
    return make_case(wide, [observable], bodies=(moving_body(size),), **alone)


def moving_body(size):
    """Two small disks or spheres that move in a box of this size."""
    return (DiskBody if len(size) == 2 else SphereBody)(
        radius=0.5, mass=20, number=2, virtual="none"
    )


class FakeBodies:
    """Bodies whose velocities are new at each reading, and which go far."""

    def __init__(self, case, rng):
        groups = [group for group in case.groups if group.name == "bodies"]
        kinds = [kind for group in groups for kind in group.kinds]
        self.masses = np.repeat([kind.mass for kind in kinds], [kind.number for kind in kinds])
        self.number, self.dimension, self.rng = len(self.masses), case.box.dimension, rng

    def _noise(self, columns):
        return self.rng.normal(size=(self.number, columns))

    def places(self, unwrapped=False):
        return self._noise(self.dimension)

    def in_own_frame(self, vectors):
        return vectors

    def counts(self):
        return {"second hits": 1, "put back": 0, "still hitting": 0}

    def motion(self):
        return np.append(np.zeros(self.dimension), 2.0)

    velocities = property(lambda self: self._noise(self.dimension))
    headings = forces = velocities
    spins = angles = torques = property(lambda self: self._noise(3))


def taken(case, rng):
    """Noise for what the surfaces take: momentum and angular momentum of each."""
    columns = 3 if case.box.dimension == 2 else 6
    return rng.normal(size=(len(solids_of(case).bodies) if case.walls else 2, columns))


class FakeFluid(AtOnce):
    """Independent particles, thermal about a given flow; velocities keep a share each step.

    `flow` is v_x(y), or with `field` the velocity (n, d) at places (n, d). Particles stay out of
    the solids of the case if there is a `field`.
    """

    def __init__(
        self, case, seed=1, flow: Callable | None = None, kept=0.0, density=None, field=None
    ):
        self.case, self.rng, self.flow, self.kept = case, np.random.default_rng(seed), flow, kept
        self.field = field
        self.box = np.array(case.box.size, float)
        self.dimension, self.n = len(self.box), case.particles
        self.step, self.timestep = 0, case.fluid.timestep
        self.m = np.full(self.n, case.fluid.mass)
        self.thermal = self._noise()
        self.unwrapped = self._places()
        self.density = density  # along y, drawn by rejection at every step
        self.stress = {}
        self.wall_tally, self.wall_steps = None, 0
        self.bodies = FakeBodies(case, np.random.default_rng(seed)) if case.bodies else None

    def hit_walls(self, impulse, steps):
        """Let the walls take momentum (surfaces, d + 1 or d + 3) in so many steps."""
        if self.wall_tally is None:
            self.wall_tally = Tally((np.size(impulse),), FINE)
        self.wall_tally.add(np.rint(FINE * np.ravel(impulse)).astype(np.int64))
        self.wall_steps += steps

    @property
    def time(self):
        return self.step * self.timestep

    def _places(self):
        places = self.rng.random((2 * self.n, self.dimension)) * self.box
        if self.field is not None and self.case.walls:
            places = places[solids_of(self.case).distance(places) > 0]
            while len(places) < self.n:
                places = np.concatenate([places, places[: self.n // 2]])
        return places[: self.n]

    def _noise(self):
        scale = np.sqrt(self.case.fluid.kT / self.m)[:, None]
        return scale * self.rng.normal(size=(self.n, self.dimension))

    def advance(self, steps=1):
        """Fly, then keep a share of the velocity: molecular chaos with 1 - g = kept."""
        for _ in range(steps):
            self.unwrapped = self.unwrapped + self.timestep * self.thermal
            self.thermal = self.kept * self.thermal + np.sqrt(1 - self.kept**2) * self._noise()
            self.step += 1

    def jump(self, steps=1):
        """Forget everything: a new equilibrium state."""
        self.thermal = self._noise()
        self.unwrapped = self._places()
        self.step += steps

    def positions(self, ids=None, unwrapped=False):
        x = self.unwrapped if ids is None else self.unwrapped[ids]
        return x.copy() if unwrapped else x % self.box

    def images(self, ids=None):
        x = self.unwrapped if ids is None else self.unwrapped[ids]
        return np.floor(x / self.box).astype(np.int64)

    def velocities(self, ids=None):
        v = self.thermal.copy()
        if self.field is not None:
            v += self.field(self.positions())
        if self.flow is not None:
            v[:, 0] += self.flow(self.positions()[:, 1])
        return v if ids is None else v[ids]

    def masses(self, ids=None):
        return self.m if ids is None else self.m[ids]

    def bond_vectors(self):
        return np.sqrt(0.5) * self.rng.normal(size=(self.n // 2, self.dimension))

    def whole_positions(self, ids=None):
        return self.positions(ids, unwrapped=True)

    def potential_energy(self):
        return float(self.rng.normal(self.n))

    def totals(self):
        v = self.velocities()
        return (
            self.n,
            (self.m[:, None] * v).sum(axis=0),
            0.5 * float((self.m[:, None] * v**2).sum()),
        )

    def moments(self, axes, bins):
        x, v = self.positions(), self.velocities()
        where = [
            np.minimum((x[:, a] / self.box[a] * n).astype(int), n - 1)
            for a, n in zip(axes, bins, strict=True)
        ]
        flat = np.ravel_multi_index(where, bins)

        def total(weights):
            return np.bincount(flat, weights, np.prod(bins)).reshape(bins)

        momentum = np.stack([total(self.m * v[:, a]) for a in range(self.dimension)])
        energy = total(self.m * (v**2).sum(axis=1))
        return total(np.ones(self.n)), total(self.m), momentum, energy

    def modes(self, wavevectors, first=0, last=None):
        ids = np.arange(first, self.n if last is None else last)
        angle = self.positions(ids) @ np.asarray(wavevectors).T
        phase = np.cos(angle) - 1j * np.sin(angle)  # in half the time of a complex exponential
        return self.m[ids] @ phase, phase.T @ (self.m[ids, None] * self.velocities(ids))


class FakeWaves:
    """Modes that obey linear fluctuating hydrodynamics exactly, and nothing else."""

    def __init__(self, case, wavevectors, viscosity, speed, attenuation, interval, seed=1):
        self.rng, self.k = np.random.default_rng(seed), np.asarray(wavevectors)
        length = np.linalg.norm(self.k, axis=1)
        self.unit = self.k / length[:, None]
        self.total = case.fluid.density * case.fluid.mass * np.prod(case.box.size) * case.fluid.kT
        self.kept = np.exp(-viscosity * length**2 * interval)
        # longitudinal: (density, momentum) as a damped oscillator, propagated exactly
        self.flow, self.noise = [], []
        for q in length:
            matrix = np.array([[0, -1j * speed * q], [-1j * speed * q, -attenuation * q * q]])
            values, vectors = np.linalg.eig(matrix)
            step = vectors @ np.diag(np.exp(values * interval)) @ np.linalg.inv(vectors)
            self.flow.append(step)
            covariance = np.eye(2) - step @ step.conj().T
            self.noise.append(np.linalg.cholesky(covariance + 1e-14 * np.eye(2)))
        self.across = self._complex(self.k.shape)
        self.along = self._complex((len(self.k), 2))

    def _complex(self, shape):
        return (self.rng.normal(size=shape) + 1j * self.rng.normal(size=shape)) / np.sqrt(2)

    def advance(self):
        noise = self._complex(self.k.shape)
        self.across = (
            self.kept[:, None] * self.across + np.sqrt(1 - self.kept[:, None] ** 2) * noise
        )
        fresh = self._complex((len(self.k), 2))
        every = zip(self.flow, self.along, self.noise, fresh, strict=True)
        self.along = np.array([a @ s + n @ f for a, s, n, f in every])

    def modes(self, wavevectors):
        assert np.allclose(wavevectors, self.k)
        across = self.across - (self.across * self.unit).sum(axis=1, keepdims=True) * self.unit
        momentum = across + self.along[:, 1:] * self.unit
        return self.along[:, 0], momentum * np.sqrt(self.total)
