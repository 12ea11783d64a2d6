"""Distribution of the forces of contacts between grains."""

from collections.abc import Iterator
from typing import Any, ClassVar, Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.errors import CaseError
from mesokit.method.spheres.common.observe.bearing import GroupAccumulator, OfContacts
from mesokit.seam.engine import TouchingSpheres
from mesokit.seam.observable import accumulator_of
from mesokit.seam.result import Comparison, Result

SLIDES = 0.999  # of the largest tangential force: a contact that slides
AXES = {"normal": "force", "friction": "mobilisation"}
WORDS = {"normal": "normal force over the mean", "friction": "share of the largest friction"}
COUNT, FORCE, WEAK, STRONG, EXCESS, PULLED, SHARE, SLIDING, BINS = range(9)  # columns of sums


@component
class ContactForces(OfContacts):
    """Distribution of the forces of contacts between grains, those with walls left out.

    `of = "normal"` is that of normal forces over their mean at each time. Above the mean it falls
    exponentially, exp(-beta f), in dense packings under pressure; beta is 1.4 in 2D (Radjai, Jean,
    Moreau and Roux 1996) and 1.5 at walls in 3D (Mueth, Jaeger and Nagel 1998). Under gravity
    forces grow with depth, so the distribution is wider. `of = "friction"` is that of tangential
    forces over the largest, the friction coefficient times the normal force: 1 where a contact
    slides. Error bars are those of groups of grains, or of blocks of time if these are larger.
    """

    quantity: Literal["contact-forces"] = tag("contact-forces")
    drawing, value_label = "histogram", "probability density"
    units: ClassVar[dict[str, str]] = {"force": "", "mobilisation": ""}
    of: Literal["normal", "friction"] = param("normal", doc="which forces")
    bins: int = param(40, doc="of the histogram", ge=4, le=1000)
    largest: float = param(
        8.0, doc="normal force at the end of the histogram, over the mean", unit="", ge=1, le=1000
    )

    def check(self, case: Case) -> None:
        """Raise CaseError without lasting contacts, and for friction that there is not."""
        super().check(case)
        if case.particles < 2:
            raise CaseError("1 sphere; expected 2 at least")
        if self.of == "friction" and not case.spheres.pair_friction:
            raise CaseError("of = 'friction': contacts have none; expected 'normal'")


@accumulator_of(ContactForces)
class ContactForcesAccumulator(GroupAccumulator):
    """Sums over contacts, by group of their first grain."""

    def prepare(self) -> None:
        observable = self.observable
        end = observable.largest if observable.of == "normal" else 1.0
        self.edges = np.linspace(0.0, end, observable.bins + 1)
        self.friction = float(self.case.spheres.pair_friction)
        self.width = BINS + observable.bins
        super().prepare()

    def observe(self, spheres: TouchingSpheres) -> None:
        found = self.contacts_of(spheres, walls=False)
        if not len(found.normal):
            return
        f = found.normal / found.normal.mean()
        share = np.zeros(len(f))
        if self.friction:
            share = np.minimum(found.tangential / (self.friction * found.normal), 1.0)
        rows = np.zeros((len(f), self.width))
        rows[:, COUNT], rows[:, FORCE] = 1.0, found.normal
        rows[:, WEAK], rows[:, STRONG], rows[:, EXCESS] = f < 1, f > 1, np.maximum(f - 1, 0.0)
        rows[:, PULLED] = found.pulled / len(f)
        rows[:, SHARE], rows[:, SLIDING] = share, share > SLIDES
        # The last bin of friction has its upper edge; normal forces beyond the last bin count in
        # the number of contacts alone, so that densities are those of all.
        value = f if self.observable.of == "normal" else np.minimum(share, 1 - 1e-12)
        place = np.searchsorted(self.edges, value, "right") - 1
        inside = place < self.observable.bins
        rows[np.flatnonzero(inside), BINS + place[inside]] = 1.0
        self.add(found.pairs[:, 0], rows)

    def result(self) -> Result:
        """The probability density, and numbers of it."""
        of, width = self.observable.of, self.edges[1] - self.edges[0]
        if self.blocks.count:
            density = self.ratio(slice(BINS, None), COUNT).divided(width)
            value, error = density.value, density.error
        else:
            value = error = np.full(self.observable.bins, np.nan)
        return self.report(
            {AXES[of]: 0.5 * (self.edges[1:] + self.edges[:-1])},
            (value, error),
            self.comparisons(),
            extra={
                "edges": self.edges.copy(),
                "of": WORDS[of],
                "logarithmic": of == "normal",
                **self.decay(),
            },
        )

    def decay(self) -> dict[str, Any]:
        """An exponential above the mean that has as many forces, and the same mean, as measured."""
        if self.observable.of == "friction" or not self.blocks.count:
            return {}
        count, strong, excess = self.blocks.mean().sum(axis=0)[[COUNT, STRONG, EXCESS]]
        if not excess > 0:
            return {}
        beta, middle = strong / excess, 0.5 * (self.edges[1:] + self.edges[:-1])
        beyond = np.where(middle > 1, middle - 1, np.nan)
        beside = strong / count * beta * np.exp(-beta * beyond)
        return {"beside": beside, "beside_label": f"exponential above the mean, beta = {beta:.2f}"}

    def comparisons(self) -> Iterator[Comparison]:
        """Mean force, decay above the mean, weak contacts; or friction that is mobilised."""

        def share(what: str, column: int, note: str = "") -> Comparison:
            found = self.ratio(slice(column, column + 1), COUNT)
            return Comparison(what, found.value[0], found.error[0], note=note)

        mean = self.ratio(slice(FORCE, FORCE + 1), COUNT)
        unit = "m a/tau^2"
        yield Comparison("mean normal force", mean.value[0], mean.error[0], unit=unit)
        if self.observable.of == "friction":
            yield share("mean share of the largest friction", SHARE)
            yield share("share of contacts that slide", SLIDING)
            return
        decay = self.ratio(slice(STRONG, STRONG + 1), EXCESS)
        note = "of exp(-beta f); 1.4 to 1.5 of packings under pressure"
        yield Comparison("decay above the mean, beta", decay.value[0], decay.error[0], note=note)
        yield share("share of contacts below the mean", WEAK)
        if self.blocks.mean()[:, PULLED].any():
            yield share("contacts that pull, for each that pushes", PULLED)
