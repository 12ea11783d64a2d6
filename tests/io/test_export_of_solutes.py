"""Exports of solutes, with and without molecules of the fluid."""

from __future__ import annotations

import warnings

import h5py
import numpy as np
import pytest

import mesokit
from mesokit import Harmonic, MaxwellBoltzmann
from mesokit.case.box import Box
from mesokit.case.case import Case
from mesokit.case.run import Run
from mesokit.case.trajectory import Trajectory
from mesokit.method.mpcd.fluid import Fluid
from mesokit.method.mpcd.molecule import Molecule
from mesokit.method.mpcd.solutes import Polymer, Solutes
from mesokit.method.mpcd.start.section import Start
from mesokit.run.simulation import Simulation
from tests.helpers.exports import ALL, read

pytestmark = pytest.mark.usefixtures("no_figures")


def among_molecules(folder, start=None):
    """Two chains and a bead in a fluid of dimers: 48 particles and 7 beads."""
    solutes = Solutes(
        (Polymer(2, length=3, name="chain"), Polymer()), mass=5.0, bond=Harmonic(K=2.0),
        start=Start(run=start),
    )  # fmt: skip
    dimers = Molecule(bond=Harmonic(K=2.0), propagation="exact")
    case = Case(
        run=Run(steps=20, seed=2),
        box=Box([4, 4, 3]),
        fluid=Fluid(density=1, molecule=dimers, thermostat=MaxwellBoltzmann(),
                    start=Start(run=start)),
        solutes=solutes,
        observe=[
            mesokit.MoleculeSize(kind=kind, name=f"size-{kind}", every=5)
            for kind in ("fluid", "chain")
        ] + [mesokit.BondLength(kind="fluid"), mesokit.Conservation(),
             mesokit.RadialDistribution(kinds=("fluid", "chain"), every=5)],
        trajectory=Trajectory(every=10, fields=ALL),
    )  # fmt: skip
    return Simulation(case, output=folder, threads=1)


