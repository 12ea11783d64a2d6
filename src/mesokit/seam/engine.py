"""Protocols of engines: the verbs of a run, and the readings of observables.

An engine holds the state of a simulation in memory and moves it on. Each method of simulation
(`method/`) has one or more of them: an MPCD fluid has one for the threads of a CPU. All
arrays here are in the order of particle numbers, whatever the layout in memory is.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from mesokit.statistics.tally import Tally

Array = NDArray[np.floating]
Integers = NDArray[np.int64]
State = dict[str, NDArray[Any]]


class Clock(Protocol):
    """Step and time of an engine."""

    @property
    def step(self) -> int: ...
    @property
    def time(self) -> float: ...


class Particles(Clock, Protocol):
    """Readings of an engine of particles, for observables and trajectories; d is the dimension.

    `positions` (n, d) lie in the box, or where the particles have really gone to if `unwrapped`;
    `images` (n, d) counts the boxes between the two. `ids` picks some particles (all unless said).
    """

    n: int
    dimension: int
    box: Array

    def positions(self, ids: Integers | None = None, unwrapped: bool = False) -> Array: ...
    def images(self, ids: Integers | None = None) -> NDArray[np.int32]: ...


class Sites(Clock, Protocol):
    """Readings of an engine of a lattice, for observables and trajectories.

    `sites` (n,) are the numbers of their states, of some or all, numbered along the last axis of
    the box first.
    """

    def sites(self, ids: Integers | None = None) -> NDArray[np.integer]: ...


class Interrupted(Exception):
    """A signal has ended `advance` within a step: `state` has what is done of that step, and the
    next `advance` goes on there."""


class Engine(Clock, Protocol):
    """Members of an engine that a simulation uses, whatever it holds."""

    def advance(self, steps: int, measure: Collection[str] = ()) -> None:
        """Run some steps, in compiled code; 0 only loads or compiles it.

        `measure` is what observables need of the last of them (`Observable.measures`), such as
        "stress". Raises RunError where the physics has broken down. An engine whose steps may last
        for minutes may raise Interrupted where `mesokit.processes.signals.heard` is true.
        """

    def check(self) -> None:
        """Raise RunError if the physics has broken down; what `advance` does not see at once."""

    def end_warmup(self) -> None:
        """Forget what was summed up during the warm-up: no observable may see it."""

    def state(self) -> State:
        """All that the next step depends on, as arrays by particle number. Raises RunError."""

    def restore(self, state: State) -> None:
        """Go on from `state()`, to the same bits on any number of threads.

        Raises KeyError, ValueError or IndexError for a state of another case.
        """

    @property
    def seconds(self) -> dict[str, float]:
        """Time spent so far in each stage of the step."""


class Some(Protocol):
    """Some particles of a fluid, whole molecules: numbers (n,), positions in the box, velocities
    and images (n, d), masses (n,). Results for one must not depend on the others."""

    @property
    def ids(self) -> Integers: ...
    @property
    def positions(self) -> Array: ...
    @property
    def velocities(self) -> Array: ...
    @property
    def images(self) -> NDArray[np.int32]: ...
    @property
    def masses(self) -> Array: ...


# bins (m,) of whatever counts, and terms (m,) of each kind to add up in these
Terms = tuple[NDArray[np.integer], Sequence[NDArray[np.number | np.bool_]]]


class RunningFluid(Particles, Protocol):
    """Readings of an engine whose particles are a fluid, for observables.

    `totals` gives number, momentum (d,) and kinetic energy of all particles. `moments` gives
    number, mass (*bins), momentum (d, *bins) and sum of m v^2 (*bins) in equal bins over the
    whole box along `axes`. `modes` gives sum m e^(-i k r) (K,) and sum m v e^(-i k r) (K, d), of
    all or of the particles from number `first` to before `last`.
    `sums_of_particles` gives the sums (kinds of terms, bins) of what a function finds of some
    particles at a time: no process needs to have all. `units` are about as large as a term of each
    kind: sums are exact of terms rounded to 2^-52 of them, and nan where a term is above 2^44. The
    particles are those of the fluid, or from number `first` to before `last`, solutes included.
    `sums_of_bonds` does the same with numbers and vectors of the bonds of a kind, which is given by
    its place in `bond_vectors` and counted from 0.
    `bond_vectors` (bonds, d) lead from the first to the second particle of each bond, in molecules
    of the fluid and then in solutes.
    `whole_positions` are those of whole molecules, each bead next to its first, whatever images
    they lie in: under shear `unwrapped` positions leave out how far images have slid.
    `stress` holds "kinetic", "collisional" and, of molecules, "bond" (d, d) of the last step if an
    observer due at it declares `measures = ("stress",)`. `wall_impulse` (surfaces, d + 1 or d + 3)
    is the momentum and angular momentum given to the lower and the upper plate of a slit, or to
    each body, in the `wall_steps` steps since the warm-up, for `measures = ("walls",)`; and
    `wall_tally` has the same exactly, all in a row.
    """

    def totals(self) -> tuple[int, Array, float]: ...
    def moments(
        self, axes: tuple[int, ...], bins: tuple[int, ...]
    ) -> tuple[Array, Array, Array, Array]: ...
    def modes(
        self, wavevectors: Array, first: int = 0, last: int | None = None
    ) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]: ...
    def sums_of_particles(
        self,
        of: Callable[[Some], Terms],
        bins: int,
        units: Sequence[float],
        first: int = 0,
        last: int | None = None,
    ) -> Array: ...
    def sums_of_bonds(
        self, of: Callable[[Integers, Array], Terms], bins: int, units: Sequence[float], kind: slice
    ) -> Array: ...
    def velocities(self, ids: Integers | None = None) -> Array: ...
    def masses(self, ids: Integers | None = None) -> Array: ...
    def bond_vectors(self) -> Array: ...
    def whole_positions(self, ids: Integers | None = None) -> Array: ...
    def potential_energy(self) -> float: ...
    @property
    def stress(self) -> Mapping[str, Array]: ...
    @property
    def wall_impulse(self) -> Array: ...
    @property
    def wall_tally(self) -> Tally: ...
    @property
    def wall_steps(self) -> int: ...


class RunningSpheres(Particles, Protocol):
    """Readings of an engine of disks or spheres, for observables.

    `totals` and `moments` are as of a fluid, the latter of all or some. `spins` (n,) in 2D or (n,
    3) in 3D are angular velocities; `energies` has "translation", "rotation" and "potential".
    `wall_impulse` (surfaces, d) is the momentum that each surface has taken since the warm-up.
    Beyond that, methods of lasting contacts have `stress`, with "kinetic" and "pair" (d, d); those
    that count losses have `lost`: energy lost since the warm-up to "impact", "friction", "rolling".
    """

    def totals(self) -> tuple[int, Array, float]: ...
    def moments(
        self, axes: tuple[int, ...], bins: tuple[int, ...], ids: Integers | None = None
    ) -> tuple[Array, Array, Array, Array]: ...
    def velocities(self, ids: Integers | None = None) -> Array: ...
    def masses(self, ids: Integers | None = None) -> Array: ...
    def diameters(self, ids: Integers | None = None) -> Array: ...
    def spins(self, ids: Integers | None = None) -> Array: ...
    def energies(self) -> Mapping[str, float]: ...
    @property
    def wall_impulse(self) -> Array: ...


class ContactsNow(Protocol):
    """All contacts at one time: pairs (m, 2) of particle numbers, of a wall -1 less the number of
    its surface; normals (m, d) from the second to the first, forces (m, d) on the first, places
    (m, d) in the box, and gaps (m,). Their parts along normals and surfaces are (m,)."""

    @property
    def pairs(self) -> Integers: ...
    @property
    def normals(self) -> Array: ...
    @property
    def forces(self) -> Array: ...
    @property
    def places(self) -> Array: ...
    @property
    def gaps(self) -> Array: ...
    @property
    def normal_forces(self) -> Array: ...
    @property
    def tangential_forces(self) -> Array: ...
    @property
    def at_walls(self) -> NDArray[np.bool_]: ...


class TouchingSpheres(RunningSpheres, Protocol):
    """One more reading of an engine of spheres whose contacts last."""

    def contacts(self) -> ContactsNow: ...


class CollidingSpheres(RunningSpheres, Protocol):
    """More readings of an engine of event-driven dynamics.

    `collisions` counts since the warm-up those of pairs, those with walls, and how many of them
    were elastic for following too soon; `virial` is the sum of r.dp over those of pairs. For
    `measures = ("free times",)` there are `free_times` between collisions: edges of bins, counts
    (the last of longer ones), and sums of times and of squares.
    """

    @property
    def collisions(self) -> tuple[int, int, int]: ...
    @property
    def virial(self) -> float: ...
    @property
    def free_times(self) -> tuple[Array, Integers, Array]: ...
