"""How velocities are distributed: a component and the speed, beside Maxwell."""

import math
from typing import Any, ClassVar, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.box import AXES, Axis
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.observe.shared import chi_square
from mesokit.observe.shared.profile import KIND
from mesokit.seam.engine import RunningFluid, RunningSpheres
from mesokit.seam.method import method_of
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import Blocks

FARTHEST = 5.0  # thermal velocities: what is beyond counts in the last bins


class Velocities(Protocol):
    """What a method says of them.

    It is made of a case and the observable, and raises CaseError where there is nothing to look at.
    `axis` is that of the component, `ids` the particles that count; `known` says whether there is a
    theory of the component and of the speed, `cumulant` is a_2, of which it is the first order.
    `taken_by_mean` and `taken_by_energy`, from 0 to 1, are what the sums of the numbers and of
    their squares, which are the same at all times, take from chi-square; `kept_energy` is such a
    part as well, of a sum that is not the same from run to run.
    """

    axis: int
    ids: NDArray[np.int64]
    known: tuple[bool, bool]
    cumulant: float
    taken_by_mean: float
    taken_by_energy: float
    kept_energy: float

    def numbers(self, engine: RunningFluid | RunningSpheres) -> Array:
        """Velocities (n, d) over sqrt(kT/m)."""

    def warm(self, runs: int) -> float:
        """By how much kT may be off for good, relative, over so many runs."""

    def legend(self) -> str:
        """What the theory is called in a figure."""

    def note(self, classes: int) -> str:
        """What to say of a chi-square over so many classes."""


@component
class VelocityDistribution(Observable):
    """Histograms of a component of the velocity and of the speed, in thermal velocities sqrt(kT/m).

    Kinds of particles of different mass share one histogram. Velocities of spheres are about their
    mean and scaled by the temperature of the moment, so that those of a gas that cools have a
    histogram, too. The chi-square of single samples has a known mean, which no memory from one
    sample to the next changes.
    """

    quantity: Literal["velocity-distribution"] = tag("velocity-distribution")
    methods: ClassVar[tuple[str, ...]] = ("event-driven", "soft-spheres")
    in_open_box: ClassVar[bool] = True
    component: Axis | None = param(
        None, doc="of the velocity (the first along which nothing flows)"
    )
    bins: int = param(50, doc="of each histogram", ge=10, le=1000)
    particles: int = param(20_000, doc="particles looked at", ge=100)
    kind: int | str | None = param(None, doc=KIND)

    def check(self, case: Case) -> None:
        """Raise CaseError for z in 2D, and where there is nothing to look at."""
        if self.component is not None:
            case.box.index(self.component, "component")
        self.velocities(case)

    def velocities(self, case: Case) -> Velocities:
        """What the method of a case says of them."""
        found: Velocities = method_of(case).expected["velocity-distribution"](case, self)
        return found


