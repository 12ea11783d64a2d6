"""Sizes, masses and spins of spheres in all that is written, and back."""

from __future__ import annotations

import warnings

import gsd.hoomd
import h5py
import numpy as np
import pytest

import mesokit
from mesokit import Box, Case, CaseError, Run, Simulation
from mesokit.case.trajectory import Trajectory, stored_bytes
from mesokit.io.snapshot_file import read_snapshot
from mesokit.method.spheres.common.kinds import SphereKind
from mesokit.method.spheres.common.section import Spheres
from tests.helpers.flying_spheres import Flying

ALL = ("position", "velocity", "spin", "image", "id")
KINDS = (SphereKind(0.8, density=2.0, spread=0.2, name="small"), SphereKind(1.2, share=0.5))
SIZES = [(9.5, 8), (7, 6.5, 8)]


@pytest.fixture(autouse=True)
def no_figures(monkeypatch):
    monkeypatch.setattr("mesokit.report.save_all", lambda *given, **more: [])


def case_of(flying, size, steps=20, **trajectory):
    given = {"fields": ALL, "precision": "float64"} | trajectory
    return Case(
        run=Run(steps=steps, seed=3, method=flying),
        box=Box(size),
        spheres=Spheres(number=30, kinds=KINDS),
        trajectory=Trajectory(every=10, **given),
    )


@pytest.fixture(params=SIZES, ids=["disks", "spheres"])
def ended(request, flying, tmp_path):
    """A run that has ended, in the folder `run`."""
    simulation = Simulation(case_of(flying, request.param), output=tmp_path / "run", threads=1)
    simulation.run()
    return simulation


def spins_of(engine):
    """As files have them: three numbers."""
    return np.pad(engine.w[:, None], ((0, 0), (2, 0))) if engine.dimension == 2 else engine.w


def test_the_trajectory_has_sizes_masses_and_spins(ended):
    engine, frames = ended.engine, mesokit.open(ended.directory.path).trajectory
    assert frames.fields == ("position", "velocity", "spin", "image")
    np.testing.assert_array_equal(frames.diameter, engine.diameters())
    np.testing.assert_array_equal(frames.mass, engine.masses())
    assert len(set(frames.diameter)) == 21  # ten of the second kind are equal
    np.testing.assert_array_equal(frames[2]["spin"], engine.w)
    np.testing.assert_array_equal(frames.read("spin")[1], engine.w)
    assert frames.species.tolist() == [0] * 20 + [1] * 10
    with h5py.File(ended.directory.data_file) as file:
        group = file["particles/spheres"]
        assert group["radius"].shape == (30,) and group["radius"].attrs["reduced_unit"] == "length"
        assert group["spin/value"].attrs["reduced_unit"] == "1/time"
        np.testing.assert_array_equal(group["spin/value"][-1], spins_of(engine))


def test_a_run_made_longer_keeps_them(ended, flying, tmp_path):
    path = ended.directory.path
    simulation = Simulation.resume(path, steps=40)
    there = read_snapshot(str(mesokit.open(path).export(tmp_path / "a.gsd")))  # of segments again
    np.testing.assert_allclose(there.diameters, ended.engine.diameters(), rtol=1e-7)
    np.testing.assert_allclose(there.masses, ended.engine.masses(), rtol=1e-7)
    simulation.run()
    frames = mesokit.open(path).trajectory
    assert len(frames) == 5
    np.testing.assert_array_equal(frames.diameter, ended.engine.diameters())
    np.testing.assert_array_equal(frames.mass, ended.engine.masses())
    assert (frames.read("spin") == ended.engine.w).all()


