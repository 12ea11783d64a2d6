"""Tensors in blocks of time, and of molecules with error bars that hold in short runs.

Blocking sees a number change only within the run, and a molecule changes in its relaxation time: a
shorter run sees each molecule in one state, and the mean is off by the scatter of the molecules in
one sample over the root of their number.
"""

from abc import abstractmethod
from collections.abc import Iterator
from typing import ClassVar

import numpy as np

from mesokit.case.box import AXES
from mesokit.method.mpcd.expected.molecules import least_times_of
from mesokit.observe.shared.over_molecules import OwnMeans
from mesokit.observe.shared.short_run import ENOUGH, of_relaxations
from mesokit.seam.estimate import Estimate, of_mean
from mesokit.seam.observable import BlockAccumulator
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import Blocks


def kept(times: float) -> float:
    """Part of the variance of one sample that the mean over so many correlation times keeps.

    Of a process that decays as an exponential: 1 for none, 2/times for many.

    >>> kept(0.0), round(kept(1e-3), 3), round(1e4 * kept(1e4), 1)
    (1.0, 1.0, 2.0)
    """
    if times < 1e-3:
        return 1.0
    return float(2 * (times + np.expm1(-times)) / times**2)


class TensorAccumulator(BlockAccumulator):
    """Block averages of so many parts of a tensor (parts, d, d)."""

    parts: tuple[str, ...]

    def prepare(self) -> None:
        """Make the blocks; `parts` are set before."""
        self.blocks = Blocks((len(self.parts), *[self.case.box.dimension] * 2))

    @abstractmethod
    def expected(self) -> Array:
        """The tensors of theory (parts, d, d), nan where there is none."""

    @abstractmethod
    def comparisons(self) -> Iterator[Comparison]:
        """Numbers that follow from the tensors."""

    def errors(self) -> Array:
        return self.blocks.error()

    def tensors(self, theory: str, **units: str) -> Result:
        """The tensors beside a theory of this name; `units` that depend on the case."""
        axes = AXES[: self.case.box.dimension]
        return self.report(
            {"part": self.parts, "row": axes, "column": axes},
            (self.blocks.mean(), self.errors()),
            self.comparisons(),
            units=units,
            expected=self.expected(),
            theory=theory,
        )

    def summed(self, part: int, weight: Array) -> tuple[float, float]:
        """Sum of the elements of a part with these weights (d, d), and its standard error."""
        every = of_mean(self.blocks)
        residuals = (every.residuals[:, part] * weight).sum(axis=(1, 2))
        error = Estimate(np.zeros(()), residuals, every.weights).error
        return float((every.value[part] * weight).sum()), float(error)


class MoleculeTensorAccumulator(TensorAccumulator):
    """Block averages of tensors of molecules, and how much these differ in one sample."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "scatter", "own", "number")
    added: ClassVar[tuple[str, ...]] = ("runs",)

    def prepare_for(self, parts: tuple[str, ...], molecules: int) -> None:
        """Make the memory of so many parts of the tensors of so many molecules."""
        self.parts, self.kind, d = parts, self.observable.kind, self.case.box.dimension
        super().prepare()
        self.number = 1  # molecules, or bonds, in a sample
        self.runs = 1  # that were pooled
        self.scatter = Blocks((len(parts), d**2 + 1))  # elements, and the trace
        self.times = least_times_of(self.case, self.kind)
        self.own = OwnMeans(molecules, len(parts) * d**2)

    def note_own(self, tensors: Array) -> None:
        """Take the tensors (molecules, parts, d, d) of each molecule."""
        self.blocks.add(tensors.mean(axis=0))
        self.own.add(tensors.reshape(len(tensors), -1))

    def note_sums(self, sums: Array, molecules: int) -> None:
        """Take the sums (groups, parts d d) of the tensors of each group of so many molecules."""
        mean = sums.sum(axis=0) / molecules
        self.blocks.add(mean.reshape(len(self.parts), *[self.case.box.dimension] * 2))
        self.own.add_sums(sums)

    def note_squares(self, elements: Array, traces: Array, number: int) -> None:
        """Take the means over `number` molecules of the squares of elements (parts, d, d) and of
        traces (parts,)."""
        self.number = number
        self.scatter.add(np.concatenate([elements.reshape(len(traces), -1), traces[:, None]], 1))

    def pool(self, other: BlockAccumulator) -> None:
        assert isinstance(other, MoleculeTensorAccumulator)
        super().pool(other)
        self.number = max(self.number, other.number)

    def weights(self, part: int) -> Array:
        """Part of the size that each normal mode has: the same of the bonds."""
        assert self.times is not None
        return np.ones(len(self.times.mode))

    def relaxations(self) -> float:
        """Length of a run in relaxation times of the slowest mode, nan where they are not known.

        Those of molecules at rest: a flow makes them shorter.
        """
        if self.times is None:
            return np.nan
        length = self.blocks.count / self.runs * self.observable.every * self.case.fluid.timestep
        return float(length / self.times.mode[0])

    def short_run(self) -> str:
        """Caveat of a run that is short against the relaxation time of the molecules."""
        times = self.relaxations()
        if np.isnan(times):
            return self.own.caution()
        if not 0 < times < ENOUGH:
            return ""
        both = self.case.solutes is not None and self.case.fluid.molecule is not None
        words = "relaxation times at most" if both else "relaxation times"
        return of_relaxations(times, self.runs, words)

    def bounds(self, part: int) -> tuple[Array, float]:
        """Least errors of the elements (d, d) of a part, and of its trace; 0 in a long run.

        The scatter of the molecules' own means, which may be caught between walls however long the
        run is; and where times are known, but blocks too short, that in one sample.
        """
        d = self.case.box.dimension
        short = bool(self.short_run())
        if not (short or np.isnan(self.relaxations()) or self.case.walls):
            return np.zeros((d, d)), 0.0
        sums = np.zeros((d * d + 1, len(self.parts), d * d))
        sums[:-1, part], sums[-1, part] = np.eye(d * d), np.eye(d).ravel()
        bound = np.nan_to_num(self.own.error(sums.reshape(d * d + 1, -1)))
        if self.times is not None and short:
            bound = np.maximum(bound, self.scatter_in_samples(part))
        return bound[:-1].reshape(d, d), float(bound[-1])

    def scatter_in_samples(self, part: int) -> Array:
        """Errors of the elements of a part, and of its trace, by how much molecules differ in one
        sample and what a mean over the run keeps of that."""
        assert self.times is not None
        weight = self.weights(part) ** 2
        slow = float((weight * self.times.stress).sum() / weight.sum())  # of squares of modes
        length = self.relaxations() * float(self.times.mode[0])
        mean, square = self.blocks.mean()[part], self.scatter.mean()[part]
        means = np.append(mean.ravel(), np.trace(mean))
        independent = self.number * self.runs
        variance = np.maximum(square - means**2, 0.0) * kept(length / slow) / independent
        return np.sqrt(variance)

    def errors(self) -> Array:
        found = self.blocks.error()
        if not self.blocks.count:
            return found
        return np.maximum(found, np.stack([self.bounds(k)[0] for k in range(len(self.parts))]))

    def size(self, part: int) -> tuple[float, float]:
        """Trace of a part, and its standard error."""
        value, error = self.summed(part, np.eye(self.case.box.dimension))
        return value, float(np.maximum(error, self.bounds(part)[1]))
