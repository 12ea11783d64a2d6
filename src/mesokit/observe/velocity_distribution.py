"""Distribution of velocities: a component and the speed, beside Maxwell."""

import math
from dataclasses import replace
from typing import ClassVar, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.box import AXES, Axis
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.observe.shared import chi_square
from mesokit.observe.shared.of_method import OfMethod
from mesokit.observe.shared.profile import KIND
from mesokit.seam.engine import RunningFluid, RunningSpheres
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import Blocks

FARTHEST = 5.0  # thermal velocities: what is beyond counts in the last bins


class Velocities(Protocol):
    """Theory of velocities by a method.

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
        """Name of the theory in a figure."""

    def note(self, classes: int) -> str:
        """Note on a chi-square over so many classes."""


@component
class VelocityDistribution(OfMethod):
    """Histograms of a component of the velocity and of the speed, in thermal velocities sqrt(kT/m).

    Kinds of particles of different mass share one histogram. Velocities of spheres are about their
    mean and scaled by the temperature of the moment, so that those of a gas that cools have a
    histogram, too. The chi-square of single samples has a known mean, which no memory from one
    sample to the next changes.
    """

    quantity: Literal["velocity-distribution"] = tag("velocity-distribution")
    drawing, value_label = "histograms", "probability density"
    units: ClassVar[dict[str, str]] = {"of": ""}
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
        self.theory(case)


@accumulator_of(VelocityDistribution)
class VelocityDistributionAccumulator(BlockAccumulator):
    """Block averages of both histograms, as shares of the particles, and of both chi-squares."""

    def prepare(self) -> None:
        bins, d = self.observable.bins, self.case.box.dimension
        self.theory: Velocities = self.observable.theory(self.case)
        self.edges = np.stack([np.linspace(low, FARTHEST, bins + 1) for low in (-FARTHEST, 0.0)])
        cumulant = float(np.nan_to_num(self.theory.cumulant))
        component = np.array(theory.sonine_component_cdf(self.edges[0], cumulant), float)
        speed = np.array(theory.sonine_speed_cdf(self.edges[1], d, cumulant), float)
        component[0], component[-1], speed[-1] = 0.0, 1.0, 1.0  # these bins have no end
        self.probability = np.diff([component, speed], axis=1)
        number = len(self.theory.ids)
        self.of = [chi_square.classes(p, number) for p in self.probability]
        self.blocks = Blocks((2 * bins + 2,))

    def observe(self, engine: RunningFluid | RunningSpheres) -> None:
        u = self.theory.numbers(engine)
        shares, squares = [], []
        for k, values in enumerate((u[:, self.theory.axis], np.linalg.norm(u, axis=1))):
            probability, of = self.probability[k], self.of[k]
            place = np.searchsorted(self.edges[k], values, "right") - 1
            place = np.clip(place, 0, len(probability) - 1)
            count = np.bincount(place, minlength=len(probability)).astype(float)
            merged = chi_square.joined(count, of), chi_square.joined(probability, of)
            squares.append(chi_square.chi_square(*merged))
            shares.append(count / len(values))
        self.blocks.add(np.concatenate([*shares, squares]))

    def result(self) -> Result:
        """Probability densities."""
        bins, width = self.observable.bins, np.diff(self.edges, axis=1)
        mean, error = self.blocks.mean(), self.blocks.error()
        # each bin may be off for good in a fluid that keeps the energy that it started with
        warm = self.theory.warm(self.blocks.series)
        start = np.stack([0.5 * warm * abs(self._flux(k)) for k in range(2)])
        known = np.array(self.theory.known)[:, None]
        names = f"v_{AXES[self.theory.axis]}", "speed"
        result = self.report(
            {"of": names, "bin": np.arange(bins)},
            (
                mean[:-2].reshape(2, bins) / width,
                np.hypot(error[:-2].reshape(2, bins), start) / width,
            ),
            expected=np.where(known, self.probability, np.nan) / width,
            theory=self.theory.legend(),
            extra={"edges": self.edges.copy()},
        )
        found = (self.compared(k, name, mean[k - 2], error[k - 2]) for k, name in enumerate(names))
        return replace(result, comparisons=tuple(filter(None, found)))  # without samples, too

    def compared(self, k: int, name: str, mean: float, error: float) -> Comparison | None:
        """Mean chi-square of a sample of the component (k = 0) or of the speed, and its error.

        None with too few particles in a sample to tell classes apart.
        """
        probability = chi_square.joined(self.probability[k], self.of[k])
        if len(probability) < 2:
            return None
        degrees, known, d = len(probability) - 1.0, self.theory, self.case.box.dimension
        if k == 0:  # covariance of each class of the component with the component
            density = theory.maxwell_component_pdf(self.edges[0])
            density[[0, -1]] = 0.0  # the first and last bin have no end
            with_mean = chi_square.joined(-np.diff(density), self.of[0])
            degrees -= known.taken_by_mean * chi_square.taken(with_mean, probability)
        # covariance of each class with the square of the number, scaled to a variance of 1
        with_energy = chi_square.joined(self._flux(k), self.of[k]) / math.sqrt(
            2.0 * (d if k else 1)
        )
        # energy of all components together, of which a single one has a share 1/d
        energy = chi_square.taken(with_energy, probability) / (1 if k else d)
        spread = math.sqrt(2.0 / max(self.blocks.series, 1)) * known.kept_energy * energy
        return Comparison(
            f"mean chi-square of {name}",
            mean,
            np.hypot(error, spread),
            degrees - known.taken_by_energy * energy if known.known[k] else math.nan,
            "",
            known.note(len(probability)),
        )

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
