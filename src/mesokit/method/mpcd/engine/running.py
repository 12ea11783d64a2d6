"""A fluid in memory that is run, whatever does its steps: the verbs of an engine.

What does the steps has memory of its own: arrays of strips for the threads of a processor
(`engine.cpu`), or those of a device (`engine.cuda`).
"""

from __future__ import annotations

import functools
from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from typing import Any, Concatenate, ParamSpec, TypeVar

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.errors import RunError
from mesokit.method.mpcd.engine.beads.interactions import refuse_broken
from mesokit.method.mpcd.engine.cpu.groups import MEASURE_STRESS, MEASURE_WALLS, Course
from mesokit.method.mpcd.engine.cpu.numbers import Floats, Numbers
from mesokit.method.mpcd.engine.cpu.strips.cell_energy import (
    MOST_PARTICLES,
    ONE_PARTICLE,
    WithCount,
)
from mesokit.method.mpcd.engine.measure.by_pieces import ByPieces
from mesokit.method.mpcd.engine.measure.readings import Readings
from mesokit.method.mpcd.engine.pieces import Piece, of_state, pieces, require_finite
from mesokit.method.mpcd.molecule import Springs
from mesokit.statistics import Tally

P = ParamSpec("P")
T = TypeVar("T")


def _read(
    method: Callable[Concatenate[Any, P], T], of: Callable[[Readings], Any] = lambda one: one
) -> Callable[Concatenate[Running, P], T]:
    """A method of the readings, or of what `of` makes of them, as one of the engine."""

    @functools.wraps(method)
    def read(engine: Running, *given: P.args, **more: P.kwargs) -> T:
        return method(of(engine.readings), *given, **more)

    return read


