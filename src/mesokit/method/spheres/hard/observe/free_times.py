"""Times of flight of hard spheres from one collision to the next."""

import math
from collections.abc import Iterator
from typing import ClassVar, Literal, Self

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.errors import CaseError
from mesokit.method.spheres.common.expected.enskog import fluid_note, pair_rate, root_of_temperature
from mesokit.method.spheres.common.observe.protocol import OfSpheres
from mesokit.seam.engine import CollidingSpheres
from mesokit.seam.estimate import of_mean, of_ratio
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import Blocks

FINE = 256  # bins in which an engine counts
DILUTE = 0.0025  # packing fraction above which the last partner is in the way of others for long
LONG = 8.0  # mean free times: hardly a flight is longer
TIME = "tau"


@component
class FreeTimes(OfSpheres):
    """Distribution of the times between successive collisions of a sphere, with others and walls.

    All flights count that end between two samples. Theory is that of a uniform gas of equal elastic
    spheres: the mean follows from the pressure, at the temperature as it is in time, and the
    distribution from molecular chaos, in which fast spheres collide more often. So it is not
    exactly exponential.
    """

    quantity: Literal["free-times"] = tag("free-times")
    methods: ClassVar[tuple[str, ...]] = ("event-driven",)
    drawing, value_label = "histogram", "probability density"
    units: ClassVar[dict[str, str]] = {"value": f"1/{TIME}", "duration": TIME}
    measures: ClassVar[tuple[str, ...]] = ("free times",)
    bins: int = param(
        64, doc="of some eight mean free times: a power of two", unit="", ge=8, le=FINE
    )

    def check(self, case: Case) -> None:
        """Raise CaseError for bins that are no power of two."""
        if FINE % self.bins:
            raise CaseError(f"bins = {self.bins}: expected a power of two from 8 to {FINE}")

    def warnings(self, case: Case) -> Iterator[str]:
        """Where the warm-up is so short that long flights are missing at first."""
        rate = pair_rate(case, math.sqrt(case.spheres.kT))
        passed = case.run.warmup * case.spheres.timestep
        if rate * passed < LONG:
            yield (
                f"quantity = 'free-times': long flights are missing at first; expected a warm-up "
                f"of {LONG / rate:.3g} in time, {LONG:g} mean free times, not {passed:g}"
            )


@accumulator_of(FreeTimes)
class FreeTimesAccumulator(BlockAccumulator):
    """Block averages of the flights that ended between two samples."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "before", "edges")

    def prepare(self) -> None:
        self.bins = self.observable.bins
        # flights in bins and longer ones; sums of times and squares; root of the temperature
        self.blocks = Blocks((self.bins + 4,))
        self.before = np.zeros(self.bins + 3)
        self.edges: NDArray[np.float64] = np.zeros(self.bins + 1)

    def observe(self, spheres: CollidingSpheres) -> None:
        """Take one sample: of what has ended since the last."""
        edges, counts, sums = spheres.free_times
        self.edges = np.array(edges[:: FINE // self.bins])
        inside = counts[:-1].reshape(self.bins, -1).sum(axis=1)
        now = np.array([*inside, counts[-1], *sums])
        root = root_of_temperature(self.case, spheres.totals()[2])
        self.blocks.add([*(now - self.before), root])
        self.before = now

    def pool(self, other: Self) -> None:
        super().pool(other)
        self.edges = np.maximum(self.edges, other.edges)  # zero before the first sample

    def result(self) -> Result:
        """The distribution, its mean, and how far it is from an exponential."""
        sums, _ = self.blocks.sums()
        flights, d = sums[:, : self.bins + 1], self.case.box.dimension
        number = flights.sum(axis=1, keepdims=True)
        found = number.sum() > 0
        edges = self.edges if found else np.zeros(1)
        width = edges[1] - edges[0] if found else 1.0
        share = of_ratio(flights[:, : self.bins], np.broadcast_to(number, (len(sums), self.bins)))
        value, error = (share.value, share.error) if found else (np.zeros(0), np.zeros(0))
        expected, beside, mean = None, {}, self.expected()
        if found and math.isfinite(mean):
            expected = np.diff(theory.free_time_cdf(edges / mean, d)) / width
            simple = -np.diff(np.exp(-edges / mean)) / width
            beside = {"beside": simple, "beside_label": "exponential, approximate"}
        listed = list(self.comparisons(mean)) if found else []
        return self.report(
            {"duration": (edges[1:] + edges[:-1]) / 2},
            (value / width, error / width),
            listed,
            expected=expected,
            theory="molecular chaos",
            extra={
                "edges": edges,
                "of": "time between collisions",
                "mean": listed[0].measured if listed else np.nan,
                **beside,
            },
        )

    def expected(self) -> float:
        """The mean free time of a uniform gas of equal spheres; nan of all others."""
        if not self.blocks.count:
            return math.nan
        section = self.case.spheres
        steady = section.collision.elastic or section.heating is not None
        rate = pair_rate(self.case, float(self.blocks.mean()[-1]))
        return 1 / rate if steady and rate > 0 else math.nan

    def comparisons(self, known: float) -> Iterator[Comparison]:
        """Mean, mean square over its square, and how many flights there were."""
        every, d = of_mean(self.blocks), self.case.box.dimension
        number = float(every.value[: self.bins + 1].sum())
        times, squares = (float(x) for x in every.value[-3:-1])
        ones = np.zeros(len(every.value))
        ones[: self.bins + 1] = 1.0
        of_times, of_squares = (np.eye(len(ones))[k] for k in (-3, -2))
        elastic, chaos = self.case.spheres.collision.elastic, "approximate: molecular chaos"
        dilute = self.case.spheres.fraction(self.case.box) <= DILUTE
        spread_note = "2 of an exponential" if elastic and dilute else chaos
        note, expected = fluid_note(self.case) or ("" if elastic else chaos), math.nan
        if math.isnan(known):
            note = spread_note = ""
        else:
            expected = theory.free_time_spread(d)
        mean = times / number
        measured = every.scalar(mean, (of_times - mean * ones) / number)
        yield Comparison("mean free time", *measured, known, TIME, note)
        spread = squares * number / times**2
        gradient = spread * (of_squares / squares + ones / number - 2 * of_times / times)
        what = "mean square over the square of the mean"
        yield Comparison(what, *every.scalar(spread, gradient), expected, "", spread_note)
        yield Comparison("flights", round(number * self.blocks.count), math.nan)
