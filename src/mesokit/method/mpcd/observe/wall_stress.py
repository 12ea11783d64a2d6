"""Force per area on the plates of a slit."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np

from mesokit import theory
from mesokit.case.box import AXES
from mesokit.case.component import component, tag
from mesokit.errors import CaseError
from mesokit.geometry.solids.solids import slit_of
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.molecules import spring_of
from mesokit.method.mpcd.observe.shared.walls import SinceLast, require_counted
from mesokit.seam.engine import RunningFluid
from mesokit.seam.estimate import of_mean
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import Blocks

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.method.mpcd.molecule import Molecule

PLATES = ("lower", "upper")
THIN = 1e-5  # of the height: what lies next to a plate
UNIT = {2: "m/tau^2", 3: "m/(a tau^2)"}  # force per area, by dimension


@component
class WallStress(Observable):
    """Force per area of the fluid on each plate: drag along it, pressure across it."""

    quantity: Literal["wall-stress"] = tag("wall-stress")
    of_built_up_flow: ClassVar[bool] = True
    in_any_flow: ClassVar[tuple[str, ...]] = ("pressure on",)
    at_any_kT: ClassVar[tuple[str, ...]] = ("on both plates",)
    asks_transport: ClassVar[bool] = True
    measures: ClassVar[tuple[str, ...]] = ("walls",)

    def check(self, case: Case) -> None:
        """Raise CaseError without walls, or for a second one: it sees what the first left."""
        if slit_of(case) is None:
            rules = {
                f"wall[#{i + 1}].{side}.rule = 'diffuse'"
                for i, wall in enumerate(case.walls)
                for side, surface in wall.surfaces().items()
                if wall.closed_axes and surface.rule == "diffuse"
            }
            if rules:
                raise CaseError(f"{min(rules)}: not here; for diffuse plates observe 'forces'")
            raise CaseError(
                "wall-stress needs one [[wall]] of shape 'plates', and no other; "
                "for other walls observe 'forces'"
            )
        require_counted(case, self.quantity)


@accumulator_of(WallStress)
class WallStressAccumulator(BlockAccumulator):
    """Mean force per area since the sample before."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "walls")

    def __init__(self, observable: WallStress, case: Case) -> None:
        self.case, self.name = case, observable.label
        plates: Any = case.walls[0]
        self.axis = AXES.index(plates.axis)
        self.area = np.prod(case.box.size) / case.box.size[self.axis]
        d = case.box.dimension
        self.walls = SinceLast(2, d + (1 if d == 2 else 3))
        self.blocks = Blocks((2, d))

    def observe(self, fluid: RunningFluid) -> None:
        taken, steps = self.walls.take(fluid)
        if steps:
            momentum = taken[:, : self.case.box.dimension]
            self.blocks.add(momentum / (steps * self.case.fluid.timestep * self.area))

    def result(self) -> Result:
        """Every component at both plates."""
        expected = self.expected()
        return Result(
            quantity="wall-stress",
            drawing="tensor",
            name=self.name,
            x={"plate": np.array(PLATES), "component": np.array(AXES[: self.case.box.dimension])},
            value=self.blocks.mean(),
            error=self.blocks.error(),
            label="force per area on the plates",
            units={"value": UNIT[self.case.box.dimension]},
            expected=expected,
            theory="momentum balance",
            comparisons=tuple(self.comparisons(expected)) if self.blocks.count else (),
            samples=self.blocks.count,
            extra={"axis": AXES[self.axis]},
        )

    def expected(self) -> Array:
        """(2, d): see `balance`."""
        return balance(self.case)

    def comparisons(self, expected: Array) -> list[Comparison]:
        """Each plate where the fluid pushes it, and the balance of both."""
        force = of_mean(self.blocks)
        found = []
        for axis, letter in enumerate(AXES[: self.case.box.dimension]):
            what = "pressure on" if axis == self.axis else f"drag along {letter} on"
            for plate, name in enumerate(PLATES):
                if expected[plate, axis] != 0:
                    mask = np.zeros(force.value.shape)
                    # a pressure is positive when it pushes outwards
                    mask[plate, axis] = -1 if axis == self.axis and plate == 0 else 1
                    error = force.error[plate, axis]
                    found.append(
                        Comparison(
                            f"{what} the {name} plate",
                            float((mask * force.value).sum()),
                            float(error),
                            float(mask[plate, axis] * expected[plate, axis]),
                            UNIT[self.case.box.dimension],
                        )
                    )
            if axis != self.axis and setting.uniform_acceleration(self.case)[axis]:
                both = force.residuals[:, :, axis].sum(axis=1)
                total = type(force)(force.value[:, axis].sum(), both, force.weights)
                found.append(
                    Comparison(
                        f"drag along {letter} on both plates",
                        float(total.value),
                        float(total.error),
                        float(expected[:, axis].sum()),
                        UNIT[self.case.box.dimension],
                        "the force on the fluid",
                    )
                )
        return found


