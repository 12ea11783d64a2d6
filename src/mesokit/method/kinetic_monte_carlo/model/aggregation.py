"""Diffusion-limited aggregation: walkers that stick to a cluster when they touch it."""

from collections.abc import Sequence
from typing import Literal

from mesokit.case.case import Case
from mesokit.case.component import component, param, show, tag
from mesokit.errors import CaseError
from mesokit.method.kinetic_monte_carlo.model.hop import diffusion_rows
from mesokit.method.kinetic_monte_carlo.model.table import Counts, Process, TableModel
from mesokit.seam.method import Row

EMPTY, WALKER, CLUSTER, OUTSIDE = 0, 1, 2, 3


@component
class Aggregation(TableModel):
    """Empty sites, walkers, and a cluster that grows by the walkers that reach it.

    A walker hops to each empty neighbour with the rate `hop_rate`. Beside the cluster it becomes a
    part of it with the probability `sticking`, and else hops on. Few walkers make the cluster of
    Witten and Sander, Phys. Rev. Lett. 47, 1400 (1981), with the fractal dimension 1.71 in a plane.
    Many fill space behind a rough front (R. F. Voss, J. Stat. Phys. 36, 861 (1984)).
    """

    rule: Literal["aggregation"] = tag("aggregation")
    hop_rate: float = param(1.0, doc="hops of a walker to each neighbour", unit="1/time", gt=0)
    sticking: float = param(1.0, doc="probability to stick instead of a hop", gt=0, le=1)
    reservoir: float | None = param(
        None, doc="part of the sites with walkers beyond the ends (closed unless said)", ge=0, le=1
    )

    def check(self, case: Case) -> None:
        """Raise CaseError for a reservoir beyond ends that there are not."""
        if self.reservoir is not None and not case.lattice.ends:
            raise CaseError(
                f"lattice.model.reservoir = {show(self.reservoir)}: only where the lattice ends; "
                "give lattice.ends"
            )

    def states(self) -> tuple[str, ...]:
        return "empty", "walker", "cluster"

    def processes(self) -> list[Process]:
        """Hops, sticking, and the passage of walkers through the ends."""
        found = [
            Process("stick", (WALKER, CLUSTER), self._stick, ((EMPTY,), (CLUSTER,))),
            Process("hop", (WALKER, EMPTY), self._hop, ((CLUSTER,),), ((EMPTY,), WALKER)),
        ]
        if self.reservoir is not None:
            out, share = ((OUTSIDE,), OUTSIDE), self.hop_rate * self.reservoir
            found += [
                Process("enter", (EMPTY, WALKER), share, (), out),
                Process("leave", (WALKER, EMPTY), self.hop_rate - share, (), out),
            ]
        return [one for one in found if one.rate]

    def derived(self, case: Case) -> Sequence[Row]:
        return diffusion_rows(case.lattice.lattice, self.hop_rate, 0.0)

    def _stick(self, counts: Counts) -> float:
        # what hops would have without the cluster, times the probability
        often = self.sticking * self.hop_rate * max(counts[EMPTY], 1)
        return often if counts[CLUSTER] else 0.0

    def _hop(self, counts: Counts) -> float:
        return self.hop_rate * (1 - self.sticking if counts[CLUSTER] else 1.0)
