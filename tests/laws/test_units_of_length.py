"""Methods without cells take lengths of any unit: the same motion, to the last bit, in another."""

import numpy as np
import pytest

from mesokit import (
    Box,
    Case,
    CaseError,
    Flock,
    HardSpheres,
    HertzLaw,
    LennardJones,
    NumberFluctuations,
    Plates,
    RadialDistribution,
    RandomStart,
    Run,
    Simulation,
    SoftSpheres,
    SphereKind,
    SpringDashpot,
)
from mesokit.method.spheres.common.observe.cluster_size import ClusterSize

UNITS = [2.0**-11, 2.0**9]


def hard(unit):
    return "event-driven", {
        "spheres": HardSpheres(
            number=40, kinds=[SphereKind(unit, spread=0.2)], kT=unit**2, start=RandomStart(),
            gravity=[0, -0.3 * unit], timestep=1.0,
        ),
        "walls": [Plates("y")],
    }  # fmt: skip


def linear(unit):
    return "soft-spheres", {
        "spheres": SoftSpheres(
            number=40, kinds=[SphereKind(unit)], kT=unit**2, start=RandomStart(),
            pair=SpringDashpot(0.8, contact_time=0.05, friction=0.3), gravity=[0, -0.3 * unit],
        ),
        "walls": [Plates("y")],
    }  # fmt: skip


def hertz(unit):
    law = HertzLaw(stiffness=1e4 / unit**0.5)
    kinds = [SphereKind(unit)]
    return "soft-spheres", {
        "spheres": SoftSpheres(number=40, kinds=kinds, kT=unit**2, pair=law, timestep=0.001)
    }


def flock(unit):
    return "flock", {"flock": Flock(number=90, radius=unit, speed=0.25 * unit)}


@pytest.mark.parametrize("made", [hard, linear, hertz, flock])
@pytest.mark.parametrize("unit", UNITS)
def test_motion_is_the_same_in_any_unit(made, unit):
    found = []
    for length in (1.0, unit):
        method, parts = made(length)
        case = Case(run=Run(0, method=method), box=Box([8.5 * length, 7 * length]), **parts)
        engine = Simulation(case, threads=1).engine
        engine.advance(60)
        found.append((engine.positions() / length, engine.velocities() / length))
    for one, other in zip(*found, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-9)


def test_usual_lengths_of_observables_are_relative():
    """In the largest diameter, or the reach of sight."""
    unit = 0.002
    kinds = [SphereKind(unit), SphereKind(0.5 * unit)]
    spheres = HardSpheres(number=30, kinds=kinds)
    box = Box([40 * unit, 30 * unit])
    case = Case(run=Run(0, method="event-driven"), box=box, spheres=spheres)
    assert ClusterSize().accumulator(case).gap == pytest.approx(0.1 * unit)
    assert RadialDistribution().accumulator(case).edges[-1] == pytest.approx(5 * unit)
    assert ClusterSize(gap=0.3).accumulator(case).gap == 0.3
    birds = Case(
        run=Run(0, method="flock"), box=box, flock=Flock(number=99, radius=unit, speed=unit)
    )
    assert NumberFluctuations().all_sides(birds) == (unit, 2 * unit, 4 * unit)


def test_few_cells_are_refused_where_there_are_cells():
    with pytest.raises(CaseError, match=r"box\.size = \[1, 8\]: expected at least 2 cells"):
        Case(run=Run(1), box=Box([1, 8]))
    with pytest.raises(CaseError, match=r"Box\.size = .*: expected lengths above 0"):
        Box([0.0, 8])


def test_a_potential_fits_a_small_box():
    """The skin of lists shrinks unless the case says one."""
    spheres = {"number": 20, "kT": 1.0, "pair": LennardJones(cutoff=2.3)}
    case = Case(
        run=Run(0, method="soft-spheres"), box=Box([4.8, 4.9, 5.2]), spheres=SoftSpheres(**spheres)
    )
    engine = Simulation(case, threads=1).engine
    before = engine.totals()[2] + engine.potential_energy()
    engine.advance(100)
    assert engine.totals()[2] + engine.potential_energy() == pytest.approx(before, rel=1e-3)
    with pytest.raises(CaseError, match=r"spheres\.skin = 0\.3: expected less than 0\.1"):
        Case(
            run=Run(0, method="soft-spheres"),
            box=Box([4.8, 4.9, 5.2]),
            spheres=SoftSpheres(skin=0.3, **spheres),
        )
