"""Molecules in time: size, ends, orientation, place and velocity of each."""

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit.case.box import AXES, Axis
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.mpcd.expected.ideal import flow_axis, ideal_sizes, undisturbed
from mesokit.method.mpcd.expected.selection import KIND, group_of, molecule_of
from mesokit.observe.shared.over_molecules import MeansOverMolecules
from mesokit.seam.engine import RunningFluid
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of
from mesokit.seam.result import Comparison, Result, joined
from mesokit.statistics import TimeSeries

NUMBERS = 2**20  # of the time series, for all molecules together
MOST_ROWS = 4096


@component
class MoleculeTracks(Observable):
    """Radius of gyration, end-to-end vector, orientation, place and velocity of molecules in time.

    Each molecule has its own series: `result.x["time"]` by `molecule` by `component`. The place of
    the centre of mass is unwrapped: it grows as the molecule goes from box to box (under shear nan
    along x, where images slide). The orientation is that of the end-to-end vector of a chain
    against `axis`: (d cos^2 - 1)/(d - 1) in d dimensions, 1 along it, 0 for any direction.
    """

    quantity: Literal["molecule-tracks"] = tag("molecule-tracks")
    needs_fluid: ClassVar[bool] = False
    drawing = "tracks"
    value_label = "molecules in time"
    molecules: int = param(20, doc="molecules followed, evenly spread over all", ge=1, le=10_000)
    kind: int | str = param(1, doc=KIND)
    axis: Axis | None = param(
        None, doc="axis of the orientation (that of the force on the fluid, x unless there is one)"
    )

    def check(self, case: Case) -> None:
        """Raise CaseError without molecules, or for an axis that the box has not."""
        molecule_of(case, self.quantity, self.kind)
        if self.axis is not None:
            case.box.index(self.axis)

    def warnings(self, case: Case) -> Iterator[str]:
        kept = MoleculeTracksAccumulator(self, case)
        samples = case.run.steps // self.every + 1
        if samples > kept.rows:
            yield (
                f"every = {self.every}: {samples} samples of {kept.number} molecules are more than "
                f"are kept; each row of the series will be the mean of up to "
                f"{2 ** int(np.ceil(np.log2(samples / kept.rows)))} samples"
            )


@accumulator_of(MoleculeTracks)
class MoleculeTracksAccumulator(BlockAccumulator):
    """A series of every molecule, and means over all."""

    memory: ClassVar[tuple[str, ...]] = ("series", "means")

    def prepare(self) -> None:
        observable, case = self.observable, self.case
        self.kind = observable.kind
        self.group = group_of(case, "beads", observable.kind)
        self.beads = self.group.beads(observable.molecules)
        self.number, self.dimension = len(self.beads), case.box.dimension
        self.axis = flow_axis(case, observable.axis)
        molecule = self.group.molecule
        self.chain = molecule is not None and molecule.topology == "chain"
        width = self.number * len(self.components)
        self.rows = min(MOST_ROWS, 2 * max(NUMBERS // width // 2, 1))
        self.series = TimeSeries(width, self.rows)
        everything = self.beads.size == case.particles and case.solutes is None
        self.means = MeansOverMolecules(self.number, 3 + self.dimension, everything)

    @property
    def components(self) -> list[str]:
        axes = AXES[: self.dimension]
        ends = ["end-to-end", *(f"R{a}" for a in axes), "orientation"] if self.chain else []
        return ["gyration", *ends, *axes, *(f"v{a}" for a in axes)]

    def observe(self, fluid: RunningFluid) -> None:
        shape, d = (*self.beads.shape, self.dimension), self.dimension
        ids = self.beads.ravel()
        r = fluid.whole_positions(ids).reshape(shape)
        arm = r - r.mean(axis=1, keepdims=True)
        gyration = (arm**2).sum(axis=(1, 2)) / shape[1]
        place = fluid.positions(ids, unwrapped=True).reshape(shape).mean(axis=1)
        if self.case.box.sheared:
            place[:, 0] = np.nan
        velocity = fluid.velocities(ids).reshape(shape).mean(axis=1)
        ends = r[:, -1] - r[:, 0]
        square = (ends**2).sum(axis=1)
        with np.errstate(invalid="ignore"):
            aligned = (d * ends[:, self.axis] ** 2 / square - 1) / (d - 1)
        aligned = np.where(square > 0, aligned, 0.0)
        root = [np.sqrt(gyration)]
        kept = [*root, np.sqrt(square), *ends.T, aligned] if self.chain else root
        row = np.stack([*kept, *place.T, *velocity.T], axis=1)
        self.series.add(fluid.time, row.ravel())
        self.means.add(np.stack([gyration, square, aligned, *velocity.T], axis=1))

    def result(self) -> Result:
        names = self.components
        value = self.series.values().reshape(-1, self.number, len(names))
        units = dict.fromkeys(names, "a") | {"orientation": ""}
        units |= {f"v{a}": "a/tau" for a in AXES}
        sizes = ideal_sizes(self.case, self.kind, self.group)
        return self.report(
            {
                "time": self.series.time(),
                "molecule": 1 + (self.beads[:, 0] - self.group.first) // self.group.length,
                "component": names,
            },
            value,
            self.comparisons(*sizes),
            units={"value": "", "time": "tau", "molecule": ""} | {n: units[n] for n in names},
            samples=self.means.blocks.count,
            extra={
                "axis": AXES[self.axis],
                "samples_per_row": self.series.stride,
                "ideal_gyration": float(np.sqrt(sizes[0])),
                "ideal_end_to_end": float(np.sqrt(sizes[1])),
            },
        )

    def comparisons(self, gyration: float, ends: float) -> Iterator[Comparison]:
        mean, error = self.means.mean().tolist(), self.means.error().tolist()
        rest, note = 0.0 if undisturbed(self.case) else np.nan, self.note()
        rows = [("mean square radius of gyration", 0, gyration, "a^2")]
        if self.chain:
            rows.append(("mean square end-to-end distance", 1, ends, "a^2"))
            rows.append((f"orientation along {AXES[self.axis]}", 2, rest, ""))
        for k in range(self.dimension):
            rows.append((f"velocity of centres along {AXES[k]}", 3 + k, rest, "a/tau"))
        for what, k, known, unit in rows:
            yield Comparison(what, mean[k], error[k], known, unit, note)

    def note(self) -> str:
        """Number of molecules behind an error bar, where they are few."""
        few = self.number < self.group.number
        words = f"of {self.number} of {self.group.number} molecules" if few else ""
        return joined(words, self.means.caution())