def test_a_run_that_goes_on_exports_them(flying, tmp_path):
    """From its segments, before there is a data file."""
    simulation = Simulation(case_of(flying, (9.5, 8)), output=tmp_path / "run", threads=1)
    simulation.run(0)
    simulation.checkpoint()
    files = mesokit.open(tmp_path / "run")
    there = read_snapshot(str(files.export(tmp_path / "a.gsd")))
    np.testing.assert_allclose(there.diameters, simulation.engine.diameters(), rtol=1e-7)
    np.testing.assert_allclose(there.masses, simulation.engine.masses(), rtol=1e-7)
    own = tmp_path / "run" / "trajectory" / "own.npz"
    assert own.exists()
    own.write_bytes(b"nothing")
    with pytest.raises(mesokit.RunError, match="damaged"):
        mesokit.open(tmp_path / "run").export(tmp_path / "a.gsd")


def test_gsd_has_them_in_the_schema_and_for_ovito(ended, tmp_path):
    engine = ended.engine
    path = mesokit.open(ended.directory.path).export(tmp_path / "a.gsd")
    with gsd.hoomd.open(str(path)) as file:
        frame = file[-1]
    frame.validate()
    np.testing.assert_allclose(frame.particles.diameter, engine.diameters(), rtol=1e-6)
    np.testing.assert_allclose(frame.particles.mass, engine.masses(), rtol=1e-6)
    share = 1 / 8 if engine.dimension == 2 else 1 / 10  # of m d^2: the uniform disk, the sphere
    inertia = share * engine.masses() * engine.diameters() ** 2
    np.testing.assert_allclose(frame.particles.moment_inertia[:, 2], inertia, rtol=1e-6)
    momentum = 0.5 * frame.particles.angmom[:, 1:]
    np.testing.assert_allclose(momentum, inertia[:, None] * spins_of(engine), atol=1e-6)
    logged = frame.log["particles/angular_velocity"]
    np.testing.assert_allclose(logged, spins_of(engine), atol=1e-6)
    assert frame.particles.types == ["small", "spheres-2"]
    assert frame.particles.type_shapes[1] == {"type": "Sphere", "diameter": 1.2}


@pytest.mark.parametrize("bare", [False, True], ids=["ours", "of HOOMD-blue"])
def test_gsd_is_read_back(ended, tmp_path, bare):
    """Also without what is ours alone, and of particles that have turned since their start."""
    engine = ended.engine
    path = mesokit.open(ended.directory.path).export(tmp_path / "a.gsd")
    if bare:
        with gsd.hoomd.open(str(path)) as file:
            frame = file[-1]
        frame.log, particles = {}, frame.particles
        half = np.array([0.8, 0, 0, 0.6] if engine.dimension == 2 else [0.8, 0.36, 0.0, 0.48])
        particles.orientation = np.tile(half, (30, 1))
        s, v, momentum = half[0], half[1:], 0.5 * particles.angmom[:, 1:]
        particles.angmom = 2 * np.column_stack(  # (0, L) q
            [-momentum @ v, s * momentum + np.cross(momentum, v)]
        )
        path = tmp_path / "b.gsd"
        with gsd.hoomd.open(str(path), "w") as file:
            file.append(frame)
    there = read_snapshot(str(path))
    d = engine.dimension
    np.testing.assert_allclose(there.diameters, engine.diameters(), rtol=1e-6)
    np.testing.assert_allclose(there.spins, spins_of(engine), atol=2e-6)
    np.testing.assert_allclose(there.velocities[:, :d], engine.v, atol=1e-6)
    np.testing.assert_allclose((there.positions - there.low)[:, :d], engine.positions(), atol=1e-6)


