"""Grains of one method go on where those of another have ended, to the last digit."""

import numpy as np
import pytest

from mesokit import (
    Box,
    Case,
    HardSpheres,
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