@accumulator_of(VelocityDistribution)
class VelocityDistributionAccumulator(BlockAccumulator):
    """Block averages of both histograms, as shares of the particles, and of both chi-squares."""

    def __init__(self, observable: VelocityDistribution, case: Case) -> None:
        self.name, self.case, d = observable.label, case, case.box.dimension
        self.theory = observable.velocities(case)
        self.axis = self.theory.axis
        self.edges = np.stack(
            [np.linspace(low, FARTHEST, observable.bins + 1) for low in (-FARTHEST, 0.0)]
        )
        cumulant = float(np.nan_to_num(self.theory.cumulant))
        self.cdf = [_ends(theory.sonine_component_cdf(self.edges[0], cumulant), True)]
        self.cdf.append(_ends(theory.sonine_speed_cdf(self.edges[1], d, cumulant), False))
        self.probability = np.diff(self.cdf, axis=1)
        number = len(self.theory.ids)
        self.of = [chi_square.classes(p, number) for p in self.probability]
        self.blocks = Blocks((2 * observable.bins + 2,))

    def observe(self, engine: RunningFluid | RunningSpheres) -> None:
        u = self.theory.numbers(engine)
        shares, squares = [], []
        for k, values in enumerate((u[:, self.axis], np.linalg.norm(u, axis=1))):
            place = np.searchsorted(self.edges[k], values, "right") - 1
            count = np.bincount(
                np.clip(place, 0, len(self.probability[k]) - 1), minlength=len(self.probability[k])
            ).astype(float)
            of = self.of[k]
            merged = chi_square.joined(count, of), chi_square.joined(self.probability[k], of)
            squares.append(chi_square.chi_square(*merged))
            shares.append(count / len(values))
        self.blocks.add(np.concatenate([*shares, squares]))

    def result(self) -> Result:
        """Probability densities."""
        bins = self.probability.shape[1]
        width = np.diff(self.edges, axis=1)
        mean, error = self.blocks.mean(), self.blocks.error()
        axis = AXES[self.axis]
        return Result(
            quantity="velocity-distribution",
            drawing="histograms",
            name=self.name,
            x={"of": np.array([f"v_{axis}", "speed"]), "bin": np.arange(bins)},
            value=mean[:-2].reshape(2, bins) / width,
            error=np.hypot(error[:-2].reshape(2, bins), self._start()) / width,
            expected=self._expected() / width,
            label="probability density",
            units={"value": "", "of": ""},
            theory=self.theory.legend(),
            comparisons=tuple(self._comparisons(mean[-2:], error[-2:])),
            samples=self.blocks.count,
            extra={"edges": self.edges.copy()},
        )

    def _start(self) -> Array:
        """How far each bin may be off for good in a fluid that keeps the energy it started with."""
        warm = self.theory.warm(self.blocks.series)
        return np.stack([0.5 * warm * abs(self._flux(k)) for k in range(2)])

    def _expected(self) -> Array:
        return np.where(np.array(self.theory.known)[:, None], self.probability, np.nan)

    def _comparisons(self, mean: Array, error: Array) -> list[Comparison]:
        """Mean chi-square of a sample of each."""
        found = []
        for k, name in enumerate((f"v_{AXES[self.axis]}", "speed")):
            probability = chi_square.joined(self.probability[k], self.of[k])
            if len(probability) < 2:  # too few in a sample to tell classes apart
                continue
            expected, spread = self._degrees(k, probability)
            found.append(
                Comparison(
                    f"mean chi-square of {name}",
                    float(mean[k]),
                    float(np.hypot(error[k], spread)),
                    expected if self.theory.known[k] else math.nan,
                    "",
                    self.theory.note(len(probability)),
                )
            )
        return found

    def _degrees(self, k: int, probability: Array) -> tuple[float, float]:
        """Expected mean of chi-square, and by how much it differs from run to run for good."""
        degrees, known = len(probability) - 1.0, self.theory
        if k == 0:
            degrees -= known.taken_by_mean * chi_square.taken(self._with_mean(), probability)
        # energy of all components together, of which a single one sees a share 1/d
        energy = chi_square.taken(self._with_energy(k), probability)
        energy /= 1 if k else self.case.box.dimension
        spread = math.sqrt(2.0 / max(self.blocks.series, 1)) * known.kept_energy * energy
        return degrees - known.taken_by_energy * energy, spread

    def _with_mean(self) -> Array:
        """Covariance of each class of the component with the component."""
        density = theory.maxwell_component_pdf(self.edges[0])
        density[[0, -1]] = 0.0  # the first and last bin have no end
        return chi_square.joined(-np.diff(density), self.of[0])

    def _with_energy(self, k: int) -> Array:
        """Covariance of each class with the square of the number, scaled to a variance of 1."""
        degrees = self.case.box.dimension if k else 1
        return chi_square.joined(self._flux(k), self.of[k]) / math.sqrt(2.0 * degrees)

    def _flux(self, k: int) -> Array:
        """Covariance of each bin with the square of the number.

        That is the difference of -u f(u) over the bin: as a scale grows, numbers flow through the
        edges of bins at that rate.
        """
        d, u = self.case.box.dimension, self.edges[k]
        f = theory.maxwell_speed_pdf(u, d) if k else theory.maxwell_component_pdf(u)
        flow = u * f
        flow[[0, -1]] = 0.0  # no end there
        return np.asarray(-np.diff(flow))


def _ends(cdf: Array, both: bool) -> NDArray[Any]:
    """The distribution where the last bin, and for `both` the first, have no end."""
    closed = np.array(cdf, float)
    closed[-1] = 1.0
    if both:
        closed[0] = 0.0
    return closed
