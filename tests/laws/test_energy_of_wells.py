"""Square wells: kinetic and potential energy together are kept, also with plates and gravity."""

import pytest

from mesokit import Box, Case, HardSpheres, Plates, RandomStart, Run, Simulation, SphereKind
from mesokit.method.spheres.hard.collision.square_well import SquareWell


@pytest.mark.parametrize("depth", [0.7, -0.4])
@pytest.mark.parametrize("held", [False, True])
def test_energy_is_kept(depth, held):
    spheres = HardSpheres(
        number=90,
        kinds=[SphereKind(0.9), SphereKind(1.1)],
        collision=SquareWell(depth=depth, width=1.4),
        start=RandomStart(),
        gravity=[0, -0.1] if held else [],
    )
    case = Case(
        run=Run(0, method="event-driven"),
        box=Box([16, 15]),
        spheres=spheres,
        walls=[Plates("y")] if held else [],
    )
    engine = Simulation(case, threads=1).engine
    totals, potentials = [], []
    for _ in range(5):
        energies = engine.energies()
        totals.append(energies["translation"] + energies["potential"])
        potentials.append(energies["potential"])
        engine.advance(20)
    assert totals == pytest.approx([totals[0]] * 5, rel=1e-10)
    assert max(potentials) - min(potentials) > 5 * abs(depth)
