"""Theory of the mean square displacement of particles and molecules."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.case import Case
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.molecules import (
    crowd_note,
    free_diffusion,
    friction_of,
    kirkwood,
    modes_of,
    rouse_note,
    self_diffusion,
    springs_of,
    without_solutes,
)
from mesokit.method.mpcd.expected.selection import group_of, kind_of
from mesokit.method.mpcd.expected.traps import LEVEL, held, trapped
from mesokit.method.mpcd.molecule import FLUID, Molecule

Array = NDArray[np.floating[Any]]
Integers = NDArray[np.int64]


class Displacement:
    """Theory of the mean square displacement of the particles that an observable follows.

    Raises CaseError without an axis or a molecule to follow.
    """

    answers = "mean-square-displacement"

    def __init__(self, case: Case, observable: Any) -> None:
        self.case, self.of = case, observable.of
        self.species = observable.kind if case.fluid.species else None
        if observable.components is None:
            self.axes = setting.quiet_axes(case)
            if not self.axes:
                raise CaseError("components: every axis has a flow or a wall; name those to follow")
        else:
            self.axes = tuple(case.box.index(axis, "components") for axis in observable.components)
            if case.box.sheared and 0 in self.axes:
                raise CaseError("components: not 'x' under shear, whose images slide")
        self.group = group_of(case, self.of, observable.kind)
        self.length, self.number = self.group.length, self.group.number
        self.molecule, self.kind = self.group.molecule, kind_of(case, self.group)
        self.dissolved = case.solutes is not None and self.group.first >= case.particles

    def beads(self, wanted: int) -> Integers:
        """Numbers (molecules, length) of so many molecules, evenly spread, or of all."""
        return self.group.beads(wanted)

    def legend(self) -> str:
        """Name of the theory in a figure."""
        if self.trapped:
            return "level in traps, by Boltzmann"
        if self.ballistic():
            return "free flight"
        in_random_solvent = self.dissolved and self.alone() is not None  # a random solvent
        label = "molecular chaos" if in_random_solvent else setting.chaos_label(self.case)
        return label if self.molecule is None else label.replace("molecular chaos", "Rouse")

    @property
    def mass(self) -> float:
        """Of one bead."""
        solutes = self.case.solutes
        if self.of == "particles" and self.species is not None:
            return self.case.fluid.species[self.species - 1].mass
        if solutes is None or not self.dissolved:
            return self.case.fluid.mass
        return solutes.masses[solutes.index_of(self.kind)]

    def alone(self) -> float | None:
        """Diffusion coefficient of one bead; None where what it drags along drags it."""
        if self.case.solutes is None:
            return free_diffusion(self.case)
        if not self.dissolved:
            return None
        random = self.case.solutes.solvent == "random"
        return free_diffusion(self.case, kind=self.kind) if random else None

    def expected(self, steps: Integers) -> Array | None:
        """Molecular chaos, of molecules Rouse's; None without a theory."""
        fluid, molecule, alone = self.case.fluid, self.molecule, self.alone()
        if self.trapped:
            return self.level(steps * fluid.timestep)
        if self.ballistic():
            return len(self.axes) * fluid.kT / self.mass * (steps * fluid.timestep) ** 2
        if self.dissolved and setting.magnetic(self.case):
            return None
        if alone is None or not set(self.axes) <= set(setting.quiet_axes(self.case)):
            return None
        d, dt, kT, mass = len(self.axes), fluid.timestep, fluid.kT, self.mass
        g = theory.decorrelation_from_diffusion(alone, dt, kT, mass)
        if molecule is None:
            return theory.msd_molecular_chaos(steps, dt, g, d, kT, mass)
        if self.case.walls:
            return None
        if self.of == "centres":
            return theory.msd_molecular_chaos(steps, dt, g, d, kT, mass * molecule.length)
        spring = springs_of(self.case, self.kind)
        if spring is None:
            return None
        modes = modes_of(molecule).eigenvalues
        return theory.msd_rouse_beads(steps, dt, g, modes, spring.k, d, kT, mass)

    @property
    def trapped(self) -> bool:
        """Whether traps hold those that are followed."""
        return self.of != "particles" and trapped(self.case, self.kind)

    def level(self, time: Array) -> Array | None:
        """Twice the variance of places in traps, at lags after which all is forgotten, else nan;
        None where all lags are shorter."""
        found = held(self.case, self.kind)
        if found is None or found.time is None or found.variance is None:
            return None
        late = time >= self.level_from()
        if not late.any():
            return None
        variance = found.centre_variance if self.of == "centres" else float(found.variance.mean())
        return np.where(late, 2 * len(self.axes) * variance, np.nan)

    def with_start(self, error: float, value: float, runs: int) -> float:
        """The error of a number that grows as kT, with what the starts of so many runs add."""
        return setting.with_start(self.case, error, value, runs)

    def grows(self) -> bool:
        """In 2D, where momentum spreads and neither walls nor a random solvent take it."""
        case, rule = self.case, self.case.fluid.collision
        random = self.dissolved and case.solutes is not None and case.solutes.solvent == "random"
        spreads = rule.acts and "momentum" in rule.conserves
        return case.box.dimension == 2 and spreads and not (case.walls or random)

    def level_from(self) -> float:
        """The lag from which on it no longer grows: in traps, if that is known, else inf."""
        found = held(self.case, self.kind) if self.trapped else None
        return np.inf if found is None or found.time is None else LEVEL * found.time

    def ballistic(self) -> bool:
        """Whether they fly freely: nothing to meet, to be bound to, or to fall by."""
        case = self.case
        bound = case.fluid.molecule is not None or self.dissolved
        meets = case.fluid.collision.acts or case.fluid.mixed or case.walls or bound
        return not meets and set(self.axes) <= set(setting.quiet_axes(case))

    def diffusive_from(self) -> float:
        """The lag from which on the displacement is a straight line.

        A velocity decays in m D/kT. For solutes the flow that they stir up must spread over the box
        besides, and molecules of the fluid around them must relax. In a molecule the place of a
        bead in it must be lost. What drags beads along in a fluid of
        molecules changes as the molecule turns, so that its centre is in no hurry either.
        """
        if self.trapped or (not self.case.fluid.collision.acts and self.molecule is None):
            return np.inf  # it never gets far, or keeps its velocity
        alone = free_diffusion(self.case, self.of, self.kind)
        start = 5 * alone * self.mass / self.case.fluid.kT if alone else 0.0
        if self.dissolved:
            around = self.slowest(self.case.fluid.molecule, FLUID) or 0.0
            start = max(start, self.spreading(), 5 * around)
        if self.molecule is None:
            return start
        slowest = self.slowest(self.molecule, self.kind)
        if self.of == "centres":
            return start if self.dissolved else max(start, slowest or 0.0)
        return np.inf if slowest is None else max(start, 5 * slowest)

    def spreading(self) -> float:
        """Five times the longest time in which momentum spreads, L^2/(4 pi^2 nu); 0 without one."""
        assert self.case.solutes is not None
        solvent = without_solutes(self.case)
        if self.case.solutes.solvent == "random" or solvent is None:
            return 0.0
        return 5 * max(self.case.box.size) ** 2 / (4 * np.pi**2 * solvent.viscosity)

    def slowest(self, molecule: Molecule | None, kind: int | str) -> float | None:
        """The longest relaxation time of molecules, by Rouse's theory; None without one."""
        if molecule is None:
            return None
        spring, alone = springs_of(self.case, kind), free_diffusion(self.case, kind=kind)
        if spring is None or alone is None:
            return None
        friction = self.case.fluid.kT / alone
        times = theory.rouse_times(modes_of(molecule), friction, K=spring.K)
        return float(times.mode[0])

    def coefficient(self) -> tuple[float, str]:
        """The diffusion coefficient of theory, nan if there is none, and a note on it."""
        nothing, alone = float("nan"), self.alone()
        note = setting.chaos(self.case, setting.STIRRED)
        solutes, molecule = self.case.solutes, self.molecule
        if self.dissolved and setting.magnetic(self.case):
            return nothing, setting.MAGNETIC
        if solutes is not None and alone is None:
            if not self.dissolved or self.case.fluid.molecule is not None:
                return nothing, setting.caveat(self.case)
            whole = self.of == "centres" or molecule is None
            dragged = kirkwood(self.case, self.kind) if whole else None
            if dragged is None:
                return nothing, "no theory of such beads in a fluid"
            if solutes.solvent_pair is not None:
                return dragged, "approximate: Enskog and Stokes with slip, less what images take"
            note = "Kirkwood, smeared over cells, less what images of the box take"
            if molecule is not None:  # 1 to 9 % lower: docs/validation/polymer_diffusion.md
                return dragged, f"approximate: {note}"
            if crowd_note(self.case, self.kind).startswith("approximate"):
                return dragged, f"approximate: {note}; so many others also make the fluid thicker"
            return dragged, note
        if alone is None:
            return nothing, note
        if molecule is None:
            if solutes is not None:
                return alone, crowd_note(self.case, self.kind)
            return self_diffusion(self.case)
        if self.case.walls:
            return nothing, note
        friction = friction_of(self.case, self.kind)
        if friction is None:
            return nothing, note
        return self.case.fluid.kT / friction / molecule.length, rouse_note(self.case)
