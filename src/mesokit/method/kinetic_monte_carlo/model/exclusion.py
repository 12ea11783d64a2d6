"""The simple exclusion process: particles that hop to empty neighbours (Spitzer 1970)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

from mesokit import theory
from mesokit.case.case import Case
from mesokit.case.component import component, param, show, tag
from mesokit.errors import CaseError
from mesokit.method.kinetic_monte_carlo.model.protocol import Known
from mesokit.method.kinetic_monte_carlo.model.table import Process, TableModel
from mesokit.method.kinetic_monte_carlo.start import sites_of

EMPTY, FULL, OUTSIDE = 0, 1, 2
FORWARD, BACKWARD = (0,), (1,)  # directions along x


@component
class Exclusion(TableModel):
    """Particles on a chain, at most one at a site, that hop forward and backward.

    Where the chain ends, particles enter at the first site and leave at the last one. With
    backward = 0 it is totally asymmetric (TASEP), with equal rates symmetric (SSEP).
    """

    rule: Literal["exclusion"] = tag("exclusion")
    forward: float = param(1.0, doc="rate of hops along x", symbol="p", unit="1/time", ge=0)
    backward: float = param(0.0, doc="rate of hops against x", symbol="q", unit="1/time", ge=0)
    enter: float = param(
        0.0, doc="rate at which particles enter an empty first site", unit="1/time", ge=0
    )
    leave: float = param(
        0.0, doc="rate at which particles leave the last site", unit="1/time", ge=0
    )
    enter_last: float = param(
        0.0, doc="rate at which particles enter an empty last site", unit="1/time", ge=0
    )
    leave_first: float = param(
        0.0, doc="rate at which particles leave the first site", unit="1/time", ge=0
    )

    def check(self, case: Case) -> None:
        """Raise CaseError for another lattice than a chain, and for ends of a ring."""
        if case.lattice.kind != "chain":
            raise CaseError(
                f"lattice.kind = {show(case.lattice.kind)}: expected 'chain' for model 'exclusion'"
            )
        for key in ("enter", "leave", "enter_last", "leave_first"):
            if getattr(self, key) and not case.lattice.ends:
                raise CaseError(
                    f"lattice.model.{key} = {show(getattr(self, key))}: only where the lattice "
                    'ends; give lattice.ends = ["x"]'
                )

    def states(self) -> tuple[str, ...]:
        return "empty", "particle"

    def processes(self) -> list[Process]:
        """Hops, and what happens at the ends."""
        out = (OUTSIDE,), OUTSIDE
        every = [
            Process("enter", (EMPTY, FULL), self.enter, (), out, BACKWARD),
            Process("enter last", (EMPTY, FULL), self.enter_last, (), out, FORWARD),
            Process("forward", (FULL, EMPTY), self.forward, (), ((EMPTY,), FULL), FORWARD),
            Process("backward", (FULL, EMPTY), self.backward, (), ((EMPTY,), FULL), BACKWARD),
            Process("leave", (FULL, EMPTY), self.leave, (), out, FORWARD),
            Process("leave first", (FULL, EMPTY), self.leave_first, (), out, BACKWARD),
        ]
        return [one for one in every if one.rate]

    def expected(self, case: Case) -> Mapping[str, Known]:
        """The exact current of a chain that is totally asymmetric and open at both ends."""
        driven = self.forward > 0 and not (self.backward or self.enter_last or self.leave_first)
        if not (driven and case.lattice.ends and self.enter > 0 and self.leave > 0):
            return {}
        sites, note = sites_of(case), "Derrida et al. 1993"
        current = self.forward * theory.open_current(
            sites, self.enter / self.forward, self.leave / self.forward
        )
        return {
            "rate of enter": (current / sites, note),
            "rate of leave": (current / sites, note),
            "rate of forward": (current * (sites - 1) / sites, note),
        }