class Running(ABC):
    """A fluid in memory, its steps, and readings of it.

    Those that run it give it its memory, and say how steps are done, how particles are sorted, and
    what each stage took.
    """

    case: Case
    numbers: Numbers
    memory: Any
    readings: Readings
    solutes: Any
    bodies: Any = None
    n: int
    dimension: int
    box: Floats

    @abstractmethod
    def _steps(self, steps: int, what: int) -> None:
        """Do some steps and the collision of the last; `what` are flags of `groups.Course`."""

    @abstractmethod
    def _sorted(self) -> int:
        """Bring particles into the box, those of one cell together; the most of one cell."""

    @property
    @abstractmethod
    def seconds(self) -> dict[str, float]:
        """Time spent so far in each stage."""

    @property
    def step(self) -> int:
        """Steps done, the warm-up included."""
        return self.memory.step

    @property
    def time(self) -> float:
        """Time since the start of the warm-up."""
        return self.step * self.numbers.timestep

    # --- running --------------------------------------------------------------------------------

    def parts(self, by_first: bool = False) -> Iterator[tuple[int, int]]:
        """Numbers of the particles, from one to before another, that are to be made here.

        Of several ranks each makes its part, or the first of them all.
        """
        return pieces(0, self.n, self.numbers.beads)

    def begin(self, particles: Iterable[tuple[Any, ...]]) -> None:
        """Store the fluid's particles: a `Piece` for each of `parts`."""
        self._take(Piece(*piece) for piece in particles)
        self.sort()

    def _take(self, particles: Iterable[Piece]) -> None:
        """Store these particles, in the order of their numbers."""
        for piece in particles:
            self.memory.put(*piece, first=int(piece.ids[0]) // self.numbers.beads)

    def advance(self, steps: int, measure: Collection[str] = ()) -> None:
        """Run some steps; velocities are then those after the collision of the last."""
        if steps == 0:
            self._advance(0, False)
        while steps > 0:
            every = self.numbers.sort_every
            due = every - self.step % every
            now = min(steps, due)
            self._advance(now, "stress" in measure and now == steps)
            steps -= now
            if now == due:
                self.sort()

    def _advance(self, steps: int, measure_stress: bool) -> None:
        memory = self.memory
        self.readings.forget()
        what = MEASURE_WALLS * ("walls" in memory.measures) + MEASURE_STRESS * measure_stress
        if measure_stress:
            memory.clear_stress()
            if self.solutes is not None:
                self.solutes.state_of.tensor[:] = 0.0
            if self.bodies is not None:
                self.bodies.state_of.tensor[:] = 0
        self._steps(steps, what)
        self.readings.wall_steps += steps
        molecule, springs = self.case.fluid.molecule, memory.physics.molecule
        if molecule is not None and isinstance(springs, Springs):
            advice = (
                f"take more sub-steps than {springs.substeps} (fluid.molecule.substeps), a stiffer "
                "bond, or start from particles that are not so far apart"
            )
            refuse_broken(memory.faults, molecule.bond.longest, "particles", advice)
        if self.solutes is not None:
            self.solutes.check()
        if self.bodies is not None:
            self.bodies.check()
        if measure_stress:
            self.readings.find_stress()

    def _course(self, steps: int, what: int) -> Course:
        memory, case = self.memory, self.case
        return Course(
            steps=steps,
            done=self.step,
            seed=case.run.seed,
            grid_shift=case.fluid.grid_shift,
            closed=tuple(float(shut) for shut in self.numbers.closed),
            flags=what,
            box=memory.box,
            grid=memory.grid,
        )

    def sort(self) -> None:
        """Bring particles back into the box and those of one cell together in memory."""
        self._check_sums(self._sorted())

    def _check_sums(self, crowd: int) -> None:
        """That a cell of so many particles of the fastest kind cannot make its sums overflow."""
        fastest = self.readings.fastest()
        if fastest >= self.numbers.fastest:
            slower = "lower the force or the velocity of the surfaces"
            held = self.case.fluid.thermostat.acts
            reason = f"the fluid heats up: {'' if held else 'add a thermostat, or '}{slower}"
            if self.step == 0:
                reason = "fluid.start: give slower particles"
            raise RunError(
                f"step {self.step}: a particle moves at {fastest:g}, beyond the "
                f"{self.numbers.fastest:g} that cell sums can hold; {reason}"
            )
        heaviest, energy = max(self.numbers.masses_of_kinds), self.numbers.energy
        full = crowd * heaviest * fastest * self.numbers.units["momentum"] > 2.0**61
        if isinstance(energy, WithCount):
            full |= crowd > MOST_PARTICLES
            full |= crowd * heaviest * fastest**2 * energy.scale > ONE_PARTICLE
        if full:
            raise RunError(
                f"step {self.step}: {crowd} particles in one cell, some as fast as {fastest:g}: "
                "more than cell sums can hold"
            )

    def check(self) -> None:
        """Raise RunError if a particle is too fast for the sums of cells."""
        self._check_sums(1)

    def end_warmup(self) -> None:
        """Set the momentum that surfaces took to 0."""
        self.readings.forget_walls()

    # --- its state ------------------------------------------------------------------------------

    def state(self) -> dict[str, Any]:
        """Everything that the next step depends on, by particle number.

        Raises RunError if sums have overflowed.
        """
        self.check()
        return {
            **(self.solutes.state() if self.solutes else {}),
            **(self.bodies.state() if self.bodies else {}),
            **self._state_of_particles(),
            "step": np.int64(self.step),
            **self.readings.state_of_walls(),
            "wall_rates": self.readings.wall_rates(),
        }

    def _state_of_particles(self) -> dict[str, Any]:
        return dict(zip(("positions", "velocities", "images"), self.memory.read(), strict=True))

    def restore(self, state: Mapping[str, NDArray]) -> None:
        """Go on from a state, with the same bits whatever the number of threads was."""
        self._restore(state, self._given(state))

    def _given(self, state: Mapping[str, Any]) -> Iterator[Piece]:
        require_finite(state)
        yield from of_state(state, (self.n, self.dimension), self.numbers.beads)

    def _restore(self, state: Mapping[str, NDArray], particles: Iterable[Piece]) -> None:
        """Go on from these particles, and from all else in a state."""
        self.readings.forget()
        self.memory.clear_faults()
        self._take(particles)
        self.memory.step = int(state["step"])
        self.readings.restore_walls(state)
        self.memory.put_wall_rates(state["wall_rates"])
        if self.solutes is not None:
            self.solutes.restore(dict(state))
        if self.bodies is not None:
            self.bodies.restore(dict(state))

    def balance(self) -> dict[str, Any]:
        """How the work was shared anew while it ran."""
        return {}

    # --- readings for observables ---------------------------------------------------------------

    totals = _read(Readings.totals)
    moments = _read(Readings.moments)
    modes = _read(Readings.modes)
    positions = _read(Readings.positions)
    whole_positions = _read(Readings.whole_positions)
    velocities = _read(Readings.velocities)
    images = _read(Readings.images)
    masses = _read(Readings.masses)
    species = _read(Readings.species)
    spins = _read(Readings.spins)
    orientations = _read(Readings.orientations)
    bonds = _read(Readings.bonds)
    bond_vectors = _read(Readings.bond_vectors)
    sums_of_particles = _read(ByPieces.sums_of_particles, ByPieces)
    sums_of_bonds = _read(ByPieces.sums_of_bonds, ByPieces)
    potential_energy = _read(ByPieces.potential_energy, ByPieces)

    @property
    def stress(self) -> dict[str, Floats]:
        """Stress of the last step, if that was measured, by its parts."""
        return self.readings.stress

    @property
    def wall_impulse(self) -> Floats:
        """Momentum (d) and angular momentum (1 or 3) that each surface took since the warm-up."""
        columns = self.dimension + (1 if self.dimension == 2 else 3)
        return self.readings.wall_tally.value.reshape(-1, columns)

    @property
    def wall_tally(self) -> Tally:
        """Exact sums of `wall_impulse` since the end of the warm-up."""
        return self.readings.wall_tally

    @property
    def wall_steps(self) -> int:
        """Number of steps in `wall_tally`."""
        return self.readings.wall_steps
