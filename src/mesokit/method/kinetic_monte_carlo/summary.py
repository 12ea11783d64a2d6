"""Derived numbers of a case on a lattice, cost, and warnings."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from mesokit.case.amounts import duration_text, number, size_text
from mesokit.case.case import Case
from mesokit.case.component import name_of
from mesokit.case.trajectory import stored_bytes
from mesokit.case.warnings import run_warnings
from mesokit.method.kinetic_monte_carlo.engine.classes import FAN
from mesokit.method.kinetic_monte_carlo.lattice.grid import TILE
from mesokit.method.kinetic_monte_carlo.start import RunStart, sites_of
from mesokit.seam.method import Row, Summary

SECONDS = 0.2e-6  # of a thread for an event, where the project measures (docs/benchmark.md)
LONGEST = 1e10  # seconds: longer ones are not told apart
EQUILIBRIUM = {  # what theory expects in it alone
    "height-differences",
    "height-steps",
    "lattice-energy",
    "magnetisation",
    "site-correlation",
    "site-structure-factor",
}
BYTES = 4  # of memory for each site: its state, its surroundings and its class


def summary(case: Case, threads: int | None = None) -> Summary:
    """Derived numbers, cost, and warnings."""
    given, sites = case.lattice, sites_of(case)
    steps = case.run.warmup + case.run.steps
    table = given.model.kernel(given.lattice, bool(given.ends))
    distinct = np.unique(table.rates[table.rates > 0])
    # how many events there will be depends on the states: at most these, were all sites the fastest
    most = float(distinct.max()) * sites * steps * given.timestep
    seconds = most * SECONDS
    nodes = -(-sites // (TILE * FAN)) * FAN
    memory = sites * (BYTES + 8) + 5 * nodes * len(distinct) + 150_000_000
    stored = stored_bytes(case.trajectory, case.groups, case.box.dimension, case.run.steps)
    rows: list[Row] = [
        ("sites", f"{sites:,}".replace(",", " "), f"{given.kind}, {table_neighbours(case)}"),
        ("model", name_of(given.model), f"{len(given.model.events())} processes"),
        ("rates of a site", f"{len(distinct)}", f"{number(distinct.min())} to "
         f"{number(distinct.max(), '1/time')}: chosen by classes"),
        ("time of the run", number(steps * given.timestep, "time"), f"{steps} slices"),
        ("events", f"< {number(most)}", "were all sites the fastest"),
        ("run time", f"< {duration_text(min(seconds, LONGEST))}", "estimate: 1 thread"),
        ("memory", size_text(memory), "estimate"),
    ]  # fmt: skip
    if stored:
        rows.append(("trajectory", size_text(stored), "estimate"))
    warnings = [*run_warnings(case, memory, stored), *_warnings(case, float(distinct.max()))]
    return Summary(tuple(rows), tuple(warnings), seconds, {"sites": sites}, memory)


def table_neighbours(case: Case) -> str:
    """Neighbours of a site in words."""
    return f"{case.lattice.lattice.neighbours} neighbours"


def _warnings(case: Case, fastest: float) -> Iterator[str]:
    per_slice = fastest * case.lattice.timestep * sites_of(case)
    if per_slice < 1:
        yield (
            f"lattice.timestep: at most {per_slice:.2g} events in a step on average; "
            "a longer timestep costs less"
        )
    waits = [one.label for one in case.observe if name_of(one) in EQUILIBRIUM]
    if case.run.warmup == 0 and waits and not isinstance(case.lattice.first(), RunStart):
        yield (
            f"run.warmup = 0: equilibrium takes time, and means of {waits[0]} count from the first "
            "step"
        )