@pytest.fixture(scope="module")
def ended(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mesokit.report.save_all", lambda *given, **more: [])
        simulation = among_molecules(tmp_path_factory.mktemp("runs") / "among")
        simulation.run()
    return simulation


class TestSolutesAmongMolecules:
    """Both have their bonds, names and masses in all that is written, and go on with their bits."""

    def test_files_for_others(self, ended, tmp_path):
        import MDAnalysis

        everyone, files = np.arange(55), mesokit.open(ended.directory.path)
        bonds = ended.engine.bonds()
        assert bonds[:24].tolist() == [[2 * k, 2 * k + 1] for k in range(24)]
        assert bonds[24:].tolist() == [[48, 49], [49, 50], [51, 52], [52, 53]]
        frame = read(files.export(tmp_path / "a.gsd"))[-1]
        assert frame.particles.types == ["fluid", "chain", "polymer-2"]
        assert frame.particles.typeid.tolist() == [0] * 48 + [1] * 6 + [2]
        assert frame.particles.mass.tolist() == [1.0] * 48 + [5.0] * 7
        np.testing.assert_array_equal(frame.bonds.group, bonds)
        bodies = -2 - frame.particles.body
        assert bodies.tolist() == [*np.repeat(np.arange(26), [2] * 24 + [3, 3]), -1]
        size = np.array([4, 4, 3])
        whole = frame.particles.position + frame.particles.image * size
        way = whole[bonds[:, 1]] - whole[bonds[:, 0]]
        np.testing.assert_allclose(way, ended.engine.bond_vectors(), atol=1e-5)
        paths = [str(files.export(tmp_path / f"a.{ending}")) for ending in ("data", "h5md")]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found = [MDAnalysis.Universe(path) for path in paths] + [files.universe()]
            for universe in found:
                universe.trajectory[-1]
                places = universe.atoms.positions
                np.testing.assert_allclose(places, ended.engine.positions(everyone), atol=1e-5)
        for universe in (found[0], found[2]):
            np.testing.assert_array_equal(universe.bonds.to_indices(), bonds)
        assert [len(f) for f in found[2].select_atoms("name chain").fragments] == [3, 3]
        with h5py.File(ended.directory.data_file) as file:
            np.testing.assert_array_equal(file["connectivity/bonds"], bonds)

    def test_both_are_measured(self, ended):
        fluid, chain = (ended[f"size-{kind}"].comparisons for kind in ("fluid", "chain"))
        # sub-steps add less than 0.3 %
        assert [c.expected for c in fluid] == pytest.approx([0.75 / 4, 0.75], rel=3e-3)
        assert [c.expected for c in chain] == pytest.approx([1.5 * 8 / 36, 1.5], rel=3e-3)
        assert all(c.measured > 0 for c in (*fluid, *chain))
        square = (ended.engine.bond_vectors()[:24] ** 2).sum(axis=1)
        assert 0.3 < ended["bond-length"].comparisons[0].measured / square.mean() < 3
        assert (
            ended.engine.totals()[0] == 55
            and ended.engine.potential_energy() > 2 * square.sum() > 0
        )

    def test_a_run_that_is_resumed_has_the_same_bits(self, ended, tmp_path):
        simulation = among_molecules(tmp_path / "run")
        simulation.run(5)
        simulation.checkpoint()
        again = Simulation.resume(tmp_path / "run", threads=2)
        assert again.step == 5
        again.run()
        state, wanted = again.engine.state(), ended.engine.state()
        for name in ("positions", "velocities", "images", "solute_r", "solute_v"):
            np.testing.assert_array_equal(state[name], wanted[name])

    def test_a_run_that_starts_where_it_ended(self, ended, tmp_path):
        other = among_molecules(tmp_path / "run", start=str(ended.directory.path))
        for read_of in ("bond_vectors", "potential_energy", "velocities"):
            found, wanted = (getattr(one.engine, read_of)() for one in (other, ended))
            np.testing.assert_allclose(found, wanted, atol=1e-12)
        np.testing.assert_array_equal(other.engine.solutes.places, ended.engine.solutes.places)


def test_solutes_come_after_the_fluid(tmp_path):
    """Kinds and masses are the same from the segments of a run as from its data file."""
    solutes = Solutes(polymers=(Polymer(), Polymer(2, 3)), mass=7.0, bond=Harmonic(K=2.0))
    case = Case(
        run=Run(steps=20), box=Box([6, 6]), fluid=Fluid(), solutes=solutes,
        trajectory=Trajectory(every=10),
    )  # fmt: skip
    simulation = Simulation(case, output=tmp_path / "run", threads=1)
    simulation.run(10)
    simulation.checkpoint()
    files, seen = mesokit.open(tmp_path / "run"), []
    seen.append(read(files.export(tmp_path / "a.gsd"))[0])
    simulation.run()
    seen.append(read(mesokit.open(tmp_path / "run").export(tmp_path / "a.gsd"))[0])
    for frame in seen:
        assert (
            frame.particles.types == ["fluid", "polymer-1", "polymer-2"]
            and frame.particles.N == 367
        )
        assert frame.particles.typeid[360:].tolist() == [1, 2, 2, 2, 2, 2, 2]
        assert frame.particles.mass[359:].tolist() == [1, 7, 7, 7, 7, 7, 7, 7]
        assert frame.bonds.group.tolist() == [
            [361, 362],
            [362, 363],
            [364, 365],
            [365, 366],
        ]


@pytest.mark.parametrize("of", ["fluid", "solutes"])
def test_the_fluid_or_the_solutes_alone(of, tmp_path):
    """Kinds, masses and bonds of either, while the run goes on and after it."""
    solutes = Solutes((Polymer(3), Polymer(2, length=3)), mass=5.0, bond=Harmonic(K=2.0))
    case = Case(
        run=Run(steps=20), box=Box([6, 6]), fluid=Fluid(density=2), solutes=solutes,
        trajectory=Trajectory(every=10, of=of, fields=("position", "image")),
    )  # fmt: skip
    simulation = Simulation(case, output=tmp_path / "run", threads=1)
    simulation.run(10)
    simulation.checkpoint()
    files = mesokit.open(tmp_path / "run")
    early = read(files.export(tmp_path / "early.gsd"))
    simulation.run()
    late = read(mesokit.open(tmp_path / "run").export(tmp_path / "late.gsd"))
    ids = {"fluid": range(72), "solutes": range(72, 81)}[of]
    kinds = np.repeat([0, 1, 2], [72, 3, 6])[ids]
    links = {"fluid": [],
             "solutes": [[3, 4], [4, 5], [6, 7], [7, 8]]}[of]  # fmt: skip
    assert (len(early), len(late)) == (2, 3)
    for frame in (*early, *late):
        frame.validate()
        assert frame.particles.typeid.tolist() == kinds.tolist()
        assert frame.particles.mass.tolist() == np.array([1.0, 5.0, 5.0])[kinds].tolist()
        assert (frame.bonds.group.tolist() if frame.bonds.N else []) == links
    np.testing.assert_array_equal(early[0].particles.position, late[0].particles.position)
    where = simulation.engine.positions(np.array(ids), unwrapped=True)
    last = late[-1].particles
    found = last.position[:, :2] + 3.0 + 6 * last.image[:, :2]
    np.testing.assert_allclose(found, where, atol=1e-5)
