"""The stress of the fluid, kinetic, collisional, of bonds: pressure, and viscosity under shear."""

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit import theory
from mesokit.case.case import Case
from mesokit.case.component import component, option, tag
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.molecules import springs_in
from mesokit.method.mpcd.expected.rheometer import bond_viscosity, shear_note, stress_in_shear
from mesokit.method.mpcd.observe.shared.tensor import TensorAccumulator, kept
from mesokit.observe.shared.short_run import ENOUGH, of_relaxations
from mesokit.seam.engine import RunningFluid
from mesokit.seam.observable import Observable, accumulator_of
from mesokit.seam.result import Array, Comparison, Result, joined

PARTS = ("kinetic", "collisional", "bond")  # the last one of molecules only
ROUSE = "Rouse molecules, beads with the friction of free particles"
CROWD = "approximate: bodies as an ideal gas"
IN_SHEAR, OF_PART = "no theory of such a fluid in shear", "no theory of this part"
# more kinetic stress than of molecular chaos at a mean free path of a tenth of a cell; measured in
# docs/validation/viscosity_rules.md
CARRIED = {2: "30 to 250 %", 3: "10 to 20 %"}
UNIT = {2: "m/tau^2", 3: "m/(a tau^2)"}  # force per area, by dimension


@component
class Stress(Observable):
    """Stress tensor: momentum carried by flying particles, and moved by collisions and bonds.

    Positive under shear, sigma_xy = eta dv_x/dy, so that the pressure is minus its diagonal.
    """

    quantity: Literal["stress"] = tag("stress")
    measures: ClassVar[tuple[str, ...]] = ("stress",)
    drawing = "tensor"
    value_label = "stress"
    every: int = option(default=1, doc="steps between two samples", ge=1, kw_only=True)

    def check(self, case: Case) -> None:
        """Raise CaseError between walls."""
        if case.walls:
            raise CaseError("stress is measured without walls; use wall-stress")


