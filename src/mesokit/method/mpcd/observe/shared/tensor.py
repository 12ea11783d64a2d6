"""What tensors share: block averages of their parts, and sums of elements with an error."""

from abc import abstractmethod

import numpy as np

from mesokit.case.box import AXES
from mesokit.case.case import Case
from mesokit.seam.estimate import Estimate, of_mean
from mesokit.seam.observable import BlockAccumulator, Observable
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import Blocks


class TensorAccumulator(BlockAccumulator):
    """Block averages of so many parts of a tensor (parts, d, d)."""

    def __init__(self, observable: Observable, case: Case, parts: tuple[str, ...]) -> None:
        self.case, self.name, self.parts = case, observable.label, parts
        self.blocks = Blocks((len(parts), case.box.dimension, case.box.dimension))

    @abstractmethod
    def expected(self) -> Array:
        """The tensors of theory (parts, d, d), nan where there is none."""

    @abstractmethod
    def comparisons(self) -> list[Comparison]:
        """Numbers that follow from the tensors."""

    def errors(self) -> Array:
        """Standard errors (parts, d, d)."""
        return self.blocks.error()

    def tensors(self, quantity: str, label: str, unit: str, theory: str) -> Result:
        """The tensors with what is expected of them."""
        axes = np.array(AXES[: self.case.box.dimension])
        return Result(
            quantity=quantity,
            drawing="tensor",
            name=self.name,
            x={"part": np.array(self.parts), "row": axes, "column": axes},
            value=self.blocks.mean(),
            error=self.errors(),
            label=label,
            units={"value": unit},
            expected=self.expected(),
            theory=theory,
            comparisons=tuple(self.comparisons()) if self.blocks.count else (),
            samples=self.blocks.count,
        )

    def summed(self, part: int, weight: Array) -> tuple[float, float]:
        """Sum of the elements of a part with these weights (d, d), and its standard error."""
        every = of_mean(self.blocks)
        residuals = (every.residuals[:, part] * weight).sum(axis=(1, 2))
        error = Estimate(np.zeros(()), residuals, every.weights).error
        return float((every.value[part] * weight).sum()), float(error)
