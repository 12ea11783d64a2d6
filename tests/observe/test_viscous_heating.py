"""Numbers of a fluid that friction heats are not compared with theory at the kT of the case."""

import math

import pytest

from mesokit import (
    Box,
    Case,
    Conservation,
    Fluid,
    MaxwellBoltzmann,
    Plates,
    Run,
    Simulation,
    Stress,
    Surface,
    TemperatureProfile,
    VelocityProfile,
)
from mesokit.method.mpcd.derived import heat_caveat

HOT = "not steady: viscous heating raises kT from "


def sheared(rate: float, kT: float = 1.0, **fluid: object) -> Case:
    return Case(
        run=Run(steps=240, warmup=40, seed=5),
        box=Box([8, 8, 8], shear_rate=rate),
        fluid=Fluid(kT=kT, **fluid),
        observe=[
            Stress(every=1),
            VelocityProfile(axis="y", every=2),
            TemperatureProfile(axis="y", every=2),
            Conservation(every=2),
        ],
    )


def test_a_fluid_without_a_thermostat_is_not_compared_at_the_kT_of_the_case():
    """The temperature that is named is that which the fluid has at the end."""
    case = sheared(0.4, kT=1.5)
    simulation = Simulation(case, threads=1)
    simulation.run()
    stress = simulation["stress"].comparisons
    assert {"viscosity from the stress", "pressure"} <= {one.what for one in stress}
    for one in stress:
        assert one.note.startswith(HOT + "1.5 to ") and "or more in the run" in one.note
        assert math.isnan(one.deviation) and "standard errors" not in str(one)
    said = float(stress[0].note.removeprefix(HOT + "1.5 to ").split()[0])
    mean = simulation["temperature-profile"].value.mean()
    middle = 1.5 + (said - 1.5) * (40 + 120) / 280  # it rises with the time
    assert mean == pytest.approx(middle, rel=0.1) and said > 3
    shear = simulation["velocity-profile"]["shear rate"]
    assert shear.steady and abs(shear.deviation) < 4
    for name in ("conservation", "temperature-profile"):
        assert all(HOT not in one.note for one in simulation[name].comparisons)


@pytest.mark.parametrize(
    "case",
    [
        sheared(0.4, thermostat=MaxwellBoltzmann()),
        sheared(0.01),
    ],
    ids=["held", "slow"],
)
def test_a_fluid_that_stays_at_kT_is_compared(case):
    assert heat_caveat(case, 280) == ""


def test_the_rise_is_that_of_the_steps_so_far():
    """5 % is the least that counts."""
    case = sheared(0.15)
    end = heat_caveat(case, 280)
    assert end.startswith(HOT)
    assert heat_caveat(case, 10) == ""


def test_shear_that_changes_heats_by_the_mean_square_of_its_rate():
    boxes = [
        Box([8, 8, 8], shear_rate=0.4 / 2**0.5),
        Box([8, 8, 8], shear_rate=0.4, shear_frequency=2.0),
    ]
    cases = [Case(run=Run(steps=500), box=box, fluid=Fluid()) for box in boxes]
    steady, changing = (heat_caveat(case, 500) for case in cases)
    assert steady == changing and steady.startswith(HOT + "1 to ")


def test_walls_that_cool_the_fluid_leave_it_steady_and_hot():
    """In a slit whose temperature has settled theory at kT is approximate, before it not steady."""
    notes = []
    for warmup in (20, 200_000):
        case = Case(
            run=Run(steps=100_000, warmup=warmup),
            box=Box([10, 10, 6]),
            fluid=Fluid(),
            walls=[Plates("z", upper=Surface(velocity=(1.6, 0, 0)))],
        )
        notes.append(heat_caveat(case, 100_000 + warmup))
    assert notes[0].startswith(HOT) and notes[1].startswith("approximate: viscous heating holds kT")
