"""Order of sites with several states, such as Potts spins, and its cumulant."""

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, name_of, show, tag
from mesokit.errors import CaseError
from mesokit.method.kinetic_monte_carlo.observe.protocol import LatticeObservable, RunningLattice
from mesokit.seam.estimate import of_mean
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import Blocks, TimeSeries


@component
class OrderParameter(LatticeObservable):
    """Order (q f - 1)/(q - 1) of sites with q states in time, f being the part in the most frequent
    one: 0 if all are as frequent, 1 if all sites are alike.

    Beside its mean are the mean square of the vector order, M^2 = (q sum f_k^2 - 1)/(q - 1), and
    the Binder cumulant of its n = q - 1 components, 1 - n <M^4>/((n + 2) <M^2>^2): 0 without order,
    2/(n + 2) with it.
    """

    quantity: Literal["order-parameter"] = tag("order-parameter")
    drawing, value_label = "path", "order"
    units: ClassVar[dict[str, str]] = {"time": "tau"}

    def check(self, case: Case) -> None:
        """Raise CaseError for a model whose sites have heights."""
        super().check(case)
        if len(case.lattice.model.states()) < 2:
            raise CaseError(
                f"model {show(name_of(case.lattice.model))} has no states; leave it out"
            )


@accumulator_of(OrderParameter)
class OrderParameterAccumulator(BlockAccumulator):
    """Order, square and fourth power of the vector order, and a time series of the first."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "series")

    def prepare(self) -> None:
        self.blocks, self.series = Blocks(3), TimeSeries(1)
        self.q = len(self.case.lattice.model.states())

    def observe(self, engine: RunningLattice) -> None:
        parts = np.bincount(engine.sites(), minlength=self.q) / engine.n
        order = (self.q * float(parts.max()) - 1) / (self.q - 1)
        square = (self.q * float(parts @ parts) - 1) / (self.q - 1)
        self.blocks.add([order, square, square**2])
        self.series.add(engine.time, [order])

    def result(self) -> Result:
        return self.report(
            {"time": self.series.time()}, self.series.values()[:, 0], self.comparisons()
        )

    def comparisons(self) -> Iterator[Comparison]:
        """Mean order, mean square and cumulant."""
        means, unit = of_mean(self.blocks), np.eye(3)
        order, square, fourth = map(float, means.value)
        yield Comparison("mean order", *means.scalar(order, unit[0]))
        yield Comparison("mean square", *means.scalar(square, unit[1]))
        if square > 0:
            n = self.q - 1
            ratio = n / (n + 2) / square**2
            slope = ratio * (2 * fourth / square * unit[1] - unit[2])
            yield Comparison("Binder cumulant", *means.scalar(1 - ratio * fourth, slope))
