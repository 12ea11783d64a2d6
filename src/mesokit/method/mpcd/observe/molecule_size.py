"""Size of molecules: gyration tensor and, of chains, the end-to-end vector."""

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit import theory
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.mpcd.expected.ideal import mean_shape
from mesokit.method.mpcd.expected.molecules import ends_at_rest, free_bond, gyration, modes_at_rest
from mesokit.method.mpcd.expected.selection import KIND, beads_of, group_of, molecule_of
from mesokit.method.mpcd.observe.shared.tensor import MoleculeTensorAccumulator
from mesokit.seam.engine import RunningFluid
from mesokit.seam.observable import Observable, accumulator_of
from mesokit.seam.result import Array, Comparison, Result

PARTS = ("gyration", "end to end")


@component
class MoleculeSize(Observable):
    """Mean gyration tensor; of chains also mean R R of the vector R from end to end."""

    quantity: Literal["molecule-size"] = tag("molecule-size")
    needs_fluid: ClassVar[bool] = False
    drawing = "tensor"
    value_label = "size of molecules"
    units: ClassVar[dict[str, str]] = {"value": "a^2"}
    molecules: int = param(2000, doc="molecules looked at", ge=1)
    kind: int | str = param(1, doc=KIND)

    def check(self, case: Case) -> None:
        """Raise CaseError without molecules."""
        molecule_of(case, self.quantity, self.kind)


@accumulator_of(MoleculeSize)
class MoleculeSizeAccumulator(MoleculeTensorAccumulator):
    """Block averages of the tensors."""

    def prepare(self) -> None:
        observable, case = self.observable, self.case
        chain = molecule_of(case, kind=observable.kind).topology == "chain"
        self.beads = beads_of(case, observable.molecules, observable.kind)
        self.prepare_for(PARTS if chain else PARTS[:1], len(self.beads))

    def observe(self, fluid: RunningFluid) -> None:
        r = fluid.whole_positions(self.beads.ravel()).reshape(*self.beads.shape, -1)
        each = gyration(r)
        tensors, squares = [each], [(each**2).mean(axis=0)]
        traces = [(np.trace(each, axis1=1, axis2=2) ** 2).mean()]
        if len(self.parts) > 1:
            end = r[:, -1] - r[:, 0]
            square = end**2
            tensors.append(np.einsum("ma,mb->mab", end, end))
            squares.append(np.einsum("ma,mb->ab", square, square) / len(end))
            traces.append((square.sum(axis=1) ** 2).mean())
        self.note_own(np.stack(tensors, axis=1))
        self.note_squares(np.stack(squares), np.array(traces), len(r))

    def weights(self, part: int) -> Array:
        """Part of the mean square size that each normal mode has; of the ends only odd ones."""
        assert self.times is not None
        mode = np.asarray(self.times.mode)
        return mode * (np.arange(len(mode)) % 2 == 0) if part else mode

    def result(self) -> Result:
        return self.tensors("ideal molecules")

    def expected(self) -> Array:
        """Tensors: isotropic, and what pulls add; nan where there is no theory."""
        bond, d = free_bond(self.case, self.kind), self.case.box.dimension
        mean = mean_shape(self.case, self.kind, group_of(self.case, "beads", self.kind))
        if bond is None or mean is None:
            return np.full((len(self.parts), d, d), np.nan)
        squares = [theory.mean_square_gyration(modes_at_rest(self.case, self.kind), bond)]
        added = [gyration(mean[None])[0]]
        if len(self.parts) > 1:
            squares.append(ends_at_rest(self.case, self.kind, bond))
            added.append(np.outer(mean[-1] - mean[0], mean[-1] - mean[0]))
        return np.array(squares)[:, None, None] / d * np.eye(d) + np.array(added)

    def comparisons(self) -> Iterator[Comparison]:
        names = ("mean square radius of gyration", "mean square end-to-end distance")
        for part, expected in enumerate(np.trace(self.expected(), axis1=1, axis2=2).tolist()):
            yield Comparison(names[part], *self.size(part), expected, "a^2", self.short_run())
