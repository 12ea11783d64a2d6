"""Kinetic Monte Carlo, as the record by which the package runs it."""

from collections.abc import Collection

import numpy as np

from mesokit.case.case import Case
from mesokit.case.trajectory import Group, Kind
from mesokit.method.kinetic_monte_carlo.checks import check
from mesokit.method.kinetic_monte_carlo.engine.engine import Events
from mesokit.method.kinetic_monte_carlo.engine.events import TIME
from mesokit.method.kinetic_monte_carlo.observe import LatticeObservable
from mesokit.method.kinetic_monte_carlo.section import Sections
from mesokit.method.kinetic_monte_carlo.start import files_of, first_state, sites_of
from mesokit.method.kinetic_monte_carlo.summary import summary
from mesokit.seam.method import Columns, InitialState, Method
from mesokit.seam.units import Units


def groups(case: Case) -> tuple[Group, ...]:
    """One group of sites."""
    closed = tuple(axis in case.lattice.ends for axis in case.box.axes)
    states = case.lattice.model.states()
    usual = {1: "space-time" if states else "profiles", 3: "occupied"}
    return (
        Group(
            "sites",
            (Kind(1.0, sites_of(case)),),
            has=("site",),
            picture=usual.get(case.box.dimension, "sites"),
            lattice=case.lattice.lattice.sites(tuple(map(int, case.box.size)), closed),
            states=states,
        ),
    )


def columns(case: Case) -> Columns:
    """The part of the sites in each state, and the events so far, for the log of a run."""
    states = case.lattice.model.states()
    names = states or ("height", "width")

    def read(engine: Events, wanted: Collection[str]) -> dict[str, float]:
        sites = engine.sites()
        parts = (
            np.bincount(sites, minlength=len(states)) / engine.n
            if states
            else (sites.mean(), sites.std())
        )
        values = dict(zip(names, map(float, parts), strict=True))
        values["events"] = float(engine.course.drawn[0]) - 1
        return {name: values[name] for name in wanted}

    return Columns((*names, "events"), ("events",), read)


def absorbed(engine: Events) -> float | None:
    """The time of the last event, if no other can follow; on sublattices, which have a time of
    their own each, that of the step."""
    if not engine.absorbed:
        return None
    return engine.time if engine.blocks is not None else float(engine.course.clock[TIME])


METHOD = Method(
    name="kinetic-monte-carlo",
    sections=Sections,
    observables=(LatticeObservable,),
    check=check,
    groups=groups,
    timestep=lambda case: float(case.lattice.timestep),
    dimensions=(1, 2, 3),
    summary=summary,
    initial=InitialState(first_state, Events.start, ("states",), files_of, "lattice.start.run"),
    engine=lambda case, threads, measures: Events(case, threads, measures),
    log=columns,
    absorbed=absorbed,
    units=Units(length="a"),  # the distance of neighbours
)
