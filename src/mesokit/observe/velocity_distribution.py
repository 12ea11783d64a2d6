"""How velocities are distributed: a component and the speed, beside Maxwell."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.box import AXES, Axis
from mesokit.case.component import component, param, tag
from mesokit.engine import RunningFluid
from mesokit.method.mpcd.expected import setting
from mesokit.observe.shared import chi_square
from mesokit.observe.shared.protocol import BlockAccumulator, Observable
from mesokit.observe.shared.result import Array, Comparison, Result
from mesokit.statistics import Blocks, spread_ids

if TYPE_CHECKING:
    from mesokit.case.case import Case

FARTHEST = 5.0  # thermal velocities: what is beyond counts in the last bins


@component
class VelocityDistribution(Observable):
    """Histograms of a component of the velocity and of the speed, in thermal velocities sqrt(kT/m).

    Kinds of particles of different mass share one histogram. The chi-square of single samples has
    a known mean, which no memory from one sample to the next changes.
    """

    quantity: Literal["velocity-distribution"] = tag("velocity-distribution")
    in_open_box: ClassVar[bool] = True
    component: Axis | None = param(
        None, doc="of the velocity (the first along which nothing flows)"
    )
    bins: int = param(50, doc="of each histogram", ge=10, le=1000)
    particles: int = param(20_000, doc="particles looked at", ge=100)

    def check(self, case: Case) -> None:
        """Raise CaseError for z in 2D."""
        if self.component is not None:
            case.box.index(self.component, "component")

    def accumulator(self, case: Case) -> VelocityDistributionAccumulator:
        """An empty memory for it."""
        return VelocityDistributionAccumulator(self, case)


class VelocityDistributionAccumulator(BlockAccumulator):
    """Block averages of both histograms, as shares of the particles, and of both chi-squares."""

    def __init__(self, observable: VelocityDistribution, case: Case) -> None:
        observable.check(case)
        self.name, self.case, d = observable.label, case, case.box.dimension
        still = [k for k in range(d) if setting.flow(case, k).kind == "rest"]
        given = observable.component
        self.axis = AXES.index(given) if given else still[0] if still else 0
        self.calm = {"component": self.axis in still, "speed": len(still) == d}
        self.ids = spread_ids(observable.particles, case.particles)
        self.edges = np.stack(
            [np.linspace(low, FARTHEST, observable.bins + 1) for low in (-FARTHEST, 0.0)]
        )
        self.cdf = [_ends(theory.maxwell_component_cdf(self.edges[0]), True)]
        self.cdf.append(_ends(theory.maxwell_speed_cdf(self.edges[1], d), False))
        self.probability = np.diff(self.cdf, axis=1)
        self.of = [chi_square.classes(p, len(self.ids)) for p in self.probability]
        self.blocks = Blocks((2 * observable.bins + 2,))

    def observe(self, fluid: RunningFluid) -> None:
        """Take one sample."""
        scale = np.sqrt(fluid.masses(self.ids) / self.case.fluid.kT)
        u = fluid.velocities(self.ids) * scale[:, None]
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
            theory="Maxwell",
            comparisons=tuple(self._comparisons(mean[-2:], error[-2:])),
            samples=self.blocks.count,
            extra={"edges": self.edges.copy()},
        )

    def _start(self) -> Array:
        """How far each bin may be off for good in a fluid that keeps the energy it started with."""
        case, d = self.case, self.case.box.dimension
        if setting.isothermal(case) or case.walls or setting.driven(case):
            return np.zeros(self.probability.shape)
        warm = math.sqrt(2.0 / (d * case.particles * self.blocks.series))  # of kT, relative
        return np.stack([0.5 * warm * abs(self._flux(k)) for k in range(2)])

    def _expected(self) -> Array:
        known = [self.calm["component"], self.calm["speed"]]
        known = [k and self._thermal() for k in known]
        return np.where(np.array(known)[:, None], self.probability, np.nan)

    def _thermal(self) -> bool:
        """Whether the temperature is kT: held, or that of the start, which nothing changes."""
        return setting.isothermal(self.case) or not setting.driven(self.case)

    def _comparisons(self, mean: Array, error: Array) -> list[Comparison]:
        """Mean chi-square of a sample of each."""
        found = []
        for k, kind in enumerate(("component", "speed")):
            probability = chi_square.joined(self.probability[k], self.of[k])
            expected, spread = self._degrees(k, probability)
            if not (self.calm[kind] and self._thermal()):
                expected = math.nan
            name = f"v_{AXES[self.axis]}" if k == 0 else "speed"
            found.append(
                Comparison(
                    f"mean chi-square of {name}",
                    float(mean[k]),
                    float(np.hypot(error[k], spread)),
                    expected,
                    "",
                    self._note(len(probability)),
                )
            )
        return found

    def _note(self, number: int) -> str:
        if setting.driven(self.case):
            return "approximate: Maxwell about a mean flow"
        return setting.temperature_note(self.case) or f"{number} classes"

    def _degrees(self, k: int, probability: Array) -> tuple[float, float]:
        """Expected mean of chi-square, and by how much it differs from run to run for good.

        Where the total momentum is zero, a component loses what the mean of its numbers would take.
        A fluid that keeps its energy does so for each run alone: over many starts nothing is lost.
        """
        case, d = self.case, self.case.box.dimension
        degrees, part = len(probability) - 1.0, len(self.ids) / case.particles
        closed = not (case.walls or setting.driven(case))
        if k == 0 and closed:
            masses = np.array([kind.mass for kind in case.fluid.kinds])
            weights = np.array([kind.density for kind in case.fluid.kinds])
            alike = (weights @ np.sqrt(masses)) ** 2 / (weights.sum() * (weights @ masses))
            alike *= case.fluid.density * case.fluid.mass / setting.mass_density(case)
            degrees -= part * alike * chi_square.taken(self._with_mean(), probability)
        if setting.isothermal(case) or not closed:
            return degrees, 0.0
        # energy of all components together, of which a single one sees a share 1/d
        lost = part * chi_square.taken(self._with_energy(k), probability) / (1 if k else d)
        return degrees, math.sqrt(2.0 / self.blocks.series) * lost

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