@accumulator_of(Stress)
class StressAccumulator(TensorAccumulator):
    """Block averages of both parts and their sum."""

    def prepare(self) -> None:
        case = self.case
        self.bonded_beads = case.fluid.molecule is not None or case.solutes is not None
        self.given = PARTS[: 3 if self.bonded_beads else 2]
        # numbers per cell of all that carries momentum, and of what moves as one
        self.carriers, self.wholes = setting.carriers(case)
        self.springs = springs_in(case)
        self.parts = (*self.given, "total")
        super().prepare()

    def observe(self, fluid: RunningFluid) -> None:
        parts = [fluid.stress[name] for name in self.given]
        self.blocks.add(np.stack([*parts, sum(parts[1:], parts[0])]))

    def result(self) -> Result:
        theory = "molecular chaos, ideal gas" + (" of molecules" if self.bonded_beads else "")
        if self.case.box.steady_rate and self.bonded() is not None:
            theory = "molecules in shear"
        return self.tensors(theory, value=UNIT[self.case.box.dimension])

    def length(self) -> float:
        samples = self.blocks.count / self.blocks.series
        return samples * self.observable.every * self.case.fluid.timestep

    def short_run(self) -> str:
        """Caveat of a run that is short against the relaxation time of the bonds."""
        slowest = max((float(times.mode[0]) for _, times in self.springs), default=0.0)
        if not 0 < self.length() < ENOUGH * slowest:
            return ""
        return of_relaxations(self.length() / slowest, self.blocks.series)

    def least(self, weight: Array) -> float:
        """Least error of a sum of elements of the stress of bonds, and so of the total, with these
        weights (d, d); 0 in a long run.

        The stress of a mode of springs at rest has the moments of x x/V with a Gaussian x of
        variance kT along each axis, and is forgotten in the stress time.
        """
        if not self.short_run():
            return 0.0
        squares = float((weight**2 + weight * weight.T).sum())
        kept_of_modes = sum(
            number * kept(self.length() / float(stress))
            for number, times in self.springs
            for stress in times.stress
        )
        scale = self.case.fluid.kT / self.case.box.volume
        return scale * float(squares * kept_of_modes / self.blocks.series) ** 0.5

    def summed(self, part: int, weight: Array) -> tuple[float, float]:
        value, error = super().summed(part, weight)
        return value, float(np.maximum(error, self.least(weight) if self.bonds_in(part) else 0.0))

    def bonds_in(self, part: int) -> bool:
        """Whether a part has the stress of bonds in it: that part, and the total."""
        return self.bonded_beads and part % len(self.parts) >= 2

    def errors(self) -> Array:
        found, d = self.blocks.error(), self.case.box.dimension
        if not self.blocks.count or not self.bonded_beads:
            return found
        unit = np.eye(d * d).reshape(d, d, d, d)
        least = np.array([[self.least(element) for element in row] for row in unit])
        found[2:] = np.maximum(found[2:], least)
        return found

    def expected(self) -> Array:
        """Pressure on the diagonal, eta gdot off it; nan where there is no theory."""
        case, d = self.case, self.case.box.dimension
        expected = np.zeros((len(self.parts), d, d))
        known = self.known()
        kT = case.fluid.kT if known else np.nan
        for axis in range(d):
            expected[0, axis, axis] = -self.carriers * kT
            expected[-1, axis, axis] = -self.wholes * kT  # bonds pull as if beads were one
            expected[2:-1, axis, axis] = (self.carriers - self.wholes) * kT
        rate, coefficients = case.box.steady_rate, setting.transport(case)
        if case.fluid.force.acts:
            expected[:] = np.nan
        elif case.box.sheared:
            # the parts and the normal stresses are of higher order in the shear rate
            expected[:, range(d), range(d)] = np.nan
            expected[2:-1] = np.nan
            steady = coefficients and rate
            for part, nu in zip((0, 1, -1), self.viscosities(), strict=True):
                shear = nu * setting.mass_density(case) * rate if steady else np.nan
                expected[part, 0, 1] = expected[part, 1, 0] = shear
            self.put_bonds(expected)
        return expected

    def put_bonds(self, expected: Array) -> None:
        """Of molecules in steady shear: the total, and the part of the bonds."""
        case, d = self.case, self.case.box.dimension
        rate, bonded = case.box.steady_rate, self.bonded()
        if not (rate and self.bonded_beads):
            return
        slow = bond_viscosity(case)
        if slow is not None:
            expected[2, 0, 1] = expected[2, 1, 0] = slow * rate
        if bonded is None:
            return
        expected[-1, 0, 1] = expected[-1, 1, 0] = bonded.viscosity * rate
        if not self.known():
            return
        for axis in range(d):
            stretch = bonded.first if axis == 0 else 0.0
            expected[2, axis, axis] = (self.carriers - self.wholes) * case.fluid.kT + stretch
            expected[-1, axis, axis] = -self.wholes * case.fluid.kT + stretch

    def known(self) -> bool:
        """Whether the pressure is that of an ideal gas of known temperature."""
        case = self.case
        ideal = case.fluid.collision.ideal or not case.fluid.species
        return ideal and setting.at_kT(case)

    def viscosities(self) -> tuple[float, float, float]:
        """Kinetic, collisional and total viscosity of the theory."""
        c = setting.transport(self.case)
        if c is None:
            return np.nan, np.nan, np.nan
        return c.viscosity_kinetic, c.viscosity_collisional, c.viscosity

    def comparisons(self) -> Iterator[Comparison]:
        case = self.case
        mean, error = self.blocks.mean(), self.errors()
        rate = case.box.steady_rate
        if rate:
            scale = setting.mass_density(case) * rate
            less = 100 * (setting.short_flights(case) or 0.03)
            notes = (
                setting.caveat(case),
                setting.chaos(case, f"short flights carry {CARRIED[case.box.dimension]} more"),
                setting.chaos(case, f"in short flights cells hand over up to {less:.0f} % less"),
            )
            for part, name, note in zip(
                (-1, 0, 1), ("viscosity", "kinetic part", "collisional part"), notes, strict=True
            ):
                nu, bonded = self.viscosities()[part], self.bonded()
                if part < 0 and bonded is not None:
                    nu, note = bonded.viscosity / setting.mass_density(case), shear_note(case)
                elif self.bonded_beads:
                    note = IN_SHEAR if part < 0 else OF_PART
                value, spread = mean[part, 0, 1] / scale, error[part, 0, 1] / abs(scale)
                if part < 0 and not note:
                    note = setting.chaos_is_off(case, nu, spread)
                what, note = f"{name} from the stress", self.cautioned(note, part)
                yield Comparison(what, value, spread, nu, "a^2/tau", note)
            if self.bonded_beads:
                yield self.bond_part(scale)
            yield from self.normal_differences()
        # a thermostat of cells takes a part of the shear for heat that is not there
        held = bool(rate) and setting.isothermal(case) and not self.bonded_beads
        warm = (setting.warming(case) or 0.0) * rate**2 if held else 0.0
        ideal = self.wholes * (case.fluid.kT + warm)
        if case.box.sheared and self.bonded_beads:  # stretched bonds pull along the flow
            bonded = self.bonded() if rate else None
            ideal = ideal - bonded.first / case.box.dimension if bonded else np.nan
        d = case.box.dimension
        pressure, spread = self.summed(-1, -np.eye(d) / d)
        spread = setting.with_start(case, spread, ideal, self.blocks.series)
        ideal = ideal if self.known() else np.nan
        note = ""
        if case.box.sheared and self.bonded_beads:
            note = shear_note(case) if np.isfinite(ideal) else IN_SHEAR
        elif ideal * self.flights_in_shear() > 0.5 * spread:
            note = "approximate: of a fluid at rest, to which shear adds its square"
        crowded = np.isfinite(ideal) and setting.moving_bodies(case) > 1
        note = joined(note, CROWD if crowded else "")
        yield Comparison("pressure", pressure, spread, ideal, UNIT[d], self.cautioned(note))

    def flights_in_shear(self) -> float:
        """The share that shear adds to the pressure, by its size: the square of the shear rate
        times the time that velocities are remembered; 0 without shear or a theory."""
        ideal = self.wholes * self.case.fluid.kT
        remembered = self.viscosities()[0] * setting.mass_density(self.case) / ideal
        return float(np.nan_to_num((self.case.box.steady_rate * remembered) ** 2))

    def cautioned(self, note: str, part: int = -1) -> str:
        """A note on a part, and what to say of its error bar."""
        return joined(note, self.short_run() if self.bonds_in(part) else "")

    def bond_part(self, scale: float) -> Comparison:
        """Part of the bonds in the viscosity; `scale` is the mass density times the shear rate."""
        value, error = self.blocks.mean()[2, 0, 1] / scale, self.errors()[2, 0, 1] / scale
        known, expected, note = bond_viscosity(self.case), np.nan, ""
        if known is not None:
            expected = known / setting.mass_density(self.case)
            at_rest = f"approximate: at zero shear rate; {ROUSE}"
            note = shear_note(self.case) if self.bonded() else at_rest
        what, note = "bond part from the stress", self.cautioned(note)
        return Comparison(what, value, abs(error), expected, "a^2/tau", note)

    def bonded(self) -> theory.ShearStress | None:
        """Stress of a sheared fluid of molecules by Rouse's theory."""
        return None if self.case.fluid.molecule is None else stress_in_shear(self.case)

    def normal_differences(self) -> Iterator[Comparison]:
        """First and, in 3D, second normal-stress difference of a sheared fluid."""
        bonded, d = self.bonded(), self.case.box.dimension
        known = (bonded.first, bonded.second) if bonded is not None else (np.nan, np.nan)
        note = self.cautioned(shear_note(self.case) if bonded else "")
        for which, name in enumerate(("first", "second")[: d - 1]):
            weight = np.zeros((d, d))
            weight[which, which], weight[which + 1, which + 1] = 1.0, -1.0
            what, found = f"{name} normal-stress difference", self.summed(-1, weight)
            yield Comparison(what, *found, known[which], UNIT[d], note)
