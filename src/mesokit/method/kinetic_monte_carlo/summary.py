"""Derived numbers of a case on a lattice, cost, and warnings."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from mesokit.case.amounts import duration_text, number, size_text
from mesokit.case.case import Case
from mesokit.case.component import name_of, show
from mesokit.case.trajectory import stored_bytes
from mesokit.case.warnings import run_warnings
from mesokit.method.kinetic_monte_carlo.engine.select import selected
from mesokit.method.kinetic_monte_carlo.expected import known_mean
from mesokit.method.kinetic_monte_carlo.lattice.grid import TILE
from mesokit.method.kinetic_monte_carlo.model.balance import detailed_balance
from mesokit.method.kinetic_monte_carlo.model.first_rates import first_rate
from mesokit.method.kinetic_monte_carlo.start import RandomStart, UniformStart, sites_of
from mesokit.seam.method import Row, Summary

# of a thread for an event, or an attempt, where the project measures (docs/benchmark.md)
SECONDS = {
    "classes": 0.17e-6,
    "groups": 0.25e-6,
    "tree": 0.3e-6,
    "attempts": 0.08e-6,
    "linear": 1e-9,  # and for each site
}
WORDS = {
    "classes": "by classes",
    "groups": "by groups of rates within a factor of two",
    "tree": "by a tree of sums",
    "attempts": "by attempts",
    "linear": "by a walk over all sites",
}
SECONDS_OF_CYCLE = 3e-6  # of a block in sublattices without an event
LONG = 30 * 86400.0  # a run that hardly anyone means
LONGEST = 1e10  # seconds: longer ones are not told apart
EQUILIBRIUM = {  # what theory expects in it alone
    "height-differences",
    "height-steps",
    "lattice-energy",
    "magnetisation",
    "site-correlation",
    "site-structure-factor",
}
LENGTHS = 6  # correlation lengths that a box should have along each axis
BYTES = 4  # of memory for each site: its state, its surroundings and its class


def summary(case: Case, threads: int | None = None) -> Summary:
    """Derived numbers, cost, and warnings."""
    given, sites = case.lattice, sites_of(case)
    steps = case.run.warmup + case.run.steps
    table = given.model.kernel(given.lattice, bool(given.ends))
    distinct = np.unique(table.rates[table.rates > 0])
    # how many events there will be depends on the states: at most these, were all sites the fastest
    time = steps * given.timestep
    most = float(distinct.max()) * sites * time
    total = first_rate(case)
    usual, note = (total or 0.0) * time, "were all sites the fastest"
    if total:
        note = f"as frequent as at the start; {note}"
    select = selected(given.select, table.rates)
    each = SECONDS[select] * (sites if select == "linear" else 1)
    at_once = 1 if given.sublattices is None else min(threads or 1, sites // blocks_of(case))
    cycles = cycles_of(case, table.rates) * SECONDS_OF_CYCLE * sites / blocks_of(case) / at_once
    shortest, longest = (
        duration_text(min(events * each / at_once + cycles, LONGEST)) for events in (usual, most)
    )
    seconds = (usual if total else most) * each / at_once + cycles
    rates = {"classes": 10 * len(distinct) / TILE, "tree": 32.0, "linear": 8.0}.get(select, 0.0)
    memory = int(sites * (BYTES + 8 + rates)) + 150_000_000
    stored = stored_bytes(case.trajectory, case.groups, case.box.dimension, case.run.steps)
    rows: list[Row] = [
        ("sites", f"{sites:,}".replace(",", " "), f"{given.kind}, {table_neighbours(case)}"),
        ("model", name_of(given.model), f"{len(given.model.events())} processes"),
        ("rates of a site", f"{len(distinct)}", f"{number(distinct.min())} to "
         f"{number(distinct.max(), '1/time')}"),
        ("choice of events", WORDS[select], f"{number(each, 's')} each, estimate"),
        *given.model.derived(case),
        *_rows(case, total),
        ("time of the run", number(time, "time"), f"{steps} slices"),
        ("events", f"{number(usual)} to {number(most)}" if total else f"< {number(most)}", note),
        ("run time", f"{shortest} to {longest}" if total else f"< {longest}",
         threads_text(at_once)),
        ("memory", size_text(memory), "estimate"),
    ]  # fmt: skip
    if given.sublattices is not None:
        block = given.sublattices.of(len(case.box.size))
        per_step = number(cycles_of(case, table.rates) / max(steps, 1))
        rows.append(
            (
                "sublattices",
                f"blocks of {block} sites",
                f"cycles in a step: {per_step}; approximate",
            )
        )
    if stored:
        rows.append(("trajectory", size_text(stored), "estimate"))
    warnings = [*run_warnings(case, memory, stored), *_warnings(case, float(distinct.max()))]
    if seconds > LONG:
        warnings.append(
            f"lattice.timestep: the run takes {duration_text(min(seconds, LONGEST))} or more; "
            "a shorter time, or slower rates, cost less"
        )
    return Summary(tuple(rows), tuple(warnings), seconds, {"sites": sites}, memory)


def threads_text(number: int) -> str:
    """On how many threads a time is estimated."""
    return f"estimate: {number} thread{'s' if number > 1 else ''}"


def cycles_of(case: Case, rates: NDArray[np.float64]) -> float:
    """Cycles of sublattices in the run, 0 without them."""
    given, steps = case.lattice, case.run.warmup + case.run.steps
    if given.sublattices is None:
        return 0.0
    return steps * max(1.0, math.ceil(given.timestep / given.cycle(rates)))


def blocks_of(case: Case) -> int:
    """Sites of a block of sublattices."""
    given = case.lattice.sublattices
    return given.of(len(case.box.size)) ** len(case.box.size) if given is not None else 1


def _rows(case: Case, total: float | None) -> Iterator[Row]:
    """Rows on the first state, on equilibrium and on correlations, where these are known."""
    if total:
        note = f"at the start: the first comes after {number(1 / total, 'time')} on average"
        yield "rate of all events", number(total, "1/time"), note
    elif total == 0:
        yield "rate of all events", "0", "at the start: nothing happens"
    broken = detailed_balance(case)
    if broken is not None:
        note = (
            f"broken by process {broken}: there is no equilibrium"
            if broken
            else "of the moves of small patches"
        )
        yield "detailed balance", "broken" if broken else "holds", note
    length, note = known_mean(case, "correlation length")
    if not math.isnan(length):
        yield "correlation length", number(length, "sites"), note


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
    given = case.lattice
    if given.sublattices is not None and (given.sublattices.cycle or 0.0) * fastest > 1:
        yield (
            f"lattice.sublattices.cycle = {number(given.sublattices.cycle or 0.0)}: more than the "
            f"mean wait of the fastest site, {number(1 / fastest)}; errors grow with the cycle"
        )
    length, _ = known_mean(case, "correlation length")
    if length == math.inf:
        yield "lattice.model.kT: at the critical point all means depend on the size of the lattice"
    elif LENGTHS * length > min(case.box.size):
        yield (
            f"box.size = {show(list(case.box.size))}: spins are correlated over {number(length)} "
            f"sites; expected at least {LENGTHS} times as many along each axis"
        )
    waits = [one.label for one in case.observe if name_of(one) in EQUILIBRIUM]
    # other starts are patterns or states that somebody has made, whose course is of interest
    drawn = isinstance(case.lattice.first(), RandomStart | UniformStart)
    if case.run.warmup == 0 and waits and drawn:
        yield (
            f"run.warmup = 0: equilibrium takes time, and means of {waits[0]} count from the first "
            "step"
        )
