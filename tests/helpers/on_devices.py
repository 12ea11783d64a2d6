"""The same fluid on the threads of a processor and on a device, which must have the same bits."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from mesokit import (
    AT,
    SRD,
    ATPlusA,
    Demix,
    MaxwellBoltzmann,
    NoCollision,
    NoThermostat,
    Species,
)
from mesokit.case.shear import HISTORIES
from mesokit.devices.compile import Chip
from mesokit.devices.emulated import Emulated
from mesokit.devices.recorded import Recorded
from mesokit.method.mpcd.collision import RULES
from mesokit.method.mpcd.engine.cpu.engine import CPU
from mesokit.method.mpcd.engine.cuda.engine import CUDA
from mesokit.method.mpcd.field import RULES as FORCES
from mesokit.method.mpcd.start.fluid import start
from mesokit.method.mpcd.thermostat import RULES as THERMOSTATS
from tests.helpers.small_fluids import assert_same, example, make_case

STEPS = 12  # one more sort than that at the start, at this timestep
TIMESTEP = 0.5
PARTS = {"collision", "thermostat", "force", "shear"}
OF_ONE_MASS: dict[str, Any] = {"species": (Species(mass=1, density=4), Species(mass=1, density=4))}


class Pair(NamedTuple):
    """Two engines of one case, at their start."""

    cpu: CPU
    on_device: CUDA

    def advance(self, steps: int, measure: Sequence[str] = ()) -> None:
        """Run some steps on both."""
        self.cpu.advance(steps, measure)
        self.on_device.advance(steps, measure)

    def require_same(self) -> None:
        """Raise AssertionError unless both have the same bits and the same readings."""
        one, other = self.cpu.state(), self.on_device.state()
        assert one.keys() == other.keys()
        assert_same(one.values(), other.values())
        assert_same(readings(self.cpu), readings(self.on_device))


def pair(device: Any, measures: Sequence[str] = (), **parts: Any) -> Pair:
    """The engines of a small fluid."""
    case = make_case(**parts)
    made = Pair(CPU(case, 1, measures), CUDA(case, device, measures))
    for engine in made:
        start(engine)
    return made


def record(file: Path, chip: Chip, **parts: Any) -> None:
    """Write the tape of a small fluid, which expects its rows in the order of particles.

    Places and velocities of beads are expected in the order of the first.
    """
    recorded = Recorded(Emulated(chip))
    measures = ("stress",)  # as tests of bulk fluids have, which share the kernels
    engine = CUDA(make_case(**parts), recorded, measures)
    start(engine)
    engine.advance(STEPS, measures)
    rows = engine.memory.fluid
    reals = [(row, "float64") for row in (*rows.r, *rows.v)]
    wholes = [(row, "int32") for row in (rows.ident, *rows.image)]
    recorded.expect(engine.n, [*wholes, *reals])
    if (beads := engine.memory.beads) is not None:
        of_beads = [(row, "float64") for row in (beads.group.r, beads.group.v)]
        recorded.expect(beads.number * engine.dimension, of_beads)
    recorded.save(file, steps=STEPS)


def readings(fluid: Any) -> list[Any]:
    """All that an observable may read."""
    d = fluid.dimension
    waves = np.array([np.full(d, 0.3), np.eye(d)[0]])
    some = np.array([5, 3, min(100, fluid.n - 1)])
    number, momentum, energy = fluid.totals()
    sums = fluid.sums_of_particles(
        lambda part: (part.ids % 3, [part.positions[:, 0], part.velocities[:, 1]]), 3, [1.0, 1.0]
    )
    particles = fluid.positions(), fluid.velocities(), fluid.images()
    of_some = fluid.positions(some), fluid.velocities(some), fluid.positions(some, unwrapped=True)
    bins = *fluid.moments((0,), (7,)), *fluid.moments((1, 0), (3, 5))
    modes = *fluid.modes(waves), *fluid.modes(waves, 10, 100)
    taken = fluid.wall_impulse, *fluid.stress.values()
    return [*particles, *of_some, number, momentum, energy, sums, *bins, *modes, *taken]


def bulk(dimension: int, **parts: Any) -> dict[str, Any]:
    """A fluid without walls, small but larger than a block of threads."""
    size = {2: (8, 8), 3: (4, 5, 6)}[dimension]
    return {"size": size, "density": 8, "timestep": TIMESTEP} | parts


def kinds_of_bulk() -> dict[str, dict[str, Any]]:
    """Each rule in both dimensions, and among these each thermostat, force and history of shear.

    A kind costs its compiling, so it has several parts at once; these are independent.
    """
    mixture = {
        "species": (Species(mass=1, density=3), Species(mass=2.5, density=5)),
        "collision": SRD(angle=130.0),
        "thermostat": MaxwellBoltzmann(),
    }
    kinds, order = {}, [*THERMOSTATS[2:], *THERMOSTATS[:2]]
    for d, part, given in ((2, "force", FORCES), (3, "shear", HISTORIES)):
        flows = itertools.cycle(given)
        thermostats = itertools.cycle(order[:: 1 if d == 2 else -1])
        for rule in RULES:
            thermostat = NoThermostat if rule in (AT, ATPlusA, NoCollision) else next(thermostats)
            parts = {"collision": example(rule, d), "thermostat": example(thermostat, d)}
            if rule is Demix:
                parts |= OF_ONE_MASS
            if rule not in (Demix, NoCollision) or d == 2:  # no shear goes with these
                parts[part] = example(next(flows), d)
            kinds[f"{d}D {rule.__name__}"] = bulk(d, **parts)
        free = {"collision": SRD(angle=130.0), "thermostat": NoThermostat()}
        for name, parts in {"SRD alone": free, "mixture": mixture}.items():
            kinds[f"{d}D {name}"] = bulk(d, **parts, **{part: example(next(flows), d)})
    used = {type(kind[part]) for kind in kinds.values() for part in kind.keys() & PARTS}
    assert used >= {*RULES, *THERMOSTATS, *FORCES, *HISTORIES}
    return kinds
