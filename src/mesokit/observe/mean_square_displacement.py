"""Mean square displacement of particles or of molecules, and their diffusion coefficient."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.box import Axis
from mesokit.component import component, param, tag
from mesokit.errors import CaseError
from mesokit.observe import setting
from mesokit.observe.estimate import Estimate, fit
from mesokit.observe.molecules import (
    KIND,
    beads_of,
    friction_of,
    modes_of,
    molecule_of,
    rouse_times_of,
    spring_of,
)
from mesokit.observe.origins import GROUPS, Origins, spread_ids
from mesokit.observe.protocol import Observable, RunningFluid, State, pack, unpack
from mesokit.observe.result import Array, Comparison, Result

if TYPE_CHECKING:
    from mesokit.case import Case
    from mesokit.mpcd.molecule import Molecule

Integers = NDArray[np.int64]


@component
class MeanSquareDisplacement(Observable):
    """Mean square displacement at lags from one sample to `max_lag`, about equally spaced in log.

    Axes along which the fluid flows or that a wall closes are left out unless given. In a fluid of
    molecules whole molecules are followed: all their beads, or their centres of mass.
    """

    quantity: Literal["mean-square-displacement"] = tag("mean-square-displacement")
    of: Literal["particles", "centres"] = param(
        "particles", doc='"centres": centres of mass of molecules'
    )
    kind: int = param(1, doc=KIND, ge=1)
    particles: int = param(2000, doc="particles (or molecules) followed", ge=1)
    max_lag: int = param(1000, doc="longest lag", unit="steps", ge=1)
    components: tuple[Axis, ...] | None = param(
        None, doc="axes that count (all without flow and walls unless said)", min_length=1
    )

    def axes(self, case: Case) -> tuple[int, ...]:
        """The axes that count. Raises CaseError if there is none, or if images slide along one."""
        if self.components is None:
            axes = setting.quiet_axes(case)
            if not axes:
                raise CaseError("components: every axis has a flow or a wall; name those to follow")
            return axes
        axes = tuple(setting.axis_index(case, axis, "components") for axis in self.components)
        if case.box.shear_rate and 0 in axes:
            raise CaseError("components: not 'x' under box.shear_rate, whose images slide")
        return axes

    def check(self, case: Case) -> None:
        """Raise CaseError without an axis or a molecule to follow."""
        self.axes(case)
        self.molecule(case)

    def molecule(self, case: Case) -> Molecule | None:
        """What is followed whole; None for single particles. Raises CaseError if there is none."""
        alone = case.fluid.molecule is None and case.particles > 0
        if self.of == "particles" and alone:
            return None
        return molecule_of(case, f"of = '{self.of}'", self.kind)

    def accumulator(self, case: Case) -> MeanSquareDisplacementAccumulator:
        """An empty memory for it."""
        return MeanSquareDisplacementAccumulator(self, case)


def _square_distance(old: Array, new: Array) -> Array:
    difference = new - old
    return np.einsum("ij,ij->i", difference, difference)


class MeanSquareDisplacementAccumulator:
    """Unwrapped positions at many origins."""

    def __init__(self, observable: MeanSquareDisplacement, case: Case) -> None:
        self.observable, self.case, self.name = observable, case, observable.label
        self.axes = observable.axes(case)
        max_lag = max(1, observable.max_lag // observable.every)
        self.molecule = observable.molecule(case)
        if self.molecule is None:
            self.ids = spread_ids(observable.particles, case.particles)
            self.origins = Origins(len(self.ids), len(self.axes), max_lag)
            return
        length = self.molecule.length
        wanted = observable.particles if self.centres else -(-observable.particles // length)
        followed = min(wanted, len(beads_of(case, kind=observable.kind)))
        followed -= followed % GROUPS if followed > GROUPS else 0
        # bead after bead, so that one molecule is in one group: its beads are not independent
        self.ids = beads_of(case, followed, observable.kind).T.ravel()
        rows = followed if self.centres else len(self.ids)
        self.origins = Origins(rows, len(self.axes), max_lag, min(GROUPS, followed))

    @property
    def centres(self) -> bool:
        """Whether centres of mass are followed."""
        return self.observable.of == "centres"

    def observe(self, fluid: RunningFluid) -> None:
        """Take one sample."""
        position = fluid.positions(self.ids, unwrapped=True)[:, list(self.axes)]
        if self.centres and self.molecule is not None:
            position = position.reshape(self.molecule.length, -1, len(self.axes)).mean(axis=0)
        self.origins.add(position, _square_distance)

    def state(self) -> State:
        """All it has to remember."""
        return pack(origins=self.origins)

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Go on from `state()`."""
        self.origins.restore(unpack(state, "origins"))

    def result(self) -> Result:
        """The curve and the slope of its late part."""
        steps = self.origins.sampled() * self.observable.every
        moved = self.origins.estimate()
        dt = self.case.fluid.timestep
        diffusion = self.bead_diffusion()
        curve = None
        comparisons: list[Comparison] = []
        first = self.diffusive_from(diffusion)
        late = steps * dt >= first if first else steps > 0
        if late.sum() >= 3:
            curve, comparisons = self.fit_diffusion(steps * dt, moved, late, diffusion)
        return Result(
            quantity="mean-square-displacement",
            name=self.name,
            x={"time": steps * dt},
            value=moved.value,
            error=moved.error,
            label="mean square displacement" + " of centres of mass" * self.centres,
            units={"value": "a^2", "time": "tau"},
            expected=self.expected(steps, diffusion),
            fit=curve,
            theory=self.legend(),
            comparisons=tuple(comparisons),
            samples=self.origins.count,
            extra={"components": "".join("xyz"[axis] for axis in self.axes)},
        )

    def legend(self) -> str:
        """What the theory is called in a figure."""
        label = setting.chaos_label(self.case)
        return label if self.molecule is None else label.replace("molecular chaos", "Rouse")

    @property
    def mass(self) -> float:
        """Of a particle that is followed, or of a bead."""
        solutes = self.case.solutes
        return self.case.fluid.mass if self.molecule is None or solutes is None else solutes.mass

    def bead_diffusion(self) -> float | None:
        """Diffusion coefficient of a particle, or of a bead alone; None without a theory."""
        if self.molecule is None:
            coefficients = setting.transport(self.case)
            return None if coefficients is None else coefficients.diffusion
        friction = friction_of(self.case)
        return None if friction is None else self.case.fluid.kT / friction

    def expected(self, steps: Integers, diffusion: float | None) -> Array | None:
        """Molecular chaos, of molecules Rouse's; None without a theory."""
        fluid, molecule = self.case.fluid, self.molecule
        if diffusion is None or not set(self.axes) <= set(setting.quiet_axes(self.case)):
            return None
        d, dt, kT, mass = len(self.axes), fluid.timestep, fluid.kT, self.mass
        g = theory.decorrelation_from_diffusion(diffusion, dt, kT, mass)
        if molecule is None:
            return theory.msd_molecular_chaos(steps, dt, g, d, kT, mass)
        if self.case.walls:
            return None
        if self.centres:
            return theory.msd_molecular_chaos(steps, dt, g, d, kT, mass * molecule.length)
        spring = spring_of(molecule)
        if spring is None:
            return None
        modes = modes_of(molecule).eigenvalues
        return theory.msd_rouse_beads(steps, dt, g, modes, spring.k, d, kT, mass)

    def diffusive_from(self, diffusion: float | None) -> float:
        """The lag from which on the displacement is a straight line.

        That is when a particle has forgotten its velocity, which it does in m D/kT; in a molecule,
        when a bead has forgotten where in the molecule it is. What drags beads along changes as
        the molecule turns, so that its centre is in no hurry either.
        """
        inertia = 5 * diffusion * self.mass / self.case.fluid.kT if diffusion else 0.0
        if self.molecule is None:
            return inertia
        times = rouse_times_of(self.case, self.observable.kind)
        if self.centres:
            return inertia if times is None else max(inertia, float(times.mode[0]))
        return np.inf if times is None else max(inertia, 5 * float(times.mode[0]))

    def fit_diffusion(
        self, time: Array, moved: Estimate, late: NDArray[np.bool_], diffusion: float | None
    ) -> tuple[Array, list[Comparison]]:
        """Straight line through the late part, weighted by 1/t^2 as the errors grow like t."""
        basis = np.stack([np.ones_like(time), time], axis=1)
        weight = np.where(late, 1 / np.maximum(time, time[late][0]) ** 2, 0)
        line = fit(moved, basis, weight)
        scale = 1 / (2 * len(self.axes))
        value, error = line.scalar(line.value[1] * scale, np.array([0.0, scale]))
        expected = np.nan if diffusion is None else diffusion
        note = setting.chaos(self.case, "correlated collisions add 10 to 18 %")
        if self.molecule is not None:
            expected /= np.nan if self.case.walls else self.molecule.length
            note = "Rouse; beads with the friction of free particles"
            if setting.mean_free_path(self.case) < 1 and self.case.particles:
                note = "approximate: Rouse; beads drag one another along"
        what = "diffusion coefficient"
        return np.where(late, basis @ line.value, np.nan), [
            Comparison(what, value, error, expected, "a^2/tau", note)
        ]
