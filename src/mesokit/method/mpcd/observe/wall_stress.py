"""Force per area on the plates of a slit."""

from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.box import AXES
from mesokit.case.case import Case
from mesokit.case.component import component, tag
from mesokit.errors import CaseError
from mesokit.geometry.solids.solids import slit_of
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.molecules import spring_of
from mesokit.method.mpcd.molecule import Molecule
from mesokit.seam.engine import RunningFluid
from mesokit.seam.estimate import of_mean
from mesokit.seam.observable import BlockAccumulator, Observable, State, accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import Blocks, Tally

PLATES = ("lower", "upper")
THIN = 1e-5  # of the height: what lies next to a plate
UNIT = {2: "m/tau^2", 3: "m/(a tau^2)"}  # force per area, by dimension


def require_counted(case: Case, quantity: str) -> None:
    """Raise CaseError where the momentum that walls take is not counted."""
    if slit_of(case) is not None and case.walls[0].virtual == "top-up":
        raise CaseError(
            f"{quantity} is not counted with virtual = 'top-up' in a slit; use 'extrapolate'"
        )


class SinceLast:
    """Momentum that surfaces (rows, columns) take between one sample and the next."""

    def __init__(self, rows: int, columns: int) -> None:
        self.shape, self.steps = (rows, columns), 0
        self.last = Tally((rows * columns,), 1.0)

    def take(self, fluid: RunningFluid) -> tuple[NDArray[np.float64], int]:
        """Momentum and angular momentum of each, and in how many steps."""
        now, steps = fluid.wall_tally, fluid.wall_steps - self.steps
        taken = now.since(self.last).reshape(self.shape)
        self.last, self.steps = now.copy(), fluid.wall_steps
        return taken, steps

    def state(self) -> State:
        return self.last.state() | {"steps": np.array(self.steps)}

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        self.last.restore(state)
        self.steps = int(state["steps"])


@component
class WallStress(Observable):
    """Force per area of the fluid on each plate: drag along it, pressure across it."""

    quantity: Literal["wall-stress"] = tag("wall-stress")
    of_built_up_flow: ClassVar[bool] = True
    in_any_flow: ClassVar[tuple[str, ...]] = ("pressure on",)
    at_any_kT: ClassVar[tuple[str, ...]] = ("on both plates",)
    asks_transport: ClassVar[bool] = True
    measures: ClassVar[tuple[str, ...]] = ("walls",)
    drawing = "tensor"
    value_label = "force per area on the plates"

    def check(self, case: Case) -> None:
        """Raise CaseError without the two plates of a slit."""
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

    def prepare(self) -> None:
        case = self.case
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
        expected = balance(self.case)
        return self.report(
            {"plate": PLATES, "component": AXES[: self.case.box.dimension]},
            self.blocks,
            self.comparisons(expected),
            units={"value": UNIT[self.case.box.dimension]},
            expected=expected,
            theory="momentum balance",
            extra={"axis": AXES[self.axis]},
        )

    def comparisons(self, expected: Array) -> Iterator[Comparison]:
        force, unit = of_mean(self.blocks), UNIT[self.case.box.dimension]
        for axis, letter in enumerate(AXES[: self.case.box.dimension]):
            what = "pressure on" if axis == self.axis else f"drag along {letter} on"
            for plate, name in enumerate(PLATES):
                if (known := expected[plate, axis]) != 0:
                    # a pressure is positive when it pushes outwards
                    sign = -1 if axis == self.axis and plate == 0 else 1
                    value, error = sign * force.value[plate, axis], force.error[plate, axis]
                    yield Comparison(f"{what} the {name} plate", value, error, sign * known, unit)
            if axis != self.axis and setting.uniform_acceleration(self.case)[axis]:
                both = force.residuals[:, :, axis].sum(axis=1)
                error = float(force._replace(residuals=both).error)
                value, known = force.value[:, axis].sum(), expected[:, axis].sum()
                drag, note = f"drag along {letter} on both plates", "the force on the fluid"
                yield Comparison(drag, value, error, known, unit, note)


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
