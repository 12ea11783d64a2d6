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
    free_diffusion,
    group_of,
    kirkwood,
    modes_of,
    rouse_note,
    spring_of,
    without_solutes,
)
from mesokit.observe.origins import GROUPS, Origins
from mesokit.observe.protocol import Observable, RunningFluid, State, pack, unpack
from mesokit.observe.result import Array, Comparison, Result

if TYPE_CHECKING:
    from mesokit.case import Case

Integers = NDArray[np.int64]


@component
class MeanSquareDisplacement(Observable):
    """Mean square displacement at lags from one sample to `max_lag`, about equally spaced in log.

    Axes along which the fluid flows or that a wall closes are left out unless given. In a fluid of
    molecules whole molecules are followed: all their beads, or their centres of mass.
    """

    quantity: Literal["mean-square-displacement"] = tag("mean-square-displacement")
    of: Literal["particles", "beads", "centres"] = param(
        "particles", doc='"beads": of solutes or molecules; "centres": their centres of mass'
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
        group_of(case, self.of, self.kind)

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
        self.group = group_of(case, observable.of, observable.kind)
        length, number = self.group.length, self.group.number
        if length == 1:
            self.ids = self.group.beads(observable.particles).ravel()
            self.origins = Origins(len(self.ids), len(self.axes), max_lag)
            return
        wanted = observable.particles if self.centres else -(-observable.particles // length)
        followed = min(wanted, number)
        followed -= followed % GROUPS if followed > GROUPS else 0
        # bead after bead, so that one molecule is in one group: its beads are not independent
        self.ids = self.group.beads(followed).T.ravel()
        rows = followed if self.centres else len(self.ids)
        self.origins = Origins(rows, len(self.axes), max_lag, min(GROUPS, followed))

    @property
    def centres(self) -> bool:
        """Whether centres of mass are followed."""
        return self.observable.of == "centres"

    def observe(self, fluid: RunningFluid) -> None:
        """Take one sample."""
        position = fluid.positions(self.ids, unwrapped=True)[:, list(self.axes)]
        if self.centres:
            position = position.reshape(self.group.length, -1, len(self.axes)).mean(axis=0)
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
        curve = None
        comparisons: list[Comparison] = []
        first = self.diffusive_from()
        late = steps * dt >= first if first else steps > 0
        if late.sum() >= 3:
            curve, comparisons = self.fit_diffusion(steps * dt, moved, late)
        return Result(
            quantity="mean-square-displacement",
            name=self.name,
            x={"time": steps * dt},
            value=moved.value,
            error=moved.error,
            label="mean square displacement" + " of centres of mass" * self.centres,
            units={"value": "a^2", "time": "tau"},
            expected=self.expected(steps),
            fit=curve,
            theory=self.legend(),
            comparisons=tuple(comparisons),
            samples=self.origins.count,
            extra={"components": "".join("xyz"[axis] for axis in self.axes)},
        )

    def legend(self) -> str:
        """What the theory is called in a figure."""
        label = setting.chaos_label(self.case)
        return label if self.group.molecule is None else label.replace("molecular chaos", "Rouse")

    @property
    def mass(self) -> float:
        """Of one bead."""
        solutes = self.case.solutes
        if solutes is None or self.observable.of == "particles":
            return self.case.fluid.mass
        return solutes.mass

    def alone(self) -> float | None:
        """Diffusion coefficient of one bead alone; None where what it drags along drags it."""
        of = self.observable.of
        if self.case.solutes is None:
            return free_diffusion(self.case)
        if of == "particles":
            return None
        return free_diffusion(self.case) if self.case.solutes.solvent == "random" else None

    def expected(self, steps: Integers) -> Array | None:
        """Molecular chaos, of molecules Rouse's; None without a theory."""
        fluid, molecule, alone = self.case.fluid, self.group.molecule, self.alone()
        if alone is None or not set(self.axes) <= set(setting.quiet_axes(self.case)):
            return None
        d, dt, kT, mass = len(self.axes), fluid.timestep, fluid.kT, self.mass
        g = theory.decorrelation_from_diffusion(alone, dt, kT, mass)
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

    def diffusive_from(self) -> float:
        """The lag from which on the displacement is a straight line.

        That is when a particle has forgotten its velocity, which it does in m D/kT, and, of
        solutes, when the flow that they had set going has spread over the box; in a molecule, when
        a bead has forgotten where in the molecule it is. What drags beads along in a fluid of
        molecules changes as the molecule turns, so that its centre is in no hurry either.
        """
        alone = free_diffusion(self.case, self.observable.of)
        start = 5 * alone * self.mass / self.case.fluid.kT if alone else 0.0
        solute = self.case.solutes is not None and self.observable.of != "particles"
        if solute:
            start = max(start, self.spreading())
        if self.group.molecule is None:
            return start
        slowest = self.slowest(alone)
        if self.centres:
            return start if solute else max(start, slowest or 0.0)
        return np.inf if slowest is None else max(start, 5 * slowest)

    def spreading(self) -> float:
        """Five times the longest time in which momentum spreads, L^2/(4 pi^2 nu); 0 without one."""
        assert self.case.solutes is not None
        solvent = without_solutes(self.case)
        if self.case.solutes.solvent == "random" or solvent is None:
            return 0.0
        return 5 * max(self.case.box.size) ** 2 / (4 * np.pi**2 * solvent.viscosity)

    def slowest(self, alone: float | None) -> float | None:
        """The longest relaxation time of the molecules, by Rouse's theory; None without one."""
        spring = spring_of(self.group.molecule) if self.group.molecule else None
        if spring is None or alone is None or self.group.molecule is None:
            return None
        friction = self.case.fluid.kT / alone
        times = theory.rouse_times(modes_of(self.group.molecule), friction, K=spring.K)
        return float(times.mode[0])

    def coefficient(self) -> tuple[float, str]:
        """The diffusion coefficient of theory, nan if there is none, and what to say of it."""
        nothing, alone = float("nan"), self.alone()
        note = setting.chaos(self.case, "correlated collisions add 10 to 18 %")
        solutes, molecule = self.case.solutes, self.group.molecule
        if solutes is not None and alone is None:
            if self.observable.of == "particles":
                return nothing, setting.caveat(self.case)
            whole = self.centres or molecule is None
            dragged = kirkwood(self.case, self.observable.kind) if whole else None
            if dragged is None:
                return nothing, "no theory of such beads in a fluid"
            return dragged, "Kirkwood, smeared over cells, less what images of the box take"
        if alone is None:
            return nothing, note
        if molecule is None:
            return alone, "molecular chaos, exact for a bead alone" if solutes else note
        if self.case.walls:
            return nothing, note
        return alone / molecule.length, rouse_note(self.case)

    def fit_diffusion(
        self,
        time: Array,
        moved: Estimate,
        late: NDArray[np.bool_],
    ) -> tuple[Array, list[Comparison]]:
        """Straight line through the late part, weighted by 1/t^2 as the errors grow like t."""
        basis = np.stack([np.ones_like(time), time], axis=1)
        weight = np.where(late, 1 / np.maximum(time, time[late][0]) ** 2, 0)
        line = fit(moved, basis, weight)
        scale = 1 / (2 * len(self.axes))
        value, error = line.scalar(line.value[1] * scale, np.array([0.0, scale]))
        expected, note = self.coefficient()
        what = "diffusion coefficient"
        return np.where(late, basis @ line.value, np.nan), [
            Comparison(what, value, error, expected, "a^2/tau", note)
        ]
