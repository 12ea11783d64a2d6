"""Bands: density and order along the direction in which a flock flies."""

import math
from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit.case.box import AXES, Axis
from mesokit.case.case import Case
from mesokit.case.component import component, param, show, tag
from mesokit.errors import CaseError
from mesokit.method.flock.expected import at_random
from mesokit.method.flock.observe.protocol import FlockObservable, RunningFlock
from mesokit.seam.estimate import of_mean, of_ratio
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import Blocks

MOST_BINS = 2**16
WAVES = 8  # the longest, that tell where the crest is
FINE = 1024  # places among which it is found


@component
class DensityBands(FlockObservable):
    """Profile of density and local order along the axis of the box nearest to the mean heading.

    At each sample it is turned so that the flock flies to the right, and moved so that the crest of
    the density, of its longest waves together, is in the middle: that band is then seen at rest,
    others where they mostly are. A crest there is always; bands differ from chance in the
    size of the waves.
    """

    quantity: Literal["density-bands"] = tag("density-bands")
    among_walls: ClassVar[bool] = False
    drawing, value_label = "bands", "density over its mean, heading"
    units: ClassVar[dict[str, str]] = {"along": "a", "of": ""}
    axis: Axis | None = param(None, doc="axis of the profile (nearest to the heading unless said)")
    bins: int = param(64, doc="bins over the length of the box", ge=4, le=MOST_BINS)

    def check(self, case: Case) -> None:
        """Raise CaseError among walls, and in boxes of unequal sides without an axis."""
        super().check(case)
        if self.axis is not None:
            case.box.index(self.axis)
        elif len(set(case.box.size)) > 1:
            raise CaseError(
                f"axis: missing; the sides of the box {show(list(case.box.size))} differ, and so "
                "do the profiles along them"
            )


@accumulator_of(DensityBands)
class DensityBandsAccumulator(BlockAccumulator):
    """Block averages of number and heading in each bin, and of the longest waves."""

    def prepare(self) -> None:
        axis, self.bins = self.observable.axis, self.observable.bins
        self.axis = None if axis is None else AXES.index(axis)
        self.length = float(self.case.box.size[self.axis or 0])
        self.blocks = Blocks(2 * self.bins + 1)
        wave = np.arange(1, WAVES + 1)[:, None]
        self.waves = np.exp(-2j * np.pi * wave * np.arange(FINE) / FINE)

    def observe(self, engine: RunningFlock) -> None:
        headings = engine.headings()
        mean = headings.mean(axis=0)
        axis = int(np.argmax(np.abs(mean))) if self.axis is None else self.axis
        sign = -1.0 if mean[axis] < 0 else 1.0
        place = sign * engine.positions()[:, axis] / self.length
        modes = self.modes(place)
        crest = np.argmax((modes @ self.waves).real) / FINE
        place = (place - crest + 0.5) % 1.0
        bins = np.minimum((place * self.bins).astype(int), self.bins - 1)
        number = np.bincount(bins, minlength=self.bins)
        along = np.bincount(bins, sign * headings[:, axis], minlength=self.bins)
        square = (np.abs(modes) ** 2).mean()
        self.blocks.add(np.concatenate([number, along, [square]]))

    def modes(self, place: Array) -> NDArray[np.complex128]:
        """Mean of e^(2 pi i m place) for the longest waves, (WAVES,)."""
        step, power = np.exp(2j * np.pi * place), np.ones(len(place), complex)
        found = np.zeros(WAVES, complex)
        for m in range(WAVES):
            power *= step
            found[m] = power.mean()
        return found

    def result(self) -> Result:
        """Density over its mean and the mean heading along the axis; the structure factor."""
        n, number = self.bins, self.case.particles
        sums, _ = self.blocks.sums()
        with np.errstate(invalid="ignore", divide="ignore"):
            means = of_mean(self.blocks)
            order = of_ratio(sums[:, n : 2 * n], sums[:, :n])
            value = np.stack([means.value[:n] / (number / n), order.value], axis=1)
            error = np.stack([means.error[:n] / (number / n), order.error], axis=1)

        def comparisons() -> Iterator[Comparison]:
            """N times the mean square of the modes: 1 for places at random."""
            measured = means.scalar(number * float(means.value[-1]), number * np.eye(2 * n + 1)[-1])
            what = f"structure factor of the {WAVES} longest waves"
            # without order the axis follows chance, which does not depend on the places
            expected = 1.0 if at_random(self.case) else math.nan
            yield Comparison(what, *measured, expected, "", "1 for places at random")

        return self.report(
            {"along": (np.arange(n) + 0.5) / n * self.length, "of": ["density", "heading"]},
            (value, error),
            comparisons(),
        )