def test_texts_have_radius_and_angular_velocity(ended, tmp_path):
    engine, files = ended.engine, mesokit.open(ended.directory.path)
    lines = files.export(tmp_path / "a.lammpstrj").read_text().splitlines()
    names = lines[8].split()[2:]
    rows = [dict(zip(names, line.split(), strict=True)) for line in lines[-30:]]
    for i, row in enumerate(rows):
        assert float(row["radius"]) == pytest.approx(engine.d[i] / 2)
        assert float(row["mass"]) == pytest.approx(engine.masses()[i])
        spin = [float(row[f"omega{axis}"]) for axis in "xyz"]
        np.testing.assert_allclose(spin, spins_of(engine)[i], atol=1e-7)
    lines = files.export(tmp_path / "a.xyz").read_text().splitlines()
    assert "radius:R:1:velo:R:3:angular_velocity:R:3 " in lines[-31]
    rows = np.array([line.split()[1:] for line in lines[-30:]], float)
    np.testing.assert_allclose(rows[:, 5], engine.d / 2, rtol=1e-8)
    np.testing.assert_allclose(rows[:, 9:], spins_of(engine), rtol=1e-7)


def test_mdanalysis_reads_them(ended, tmp_path):
    import MDAnalysis

    engine, files = ended.engine, mesokit.open(ended.directory.path)
    universe = files.universe()
    np.testing.assert_allclose(universe.atoms.radii, engine.d / 2)
    np.testing.assert_allclose(universe.atoms.masses, engine.masses())
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        other = MDAnalysis.Universe(str(files.export(tmp_path / "a.h5md")))
        other.trajectory[-1]
        spin = other.trajectory.ts.data["trajectory/spin"]
        np.testing.assert_allclose(spin, spins_of(engine), atol=1e-6)
        assert other.trajectory.n_frames == 3
        dumped = MDAnalysis.Universe(
            str(files.export(tmp_path / "a.lammpstrj")), format="LAMMPSDUMP", lengthunit="angstrom"
        )
        places = dumped.atoms.positions[:, : engine.dimension]
        np.testing.assert_allclose(places, files.trajectory[0]["position"], atol=1e-5)
        for ending in ("dcd", "xtc", "trr"):
            assert files.export(tmp_path / f"a.{ending}").stat().st_size > 0
    with h5py.File(tmp_path / "a.h5md") as file:
        np.testing.assert_allclose(file["particles/trajectory/radius"], engine.d / 2)


def test_lammps_has_each_sphere_as_it_is(ended, tmp_path):
    """Its atom style sphere: read back to the last digit."""
    engine, files = ended.engine, mesokit.open(ended.directory.path)
    path = files.export(tmp_path / "a.data")
    there, d = read_snapshot(str(path)), engine.dimension
    np.testing.assert_allclose(there.diameters, engine.d, rtol=1e-15)
    np.testing.assert_allclose(there.masses, engine.masses(), rtol=1e-14)
    np.testing.assert_array_equal(there.spins, spins_of(engine))
    np.testing.assert_array_equal(there.velocities[:, :d], engine.v)
    np.testing.assert_array_equal(there.positions[:, :d], engine.positions())
    np.testing.assert_array_equal(there.images[:, :d], engine.images())
    assert "Atoms # sphere" in path.read_text() and "2 atom types" in path.read_text()


def test_what_particles_have_not_is_refused(flying):
    case = Case(run=Run(steps=1), box=Box([6, 6]))
    for method, field, expected in (
        ("mpcd", "spin", r"have no 'spin'; expected some of 'position', 'velocity', 'image', 'id'"),
        ("brownian", "velocity", "method 'brownian' have no 'velocity'"),
    ):
        with pytest.raises(CaseError, match=rf"^trajectory\.fields = .*{expected}"):
            Case(
                run=Run(steps=1, method=method),
                box=case.box,
                trajectory=Trajectory(every=1, fields=("position", field)),
            )


@pytest.mark.parametrize("size, numbers", [((5, 5), 3), ((5, 5, 5), 6)])
def test_how_much_is_stored_is_known_ahead(flying, size, numbers):
    case = case_of(flying, size, fields=("position", "spin"), compression=0)
    found = stored_bytes(case.trajectory, case.groups, len(size), 20)
    assert found == 3 * 30 * numbers * 8


def test_the_fake_is_an_engine(flying):
    case = case_of(flying, (9.5, 8))
    assert isinstance(Simulation(case).engine, Flying)
