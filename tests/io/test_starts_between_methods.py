"""Grains of one method go on where those of another have ended, to the last digit."""

import numpy as np
import pytest

from mesokit import (
    Box,
    Case,
    CaseError,
    GaussSeidel,
    HardSpheres,
    Plates,
    RandomStart,
    RigidSpheres,
    Run,
    Simulation,
    SoftSpheres,
    SphereKind,
)
from mesokit.method.spheres.common.start.from_file import RunStart

SECTIONS = {
    "soft-spheres": SoftSpheres, "event-driven": HardSpheres, "contact-dynamics": RigidSpheres,
}  # fmt: skip
OTHERS = ("soft-spheres", "event-driven")
WAYS = [*((m, "contact-dynamics") for m in OTHERS), *(("contact-dynamics", m) for m in OTHERS)]


def gas(method, seed, start, **given):
    """A case of disks of several sizes that fly."""
    section = SECTIONS[method](
        number=30, kinds=[SphereKind(0.8, spread=0.2)], kT=1.0, timestep=0.0005, start=start
    )
    return Case(Run(50, seed=seed, method=method), Box([9.5, 8]), spheres=section)


@pytest.mark.parametrize(("first", "then"), WAYS)
def test_a_method_goes_on_from_a_run_of_another(first, then, tmp_path, monkeypatch):
    monkeypatch.setattr("mesokit.report.save_all", lambda *given, **more: [])
    ended = Simulation(gas(first, 1, RandomStart()), output=tmp_path / "run", threads=1)
    ended.run()
    other = Simulation(gas(then, 2, RunStart(run=str(tmp_path / "run"))), threads=1).engine
    for name in ("positions", "velocities", "diameters"):
        np.testing.assert_array_equal(getattr(other, name)(), getattr(ended.engine, name)())
    for name in ("masses", "spins"):
        found, wanted = getattr(other, name)(), getattr(ended.engine, name)()
        np.testing.assert_allclose(found, wanted, rtol=1e-13)
    energy = other.totals()[2]
    other.advance(1)
    assert other.step == 1 and other.totals()[2] == pytest.approx(energy, rel=0.2)


def test_a_bed_of_rigid_grains_goes_on_as_hard_spheres(tmp_path, monkeypatch):
    """Grains at rest overlap a little, since forces only keep contacts from closing further."""
    monkeypatch.setattr("mesokit.report.save_all", lambda *given, **more: [])
    grains = {"number": 40, "kinds": [SphereKind(1.0, spread=0.2)], "gravity": [0, -1]}
    walls = [Plates("y")]
    few = GaussSeidel(sweeps=10)
    bed = RigidSpheres(**grains, start=RandomStart(), timestep=0.01, solver=few)
    case = Case(Run(1500, method="contact-dynamics"), Box([8, 12]), spheres=bed, walls=walls)
    ended = Simulation(case, output=tmp_path / "run", threads=1)
    ended.run()
    overlap = ended.engine.solved.overlap
    assert 1e-5 < overlap < 1e-3  # more than rounding

    def shaken(**start):
        begin = RunStart(run=str(tmp_path / "run"), moving=False, **start)
        spheres = HardSpheres(**grains, start=begin, kT=0.1)
        run = Run(10, method="event-driven")
        return Simulation(Case(run, Box([8, 12]), spheres=spheres, walls=walls)).engine

    with pytest.raises(CaseError, match=r"expected none of hard.*start\.shrink = 0\.0"):
        shaken()
    other = shaken(shrink=2 * overlap)
    np.testing.assert_allclose(
        other.diameters(), ended.engine.diameters() * (1 - 2 * overlap), rtol=1e-15
    )
    before = sum(other.energies()[name] for name in ("translation", "potential"))
    other.advance(20)
    after = sum(other.energies()[name] for name in ("translation", "potential"))
    assert after == pytest.approx(before, rel=1e-9)  # elastic
    assert np.abs(other.positions() - ended.engine.positions()).max() > 0.1
