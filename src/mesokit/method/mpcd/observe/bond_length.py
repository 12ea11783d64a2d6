"""Length and direction of the bonds of molecules."""

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.molecules import bond_at_rest
from mesokit.method.mpcd.expected.rheometer import bonds_in_shear, shear_note
from mesokit.method.mpcd.expected.selection import KIND, bonds_of, group_of, molecule_of, of_fluid
from mesokit.method.mpcd.observe.shared.tensor import MoleculeTensorAccumulator
from mesokit.seam.engine import RunningFluid, Terms
from mesokit.seam.observable import Observable, accumulator_of
from mesokit.seam.result import Array, Comparison, Result, joined


@component
class BondLength(Observable):
    """Mean of the products of the components of bonds; their sum is the mean square bond length."""

    quantity: Literal["bond-length"] = tag("bond-length")
    needs_fluid: ClassVar[bool] = False
    drawing = "tensor"
    value_label = "products of bond components"
    units: ClassVar[dict[str, str]] = {"value": "a^2"}
    kind: int | str = param(1, doc=KIND)

    def check(self, case: Case) -> None:
        """Raise CaseError for a fluid without bonds."""
        molecule_of(case, self.quantity, self.kind)


@accumulator_of(BondLength)
class BondLengthAccumulator(MoleculeTensorAccumulator):
    """Block averages of the products."""

    def prepare(self) -> None:
        case, kind = self.case, self.observable.kind
        self.molecules = group_of(case, "beads", kind).number
        self.prepare_for(("bonds",), self.molecules)
        self.molecule, self.bonds = molecule_of(case, kind=kind), bonds_of(case, kind)

    def observe(self, fluid: RunningFluid) -> None:
        d, bonds = self.case.box.dimension, self.bonds.stop - self.bonds.start
        units = [1.0] * (2 * d * d + 1)
        sums = fluid.sums_of_bonds(self.products, self.own.groups, units, self.bonds)
        products, (*elements, traces) = sums[: d * d], sums[d * d :].sum(axis=1) / bonds
        self.note_sums(products.T * (self.molecules / bonds), self.molecules)
        self.note_squares(np.reshape(elements, (1, d, d)), np.array([traces]), bonds)

    def products(self, numbers: NDArray[np.int64], separation: Array) -> Terms:
        """Groups of molecules of some bonds; products of their components, their squares, and those
        of their square lengths."""
        molecule = numbers // ((self.bonds.stop - self.bonds.start) // self.molecules)
        axes = separation.T
        products = [one * other for one in axes for other in axes]
        squares = [product**2 for product in products]
        return self.own.group_of(molecule), [*products, *squares, (separation**2).sum(axis=1) ** 2]

    def result(self) -> Result:
        at_rest = self.in_shear() is None
        law = "Boltzmann's distribution of a bond at rest" if at_rest else "molecules in shear"
        return self.tensors(law)

    def square(self) -> float:
        """Mean square length; nan in flow, beside walls or bodies, where other beads matter."""
        case = self.case
        force = case.fluid.force
        falling = force.acts and force.uniform(case.box.dimension) is not None
        at_rest = not setting.flowing(case) or (setting.isothermal(case) and falling)
        if case.walls or case.bodies or not at_rest:
            return np.nan
        solutes = None if of_fluid(case, self.kind) else case.solutes
        ideal = solutes is None or solutes.ideal(solutes.index_of(self.kind))
        if self.molecule.pair is None and not ideal:
            return np.nan  # beads of other kinds matter
        found = self.molecule.mean_square_bond(case.box.dimension, case.fluid.kT)
        return np.nan if found is None else found * bond_at_rest(case, self.kind)

    def expected(self) -> Array:
        """Isotropic products, or those in shear."""
        flowing = self.in_shear()
        if flowing is not None:
            return flowing[None]
        d = self.case.box.dimension
        return self.square() / d * np.eye(d)[None]

    def in_shear(self) -> Array | None:
        """Products (d, d) in a steady shear whose temperature is held; None without a theory."""
        case = self.case
        undisturbed = not case.walls and not case.fluid.force.acts
        if not (case.box.steady_rate and undisturbed and setting.isothermal(case)):
            return None
        return bonds_in_shear(case)

    def comparisons(self) -> Iterator[Comparison]:
        mean, error = self.size(0)
        expected = float(np.trace(self.expected()[0]))
        note = "" if self.in_shear() is None else shear_note(self.case)
        root = max(mean, 0.0) ** 0.5
        note = joined(note, self.short_run())
        error = setting.with_start(self.case, error, mean, self.blocks.series)
        yield Comparison("mean square bond length", mean, error, expected, "a^2", note)
        spread = error / max(2 * root, 1e-300)
        yield Comparison("root mean square bond length", root, spread, expected**0.5, "a", note)
