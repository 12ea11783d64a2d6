"""A method whose spheres fly freely: its cases, trajectories and pictures are those of spheres."""

from __future__ import annotations

import numpy as np

from mesokit.case.component import param
from mesokit.geometry.shape import Wall
from mesokit.method.spheres.common.groups import groups
from mesokit.method.spheres.common.made import made
from mesokit.method.spheres.common.section import Spheres
from mesokit.method.spheres.common.start.first_state import thermal_spins, thermal_velocities
from mesokit.observe import Observable
from mesokit.seam.method import InitialState, Method, Summary

NAME, TIMESTEP = "flying-spheres", 0.1


class Sections:
    """What its cases have."""

    spheres: Spheres = param(Spheres(), doc="the spheres")
    walls: tuple[Wall, ...] = param((), doc="walls")


class Flying:
    """Its engine."""

    def __init__(self, case, threads=1):
        self.case, self.made = case, made(case)
        self.box, self.dimension = np.array(case.box.size, float), case.box.dimension
        self.n, self.step, self.seconds = case.particles, 0, {"flight": 0.0}

    def start(self, placed):
        seed, kT = self.case.run.seed, self.case.spheres.kT
        self.r = placed.positions.copy()
        self.d = self.made.diameters if placed.diameters is None else placed.diameters
        drawn = thermal_velocities(seed, self.made, kT, self.dimension)
        self.v = drawn if placed.velocities is None else placed.velocities
        drawn = thermal_spins(seed, self.made, kT, self.dimension)
        self.w = drawn if placed.spins is None else placed.spins

    def advance(self, steps, measure=()):
        self.step += steps
        self.r += steps * TIMESTEP * self.v

    def check(self):
        pass

    def end_warmup(self):
        pass

    @property
    def time(self):
        return self.step * TIMESTEP

    def positions(self, ids=None, unwrapped=False):
        r = self.r[slice(None) if ids is None else ids]
        return r.copy() if unwrapped else r % self.box

    def images(self, ids=None):
        return np.floor(self.r / self.box)[slice(None) if ids is None else ids].astype(np.int32)

    def velocities(self, ids=None):
        return self.v[slice(None) if ids is None else ids]

    def spins(self, ids=None):
        return self.w[slice(None) if ids is None else ids]

    def masses(self, ids=None):
        return self.made.masses[slice(None) if ids is None else ids]

    def diameters(self, ids=None):
        return self.d[slice(None) if ids is None else ids]

    def state(self):
        return {"r": self.r, "v": self.v, "w": self.w, "d": self.d, "step": np.array(self.step)}

    def restore(self, state):
        self.r, self.v, self.w, self.d = (state[name].copy() for name in "rvwd")
        self.step = int(state["step"])


METHOD = Method(
    name=NAME,
    sections=Sections,
    observables=(Observable,),
    check=lambda case: case.spheres.check(case.box),
    groups=groups,
    timestep=lambda case: TIMESTEP,
    summary=lambda case, threads: Summary((), (), 1.0),
    initial=InitialState(
        lambda case, arrays: case.spheres.start.place(case, made(case)), Flying.start
    ),
    engine=lambda case, threads, measures: Flying(case),
)
