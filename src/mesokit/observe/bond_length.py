"""How long the bonds of molecules are, and which way they point."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit.box import AXES
from mesokit.component import component, tag
from mesokit.errors import CaseError
from mesokit.observe import setting
from mesokit.observe.estimate import Estimate, of_mean
from mesokit.observe.molecules import bond_in_shear
from mesokit.observe.protocol import Observable, RunningFluid, State, pack, unpack
from mesokit.observe.result import Array, Comparison, Result
from mesokit.statistics import Blocks

if TYPE_CHECKING:
    from mesokit.case import Case

IN_SHEAR = "approximate: stretched by the flow, beads with the friction of free particles"


@component
class BondLength(Observable):
    """Mean of the products of the components of bonds; their sum is the mean square bond length."""

    quantity: Literal["bond-length"] = tag("bond-length")

    def check(self, case: Case) -> None:
        """Raise CaseError for a fluid without bonds."""
        if case.fluid.molecule is None:
            raise CaseError("bond-length is measured in fluids of molecules; give fluid.molecule")

    def accumulator(self, case: Case) -> BondLengthAccumulator:
        """An empty memory for it."""
        return BondLengthAccumulator(self, case)


class BondLengthAccumulator:
    """Block averages of the products."""

    def __init__(self, observable: BondLength, case: Case) -> None:
        observable.check(case)
        self.case, self.name = case, observable.label
        d = case.box.dimension
        self.blocks = Blocks((1, d, d))

    def observe(self, fluid: RunningFluid) -> None:
        """Take one sample."""
        way = fluid.bond_vectors()
        products = np.einsum("ij,ik->jk", way, way) / len(way)
        self.blocks.add(products[None])

    def state(self) -> State:
        """All it has to remember."""
        return pack(blocks=self.blocks)

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Go on from `state()`."""
        self.blocks = Blocks.from_state(unpack(state, "blocks"))

    def result(self) -> Result:
        """The products, and the mean square bond length beside that of Boltzmann."""
        axes = np.array(AXES[: self.case.box.dimension])
        return Result(
            quantity="bond-length",
            name=self.name,
            x={"part": np.array(["bonds"]), "row": axes, "column": axes},
            value=self.blocks.mean(),
            error=self.blocks.error(),
            label="products of bond components",
            units={"value": "a^2"},
            expected=self._expected_products(),
            theory="Boltzmann's distribution of a bond at rest",
            comparisons=tuple(self._comparisons()) if self.blocks.count else (),
            samples=self.blocks.count,
        )

    def _expected(self) -> float:
        """Mean square length; nan in flow, between walls, and where other beads matter."""
        case = self.case
        assert case.fluid.molecule is not None
        at_rest = not setting.driven(case) or (
            setting.isothermal(case) and case.fluid.force.rule == "uniform" and not case.walls
        )
        if case.walls or not at_rest:
            return np.nan
        found = case.fluid.molecule.mean_square_bond(case.box.dimension, case.fluid.kT)
        return np.nan if found is None else found

    def _expected_products(self) -> Array:
        d = self.case.box.dimension
        expected = self._expected() / d * np.eye(d)
        return expected[None]

    def _comparisons(self) -> list[Comparison]:
        case, box = self.case, self.case.box
        mean = float(np.trace(self.blocks.mean()[0]))
        every = of_mean(self.blocks)
        trace = np.trace(every.residuals[:, 0], axis1=1, axis2=2)
        error = float(Estimate(np.zeros(()), trace, every.weights).error)
        expected, note = self._expected(), ""
        if box.shear_rate and not box.shear_frequency and setting.isothermal(case):
            flowing = None if case.fluid.force.rule != "none" else bond_in_shear(case)
            if flowing is not None:
                expected, note = flowing, IN_SHEAR
        root = max(mean, 0.0) ** 0.5
        error = setting.with_start(case, error, mean)
        return [
            Comparison("mean square bond length", mean, error, expected, "a^2", note),
            Comparison(
                "root mean square bond length", root, error / max(2 * root, 1e-300),
                expected**0.5, "a", note,
            ),
        ]  # fmt: skip
