"""Spheres start from files and from earlier runs: where they were, as large and as fast."""

from __future__ import annotations

import dataclasses

import gsd.hoomd
import numpy as np
import pytest

import mesokit
from mesokit import Box, Case, CaseError, Run, Simulation, Trajectory
from mesokit.method.spheres.common.kinds import SphereKind
from mesokit.method.spheres.common.section import Spheres
from mesokit.method.spheres.common.start.from_file import FileStart, RunStart

SPREAD = (SphereKind(0.8, density=2.0, spread=0.2), SphereKind(1.2, share=0.5))
EQUAL = (SphereKind(0.8, density=2.0), SphereKind(1.2, share=0.5))
ALL = ("position", "velocity", "spin")


@pytest.fixture(autouse=True)
def no_figures(monkeypatch):
    monkeypatch.setattr("mesokit.report.save_all", lambda *given, **more: [])


@pytest.fixture
def case_of(flying):
    def make(size=(9.5, 8), kinds=SPREAD, seed=3, start=None, **given):
        spheres = {"number": 30, "kinds": kinds} | given | ({"start": start} if start else {})
        trajectory = Trajectory(every=10, fields=ALL, precision="float64")
        return Case(
            run=Run(20, seed=seed, method=flying),
            box=Box(size),
            spheres=Spheres(**spheres),
            trajectory=trajectory,
        )

    return make


@pytest.fixture(params=[(9.5, 8), (7, 6.5, 8)], ids=["disks", "spheres"])
def ended(request, case_of, tmp_path):
    """A run that has ended, in the folder `run`."""
    simulation = Simulation(case_of(request.param), output=tmp_path / "run", threads=1)
    simulation.run()
    return simulation


def alike(simulation, other, rtol):
    """Whether one has what the other has."""
    for name in ("positions", "velocities", "spins", "diameters"):
        found, wanted = (getattr(one.engine, name)() for one in (simulation, other))
        np.testing.assert_allclose(found, wanted, rtol=0, atol=10 * rtol)


def test_an_earlier_run_is_gone_on_with_to_the_last_digit(ended, case_of):
    """Whatever the seed, which draws other diameters, is."""
    start = RunStart(run=str(ended.directory.path))
    case = case_of(ended.case.box.size, seed=4, start=start)
    other = Simulation(case, threads=1)
    alike(other, ended, 0.0)
    assert other.engine.step == 0
    assert case.missing_files() == []


@pytest.mark.parametrize("ending, rtol", [("gsd", 1e-6), ("data", 1e-15)])
def test_an_export_is_a_start(ended, case_of, tmp_path, ending, rtol):
    path = mesokit.open(ended.directory.path).export(tmp_path / f"a.{ending}")
    start = FileStart(file=str(path))
    alike(Simulation(case_of(ended.case.box.size, seed=4, start=start), threads=1), ended, rtol)


@pytest.mark.parametrize("ending", ["gsd", "data"])
def test_lengths_of_a_file_are_scaled(ended, case_of, tmp_path, ending):
    """A start in millimetres for a case in metres: masses and times stay."""
    scale = 1e-3
    path = mesokit.open(ended.directory.path).export(tmp_path / f"a.{ending}")
    masses = [kind.mean_mass(ended.case.box.dimension) for kind in SPREAD]
    kinds = [
        dataclasses.replace(kind, diameter=scale * kind.diameter, mass=mass, density=None)
        for kind, mass in zip(SPREAD, masses, strict=True)
    ]
    size = [scale * length for length in ended.case.box.size]
    start = FileStart(file=str(path), scale=scale)
    engine = Simulation(case_of(size, kinds=kinds, start=start), threads=1).engine
    for name, factor in (("positions", scale), ("velocities", scale), ("diameters", scale)):
        found, wanted = getattr(engine, name)(), factor * getattr(ended.engine, name)()
        np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-5 * scale)
    np.testing.assert_allclose(engine.spins(), ended.engine.spins(), atol=1e-5)
    with pytest.raises(CaseError, match=r"; scale = 0\.001 would make it so"):
        Simulation(case_of(size, kinds=kinds, start=FileStart(file=str(path))))


def test_motion_may_be_left_behind(ended, case_of):
    start = RunStart(run=str(ended.directory.path), moving=False)
    other = Simulation(case_of(ended.case.box.size, seed=4, start=start), threads=1)
    np.testing.assert_array_equal(other.engine.positions(), ended.engine.positions())
    assert (other.engine.velocities() != ended.engine.velocities()).all()


