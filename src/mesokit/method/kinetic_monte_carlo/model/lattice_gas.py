"""A lattice gas: species that adsorb, desorb, hop and react, as a list of processes."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import Literal

from pydantic import model_validator

from mesokit.case.case import Case
from mesokit.case.component import component, one_of, param, show, tag
from mesokit.case.describe.hints import Many
from mesokit.errors import CaseError
from mesokit.method.kinetic_monte_carlo.model.table import Counts, Process, TableModel

OUTSIDE = "outside"  # the name of what is beyond the end of a lattice


@component
class GasProcess:
    """What may happen at a site, or at a site and one of its neighbours.

    Its rate is rate * exp(-(barrier + n bond) / kT), where n is the number of neighbours of the
    site in the states `bonded`; a process with a neighbour has it for each neighbour that fits.
    """

    name: str = param(doc="name in results", min_length=1)
    site: str = param(doc="state of the site before and after, such as 'empty -> CO'")
    neighbour: str | None = param(
        None,
        doc="state of a neighbour before and after (none takes part unless said); 'outside' is "
        "what is beyond the end of the lattice",
    )
    rate: float = param(doc="rate, or that without the barrier", unit="1/time", ge=0, le=1e300)
    barrier: float = param(0.0, doc="energy of the barrier", unit="energy")
    bond: float = param(0.0, doc="added to the barrier for each bonded neighbour", unit="energy")
    bonded: Many[str] = param((), doc="states of neighbours that have a bond to the site")


@component
class LatticeGas(TableModel):
    """Sites that are empty or hold one of several species, and a list of what may happen."""

    rule: Literal["lattice-gas"] = tag("lattice-gas")
    species: Many[str] = param(
        ("empty", "A"), doc="names of the states of a site", min_length=2, max_length=8
    )
    process: Many[GasProcess] = param(doc="what may happen", min_length=1, max_length=64)
    kT: float = param(1.0, doc="thermal energy, for barriers", unit="energy", gt=0)

    @model_validator(mode="after")
    def _known_species(self) -> LatticeGas:
        if len(set(self.species)) < len(self.species) or OUTSIDE in self.species:
            raise ValueError(
                f"species = {show(list(self.species))}: expected different names, none of them "
                f"{show(OUTSIDE)}"
            )
        names = [one.name for one in self.process]
        for k, one in enumerate(self.process):
            key = f"process[#{k + 1}]"
            if names.index(one.name) < k:
                raise ValueError(f"{key}.name = {show(one.name)}: expected a name of its own")
            before, after = self._turn(f"{key}.site", one.site, self.species)
            if one.neighbour is not None:
                first, last = self._turn(
                    f"{key}.neighbour", one.neighbour, (*self.species, OUTSIDE)
                )
                if (first == OUTSIDE) != (last == OUTSIDE):
                    raise ValueError(
                        f"{key}.neighbour = {show(one.neighbour)}: what is outside stays so; "
                        "expected 'outside -> outside'"
                    )
                if before == after and first == last:
                    raise ValueError(f"{key}: it changes nothing")
            elif before == after:
                raise ValueError(f"{key}.site = {show(one.site)}: it changes nothing")
            for name in one.bonded:
                if name not in self.species:
                    raise ValueError(
                        f"{key}.bonded = {show(list(one.bonded))}: expected some of "
                        f"{one_of(self.species)}"
                    )
            if one.bond and not one.bonded:
                raise ValueError(f"{key}.bond = {show(one.bond)}: only with bonded")
        return self

    @staticmethod
    def _turn(key: str, text: str, known: tuple[str, ...]) -> tuple[str, str]:
        parts = [part.strip() for part in re.split("->", text)]
        if len(parts) != 2 or not set(parts) <= set(known):
            raise ValueError(
                f"{key} = {show(text)}: expected 'before -> after', of {one_of(known)}"
            )
        return parts[0], parts[1]

    def check(self, case: Case) -> None:
        """Raise CaseError for what happens at ends that there are not."""
        for k, one in enumerate(self.process):
            if one.neighbour is not None and OUTSIDE in one.neighbour and not case.lattice.ends:
                raise CaseError(
                    f"lattice.model.process[#{k + 1}].neighbour = {show(one.neighbour)}: only "
                    "where the lattice ends; give lattice.ends"
                )

    def states(self) -> tuple[str, ...]:
        return self.species

    def processes(self) -> list[Process]:
        """Those of the list."""
        number = {name: k for k, name in enumerate((*self.species, OUTSIDE))}

        def turn(text: str) -> tuple[int, int]:
            before, after = (number[part.strip()] for part in text.split("->"))
            return before, after

        def beside(text: str) -> tuple[tuple[int, ...], int]:
            before, after = turn(text)
            return (before,), after

        return [
            Process(
                one.name,
                turn(one.site),
                self._rate(one, [number[name] for name in one.bonded]),
                (tuple(number[name] for name in one.bonded),) if one.bonded else (),
                None if one.neighbour is None else beside(one.neighbour),
            )
            for one in self.process
        ]

    def _rate(self, one: GasProcess, bonded: list[int]) -> Callable[[Counts], float]:
        def rate(counts: Counts) -> float:
            bonds = counts[bonded[0]] if bonded else 0
            return one.rate * math.exp(-(one.barrier + bonds * one.bond) / self.kT)

        return rate
