"""Base of the engines of spheres, with the readings for observables."""

from abc import abstractmethod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.method.spheres.common.made import made
from mesokit.method.spheres.common.start.first_state import Started
from mesokit.seam.engine import Array, Integers, State


class SphereEngine:
    """Base of the engines of spheres: `system` holds and moves them, subclasses read it.

    `made` has their diameters and masses by particle number; `n` spheres in `dimension` axes; `box`
    lengths (d,); `step` counts from the start of the warm-up.
    """

    system: Any
    timestep: float

    def __init__(self, case: Case) -> None:
        self.case, self.made, self.step = case, made(case), 0
        self.n, self.dimension = len(self.made.diameters), case.box.dimension
        self.box = np.array(case.box.size, float)

    @abstractmethod
    def _system(self) -> Any:
        """The memory and loops for the spheres in `made`."""

    def start(self, placed: Started) -> None:
        """Put the spheres where they start from."""
        if placed.diameters is not None:
            ratio, d = placed.diameters / self.made.diameters, self.dimension
            masses, inertia = self.made.masses * ratio**d, self.made.inertia * ratio ** (d + 2)
            self.made = self.made._replace(
                diameters=placed.diameters, masses=masses, inertia=inertia
            )
            self.system = self._system()
        self.system.fill(placed.positions, placed.velocities, placed.spins)

    @property
    def time(self) -> float:
        """Time since the start of the warm-up."""
        return self.step * self.timestep

    # --- readings of observables ----------------------------------------------------------------

    @abstractmethod
    def positions(self, ids: Integers | None = None, unwrapped: bool = False) -> Array:
        """Places (n, d), in the box or where the spheres have gone to."""

    @abstractmethod
    def images(self, ids: Integers | None = None) -> NDArray[np.int32]:
        """Image counts (n, d) of the spheres."""

    @abstractmethod
    def velocities(self, ids: Integers | None = None) -> Array:
        """Velocities (n, d)."""

    @abstractmethod
    def spins(self, ids: Integers | None = None) -> Array:
        """Angular velocities, (n,) in 2D and (n, 3) in 3D."""

    def masses(self, ids: Integers | None = None) -> Array:
        """Masses (n,)."""
        return self.made.masses if ids is None else self.made.masses[ids]

    def diameters(self, ids: Integers | None = None) -> Array:
        """Diameters (n,)."""
        return self.made.diameters if ids is None else self.made.diameters[ids]

    def totals(self) -> tuple[int, Array, float]:
        """Number, momentum (d,) and kinetic energy of translation."""
        v = self.velocities()
        kinetic = 0.5 * float(self.made.masses @ (v * v).sum(axis=1))
        return self.n, self.made.masses @ v, kinetic

    def energies(self) -> dict[str, float]:
        """Kinetic energy of translation and of rotation; "potential": of pairs, walls and gravity;
        "contact": of these the pairs and walls alone."""
        spins, contact = self.spins().reshape(self.n, -1), self.potential_energy()
        gravity = np.array(self.case.spheres.gravity or (0.0,) * self.dimension)
        places = self.positions(unwrapped=True)
        return {
            "translation": self.totals()[2],
            "rotation": 0.5 * float(self.made.inertia @ (spins * spins).sum(axis=1)),
            "potential": contact - float(self.made.masses @ (places @ gravity)),
            "contact": contact,
        }

    def logged(self) -> dict[str, float]:
        """Numbers that the log of a run may have, by name."""
        return self.energies()

    @abstractmethod
    def potential_energy(self) -> float:
        """Energy of pairs and walls."""

    def moments(
        self, axes: tuple[int, ...], bins: tuple[int, ...], ids: Integers | None = None
    ) -> tuple[Array, Array, Array, Array]:
        """Number and mass (*bins), momentum (d, *bins) and sum of m v^2 (*bins) of some spheres
        (all unless said), in equal bins over the whole box along `axes`."""
        number = np.array(bins)
        places = self.positions(ids)[:, list(axes)] / self.box[list(axes)]
        cell = np.clip(np.floor(places * number), 0, number - 1).astype(np.int64)
        at, size = np.ravel_multi_index(tuple(cell.T), bins), int(number.prod())
        v, m = self.velocities(ids), self.masses(ids)

        def summed(values: Array) -> Array:
            return np.asarray(np.bincount(at, values, size).reshape(bins), float)

        momentum = np.stack([summed(m * column) for column in v.T])
        return summed(np.ones(len(at))), summed(m), momentum, summed(m * (v * v).sum(axis=1))

    # --- checkpoints ----------------------------------------------------------------------------

    def state(self) -> State:
        """All arrays that the next step depends on, by particle number."""
        return {**self.system.state(), "step": np.array(self.step)}

    def restore(self, state: State) -> None:
        """Continue from a state."""
        self.system.restore({name: array for name, array in state.items() if name != "step"})
        self.step = int(state["step"])
