"""Only MPCD has cells: results, files and figures of other methods do not name their side."""

from __future__ import annotations

import dataclasses

import h5py
import pytest

import mesokit
from mesokit import (
    Box,
    Case,
    Conservation,
    FlowFrames,
    HardSpheres,
    MeanSquareDisplacement,
    Run,
    Simulation,
    Trajectory,
)
from mesokit.io import h5md
from mesokit.seam.in_units import in_units

FIELDS = ("position", "velocity")


@pytest.fixture(scope="module")
def gas(tmp_path_factory):
    """A run of disks that has ended."""
    folder = tmp_path_factory.mktemp("runs") / "gas"
    case = Case(
        run=Run(60, method="event-driven"),
        box=Box([8, 8]),
        spheres=HardSpheres(number=20),
        observe=[MeanSquareDisplacement(every=2, max_lag=20)],
        trajectory=Trajectory(every=20, fields=FIELDS),
    )
    Simulation(case, output=folder).run()
    return folder


def texts(figure):
    """All that stands in a figure."""
    return [text.get_text() for text in figure.findobj(lambda one: hasattr(one, "get_text"))]


def test_results_of_disks_have_lengths(gas):
    files = mesokit.open(gas)
    result = files["mean-square-displacement"]
    assert result.units == {"value": "length^2", "time": "time"}
    assert {c.unit for c in result.comparisons} <= {"length^2/time", "length^2", ""}
    assert r"[$\mathrm{length}^2$]" in " ".join(texts(result.plot()))
    assert result == Simulation.resume(gas)["mean-square-displacement"]


def test_files_of_disks_have_lengths(gas):
    with h5py.File(gas / "run.h5") as file:
        group = file["particles/spheres"] if "spheres" in file["particles"] else None
        group = group or next(iter(file["particles"].values()))
        assert group["position/value"].attrs["reduced_unit"] == "length"
        assert group["velocity/value"].attrs["reduced_unit"] == "length/time"
        assert group["box/edges/value"].attrs["reduced_unit"] == "length"


def test_pictures_of_disks_have_lengths(gas):
    shown = texts(mesokit.open(gas).flow("disks"))
    assert r"$x$  [$\mathrm{length}$]" in shown
    assert r"speed  [$\mathrm{length}/\mathrm{time}$]" in shown
    assert not any(r"\tau" in text for text in shown)


def test_files_of_earlier_versions_are_read_with_lengths(gas, monkeypatch):
    """These have the units of MPCD for all methods."""
    found = h5md.read_results(gas / "run.h5")
    old = {
        name: dataclasses.replace(result, units={"value": "a^2", "time": "tau"})
        for name, result in found.items()
    }
    monkeypatch.setattr(h5md, "read_results", lambda path: old)
    assert mesokit.open(gas)["mean-square-displacement"].units["value"] == "length^2"


def test_mpcd_has_cells():
    case = Case(run=Run(20), box=Box([8, 8]), observe=[Conservation(), FlowFrames(window=10)])
    simulation = Simulation(case)
    simulation.run()
    result = simulation["conservation"]
    assert in_units(result, case) is result and result.units["kinetic_energy"] == "m a^2/tau^2"
    assert "$x$  [$a$]" in texts(simulation.flow("speed"))
