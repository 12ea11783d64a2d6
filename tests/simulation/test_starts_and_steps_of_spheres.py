"""Spheres whose start or step spoils their numbers: `check` warns, or the run ends in a line."""

import pytest

from mesokit import (
    WCA,
    Box,
    Case,
    EquationOfState,
    HardSpheres,
    Langevin,
    RandomStart,
    Run,
    RunError,
    Simulation,
    SoftSpheres,
)
from mesokit.seam.method import summary_of


@pytest.mark.parametrize(
    ("phi", "warmup", "start", "warned"),
    [
        (0.4, 0, None, True),
        (0.4, 400, None, False),
        (0.02, 0, None, False),  # a dilute lattice is left within a flight
        (0.4, 0, RandomStart(), False),
    ],
)
def test_a_lattice_that_has_not_melted_is_warned_of(phi, warmup, start, warned):
    given = {} if start is None else {"start": start}
    case = Case(
        run=Run(steps=100, warmup=warmup, method="event-driven"),
        box=Box([20.0, 20.0]),
        spheres=HardSpheres(packing_fraction=phi, timestep=0.1, **given),
        observe=[EquationOfState()],
    )
    assert any("start on a lattice" in each for each in summary_of(case).warnings) == warned


@pytest.mark.parametrize(("timestep", "unstable"), [(0.04, True), (0.002, False)])
def test_spheres_that_their_bath_cannot_hold_end_the_run(timestep, unstable):
    case = Case(
        run=Run(steps=400, method="soft-spheres"),
        box=Box([6.0, 6.0, 6.0]),
        spheres=SoftSpheres(
            number=110, kT=1.2, pair=WCA(), timestep=timestep, thermostat=Langevin(friction=1.0)
        ),
    )
    simulation = Simulation(case)
    if unstable:
        with pytest.raises(RunError, match=r"kT = .*, where the bath holds .*spheres.timestep"):
            simulation.run()
    else:
        simulation.run()
        assert simulation.step == 400