def test_kinds_are_told_by_size_where_a_file_has_another_order(case_of, tmp_path):
    case = case_of(kinds=EQUAL)
    wanted = Simulation(case, threads=1).engine
    frame = gsd.hoomd.Frame()
    frame.configuration.box = [9.5, 8, 0, 0, 0, 0]
    frame.configuration.dimensions = 2
    order = np.random.default_rng(1).permutation(30)
    frame.particles.N = 30
    middle = np.array([9.5, 8]) / 2
    frame.particles.position = np.pad(wanted.positions() - middle, ((0, 0), (0, 1)))[order]
    frame.particles.diameter = wanted.diameters()[order]
    with gsd.hoomd.open(str(tmp_path / "a.gsd"), "w") as file:
        file.append(frame)
    other = Simulation(case_of(kinds=EQUAL, start=FileStart(file=str(tmp_path / "a.gsd")))).engine
    np.testing.assert_array_equal(other.diameters(), wanted.diameters())  # its own, exact
    for kind in (slice(20), slice(20, 30)):
        found, expected = (np.sort(e.positions()[kind], axis=0) for e in (other, wanted))
        np.testing.assert_allclose(found, expected, atol=1e-6)
    drawn = Simulation(case_of(kinds=EQUAL)).engine
    np.testing.assert_array_equal(other.velocities(), drawn.velocities())  # the file has none


def test_a_case_remembers_it(ended, case_of, tmp_path):
    case = case_of(ended.case.box.size, start=RunStart(run=str(ended.directory.path)))
    path = tmp_path / "case.toml"
    path.write_text(case.to_toml())
    assert Case.from_toml(path) == case


class TestRefused:
    """In one line that says which key, and why."""

    @pytest.mark.parametrize(
        "parts, message",
        [
            ({"number": 20}, "it has 30 particles, this case 20"),
            ({"size": (9.5, 9)}, r"it has a box of \[9.5, 8\], this case \[9.5, 9\]"),
            ({"kinds": (SphereKind(1.0),)}, r"has diameter .*; expected 1 \(spheres.kinds\[#1\]\)"),
            (
                {"kinds": (SphereKind(0.8, spread=0.25), SphereKind(1.2, share=0.5))},
                r"particle \d+ has mass .*; expected .* \(spheres.kinds\[#1\]\)",
            ),
            (
                {"kinds": (SphereKind(0.8, density=2.0, spread=0.1), *SPREAD[1:])},
                r"expected 0.72 to 0.88 \(spheres.kinds\[#1\]\)",
            ),
            ({"size": (9.5, 8, 8)}, "it has a box of"),
        ],
    )
    @pytest.mark.parametrize("rule", ["run", "gsd", "data"])
    def test_other_spheres(self, case_of, tmp_path, rule, parts, message):
        simulation = Simulation(case_of(), output=tmp_path / "run", threads=1)
        simulation.run()
        start = RunStart(run=str(tmp_path / "run"))
        if rule != "run":
            path = mesokit.open(tmp_path / "run").export(tmp_path / f"a.{rule}")
            start = FileStart(file=str(path))
        key = "run" if rule == "run" else "file"
        with pytest.raises(CaseError, match=rf"^spheres\.start\.{key} = [^\n]*: .*{message}"):
            Simulation(case_of(start=start, **parts))

    def test_files_that_are_not(self, case_of, tmp_path):
        (tmp_path / "a.gsd").write_bytes(b"nothing")
        (tmp_path / "a.txt").touch()
        for start, message in (
            (FileStart(file=str(tmp_path / "a.gsd")), "cannot be read as a GSD file"),
            (FileStart(file=str(tmp_path / "a.txt")), r"ending '.txt': expected '.gsd'"),
            (RunStart(run=str(tmp_path / "b")), "no such folder"),
            (RunStart(run=str(tmp_path)), "holds no run"),
        ):
            with pytest.raises(CaseError, match=message):
                Simulation(case_of(start=start))

    def test_a_run_of_points(self, case_of, tmp_path):
        case = Case(run=Run(1), box=Box([6, 6]))
        Simulation(case, output=tmp_path / "run", threads=1).run()
        with pytest.raises(CaseError, match="a run of method 'mpcd', whose particles have no size"):
            Simulation(case_of(start=RunStart(run=str(tmp_path / "run"))))

    def test_a_box_that_leans_and_bonds(self, case_of, tmp_path):
        simulation = Simulation(case_of(), output=tmp_path / "run", threads=1)
        simulation.run()
        path = mesokit.open(tmp_path / "run").export(tmp_path / "a.gsd")
        with gsd.hoomd.open(str(path)) as file:
            frame = file[-1]
        for change, message in (("box", "its box leans"), ("bonds", "it has 1 bonds")):
            other = dataclasses.replace(frame) if dataclasses.is_dataclass(frame) else frame
            if change == "box":
                other.configuration.box = [9.5, 8, 1, 0.2, 0, 0]
            else:
                other.configuration.box = [9.5, 8, 1, 0, 0, 0]
                other.bonds.N, other.bonds.types = 1, ["bond"]
                other.bonds.group, other.bonds.typeid = [[0, 1]], [0]
            with gsd.hoomd.open(str(tmp_path / "b.gsd"), "w") as file:
                file.append(other)
            with pytest.raises(CaseError, match=message):
                Simulation(case_of(start=FileStart(file=str(tmp_path / "b.gsd"))))
