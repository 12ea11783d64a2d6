"""A lattice gas: species that adsorb, desorb, hop and react, as a list of processes."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator

from mesokit.case.case import Case
from mesokit.case.component import component, one_of, param, show, tag
from mesokit.case.describe.hints import Many
from mesokit.errors import CaseError
from mesokit.method.kinetic_monte_carlo.model.protocol import Energies, Known
from mesokit.method.kinetic_monte_carlo.model.table import Counts, Process, TableModel

LARGEST = 700.0  # exponents beyond it have no number
OUTSIDE = "outside"  # the name of what is beyond the end of a lattice
Turn = tuple[int, int]  # states before and after


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
            exponent = -(one.barrier + bonds * one.bond) / self.kT
            return one.rate * (math.exp(exponent) if exponent < LARGEST else math.inf)

        return rate

    def energies(self) -> Energies | None:
        """That of an equilibrium, if every process has its reverse and all bonds agree.

        Bonds are those before a process: a site with n bonds has the energy -n bond. Energies of
        states follow from the ratio of the rates of each process and of its reverse.
        """
        found = [one for one in zip(self.process, self.processes(), strict=True) if one[0].rate]
        pair: dict[tuple[int, int], float] = {}
        for given, process in found:
            if process.site[0] != process.site[1]:
                for k, name in enumerate(self.species):
                    bond = -given.bond if name in given.bonded else 0.0
                    if pair.setdefault((process.site[0], k), bond) != bond:
                        return None
        every = range(len(self.species))
        pairs = np.array([[pair.get((a, b), pair.get((b, a), 0.0)) for b in every] for a in every])
        sites = self._of_states([process for _, process in found])
        return Energies(sites, pairs) if sites is not None and (pairs == pairs.T).all() else None

    def _of_states(self, processes: Sequence[Process]) -> NDArray[np.float64] | None:
        """Energies of states; None if a process has no reverse, or if they contradict."""
        rates: dict[tuple[Turn, ...], float] = {}
        without_bonds = [0] * (len(self.species) + 1)
        for one in processes:
            rate = one.rate(without_bonds) if callable(one.rate) else one.rate
            turns = [one.site]
            if one.neighbour is not None:
                turns.append((one.neighbour[0][0], one.neighbour[1]))
                rate *= 1 + (turns[0] == turns[1])  # it may begin at both sites
            key = tuple(sorted(turns))
            rates[key] = rates.get(key, 0.0) + rate
        rows, known = [], []
        for key, rate in rates.items():
            back = rates.get(tuple(sorted((after, before) for before, after in key)))
            if back is None:
                return None
            row = np.zeros(len(self.species) + 1)
            for before, after in key:
                row[after] += 1
                row[before] -= 1
            rows.append(row[1:-1])  # the first state has none, and what is outside stays
            known.append(-self.kT * math.log(rate / back))
        if not rows:
            return None
        energies = np.linalg.lstsq(np.array(rows), np.array(known), rcond=None)[0]
        if not np.allclose(np.array(rows) @ energies, known, rtol=1e-9, atol=1e-9 * self.kT):
            return None
        return np.concatenate([[0.0], energies])

    def expected(self, case: Case) -> Mapping[str, Known]:
        """Coverage and rates of one species that adsorbs, desorbs and hops, whatever is near."""
        full = math.nan if case.lattice.ends else self._langmuir()
        if math.isnan(full):
            return {}
        parts, z = (1 - full, full), case.lattice.lattice.neighbours
        found = {
            f"part {name}": (part, "Langmuir")
            for name, part in zip(self.species, parts, strict=True)
        }
        for one in self.processes():
            rate = one.rate(()) if callable(one.rate) else one.rate
            before = parts[one.site[0]]
            there = z * (1 - before) if one.neighbour is not None else 1.0
            found[f"rate of {one.name}"] = rate * before * there, "Langmuir"
        return found

    def _langmuir(self) -> float:
        """Coverage where all states with as many particles are as likely (Langmuir 1918); nan of
        several species, and of rates that depend on neighbours."""
        if len(self.species) != 2:
            return math.nan
        adsorb = desorb = 0.0
        for one in self.processes():
            if one.counted:
                return math.nan
            rate = one.rate(()) if callable(one.rate) else one.rate
            if one.neighbour is None:
                adsorb += rate if one.site == (0, 1) else 0.0
                desorb += rate if one.site == (1, 0) else 0.0
            elif {one.site, (one.neighbour[0][0], one.neighbour[1])} != {(0, 1), (1, 0)}:
                return math.nan
        return adsorb / (adsorb + desorb) if adsorb + desorb > 0 else math.nan