def balance(case: Case) -> Array:
    """Force per area on both plates of a slit, (2, d): the force on the fluid, shared by the sticky
    plates, Couette drag, pressure."""
    wall: Any = case.walls[0]
    acceleration, d = setting.uniform_acceleration(case), case.box.dimension
    across = AXES.index(wall.axis)
    height, rho = float(case.box.size[across]), setting.mass_density(case)
    sticky = np.array([1.0 * (s.rule == "no-slip") for s in (wall.lower, wall.upper)])
    coefficients = setting.transport(case)
    expected = np.zeros((2, d))
    for axis in range(d):
        if axis == across:
            expected[:, axis] = _pressure(case, acceleration[axis], height)
            continue
        if sticky.any():
            expected[:, axis] = rho * acceleration[axis] * height * sticky / sticky.sum()
        lower, upper = (setting.surface_velocity(s, axis) for s in (wall.lower, wall.upper))
        if sticky.all() and upper != lower:
            eta = coefficients.dynamic_viscosity if coefficients else np.nan
            drag = eta * (upper - lower) / height
            expected[:, axis] += np.array([drag, -drag])
    if case.fluid.force.uniform(d) is None or case.box.sheared:
        expected[:, [axis for axis in range(d) if axis != across]] = np.nan
    return expected


def _pressure(case: Case, weight: float, height: float) -> tuple[float, float]:
    """Ideal gas, heavier at the bottom under a force towards a plate; nan where it heats."""
    kT = case.fluid.kT
    if not setting.at_kT(case):
        return np.nan, np.nan
    if weight == 0:
        pressure = _contact(case, height) * kT
        return -pressure, pressure
    linked = case.fluid.molecule is not None or case.solutes is not None
    if linked or case.fluid.mixed:
        return np.nan, np.nan
    lost = setting.mass_density(case) * weight * height  # between the plates
    upper = lost / -np.expm1(-case.fluid.mass * weight * height / kT)
    return lost - upper, upper


def _contact(case: Case, height: float) -> float:
    """Particles and beads per cell next to a plate: whatever links them, it is they that hit it.

    nan where there is no theory of how molecules lie there.
    """
    fluid, solutes = case.fluid, case.solutes
    around = fluid.density * _at_plate(case, fluid.molecule, height)
    if solutes is None:
        return around
    if solutes.different_pairs or solutes.wall is not None:
        return np.nan
    kinds = [
        polymer.number * polymer.length * _at_plate(case, solutes.molecule(i), height)
        for i, polymer in enumerate(solutes.polymers)
    ]
    return around + sum(kinds) / case.box.volume


def _at_plate(case: Case, molecule: Molecule | None, height: float) -> float:
    """Density of beads at a plate over their mean."""
    if molecule is None:
        return 1.0
    spring = spring_of(molecule)
    if spring is None:
        return np.nan
    edges = height * np.array([0.0, THIN, 1.0 - THIN, 1.0])
    try:
        beads = theory.beads_in_slit(edges, molecule.bonds, (case.fluid.kT / spring.k) ** 0.5)
    except ValueError:  # a grid too fine
        return np.nan
    return float(beads[:, 0].mean())
