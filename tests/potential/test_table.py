"""Pair potentials from tables: as good as what they were made of, and refused if wrong."""

import dataclasses

import numpy as np
import pytest

import mesokit
from mesokit import CaseError, LennardJones, Polymer, Simulation, Solutes, Table
from mesokit.potential.protocol import central
from tests.helpers.small_fluids import make_case, make_fluid

LJ = LennardJones(epsilon=1.5, sigma=1.2, cutoff=2.5)
R = np.linspace(0.9, 3.0, 400)


def formula(r):
    sixth = (1.2 / r) ** 6
    return 6.0 * (sixth * sixth - sixth)


def force(r):
    sixth = (1.2 / r) ** 6
    return 36.0 * (2.0 * sixth * sixth - sixth) / r


@pytest.fixture(scope="module")
def table(tmp_path_factory):
    file = tmp_path_factory.mktemp("table") / "lj.txt"
    return Table.from_function(formula, file, start=0.9, end=3.0)


@pytest.mark.parametrize("columns", [2, 3])
@pytest.mark.parametrize("rows", [100, 200, 400])
def test_a_table_of_lennard_jones_is_lennard_jones(tmp_path, columns, rows):
    """Cubics miss U by h^4 U''''/384 between rows, with forces; splines by five times that."""
    r = np.linspace(0.9, 3.0, rows)
    file = tmp_path / "lj.txt"
    np.savetxt(file, np.column_stack([r, formula(r), force(r)][:columns]), "%.15g")
    made, exact = Table(file=str(file)).kernel(), LJ.kernel()
    between = np.linspace(0.95, 2.99, 501)
    found = np.array([central(made, x * x) for x in between])
    expected = np.array([central(exact, x * x) for x in between])
    fourth = 6.0 * 12 * 13 * 14 * 15 * (1.2 / between) ** 12 / between**4
    bound = (r[1] - r[0]) ** 4 * fourth / 384 * (2 if columns == 3 else 10) + 1e-7
    assert (np.abs(found[:, 0] - expected[:, 0]) < bound).all()
    np.testing.assert_allclose(
        found[:, 1], expected[:, 1], rtol=2e-2 * (100 / rows) ** 2, atol=1e-3
    )
    assert central(made, 9.01) == (0.0, 0.0)


def test_what_it_says_of_itself(table):
    assert table.reach == 3.0
    assert 1.0 < table.diameter < 1.2
    near = [central(table.kernel(), square) for square in (0.0, 0.4, 0.81)]
    assert near[0][1] == near[1][1] == pytest.approx(near[2][1], rel=1e-6)
    assert near[0][0] > near[1][0] > near[2][0]
    bare = dataclasses.replace(table, shift=False)
    shift = central(bare.kernel(), 1.0)[0] - central(table.kernel(), 1.0)[0]
    assert shift == pytest.approx(formula(3.0))


def two(pair, substeps=20, **others):
    """Two beads alone, over the boundary of the box."""
    solutes = Solutes((Polymer(2),), mass=2.0, pair=pair, substeps=substeps)
    fluid = make_fluid((12, 10, 12), solutes=solutes, density=2 / 1440, **others)
    fluid.solutes.places[:] = [[6.0, 9.3, 6.0], [6.3, 10.35, 6.2]]
    fluid.solutes.velocities[:] = 0.0
    fluid.solutes.forget_lists()
    return fluid


def test_beads_in_a_run(table):
    """The force moves them, its virial is the stress, energy is kept to second order."""
    changes = []
    for substeps in (20, 40):
        fluid = two(table, substeps)
        before = fluid.totals()[2] + fluid.potential_energy()
        assert fluid.potential_energy() == pytest.approx(formula(1.110), rel=0.1)
        fluid.advance(1)
        changes.append(abs(fluid.totals()[2] + fluid.potential_energy() - before))
    assert changes[0] < 0.1
    assert changes[1] < 0.35 * changes[0]
    fluid = two(table, 20, measures=("stress",), timestep=0.002)
    way = np.array([0.3, 1.05, 0.2])
    push = force(np.linalg.norm(way)) / np.linalg.norm(way)
    fluid.advance(1, measure=["stress"])
    mean = fluid.stress["bond"]
    assert mean[0, 1] == pytest.approx(mean[1, 0])
    np.testing.assert_allclose(mean, -push * np.outer(way, way) / 1440, rtol=0.02, atol=1e-6)


def test_a_run_keeps_its_table(table, tmp_path):
    """A run in a folder may be moved, and goes on whatever becomes of the file."""
    file = tmp_path / "mine.txt"
    file.write_bytes(table.contents)
    solutes = Solutes((Polymer(2),), mass=2.0, pair=Table(file=str(file)), substeps=20)
    case = make_case((12, 10, 12), solutes=solutes, density=2 / 1440)
    Simulation(case, output=tmp_path / "run", threads=1)
    file.unlink()
    (tmp_path / "run").rename(tmp_path / "moved")
    again = Simulation.resume(tmp_path / "moved", threads=1)
    again.run()
    assert again.step == 1
    kept = mesokit.open(tmp_path / "moved").case.solutes.pair
    assert kept.contents == table.contents
    assert kept.file == str(tmp_path / "moved" / "part-pair.txt")


LAMMPS = """# made by pair_write

OTHER
N 4 R 1.0 4.0

1 1.0 5.0 3.0
2 2.0 3.0 1.5
3 3.0 2.0 0.5
4 4.0 1.9 0.1

SOFT
N 4

1 0.5 4.0 3.0
2 1.0 2.5 3.0
3 1.5 1.0 3.0
4 2.0 -0.5 3.0
"""


def test_files_of_lammps(tmp_path):
    file = tmp_path / "pair.table"
    file.write_text(LAMMPS)
    assert Table(file=str(file)).rows.shape == (4, 3)
    soft = Table(file=str(file), section="SOFT")
    assert soft.reach == 2.0
    assert central(soft.kernel(), 1.44)[0] == pytest.approx(3.0 * 0.8)
    with pytest.raises(CaseError, match=r"no section 'HARD'; there are OTHER, SOFT"):
        Table(file=str(file), section="HARD")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("1 4\n2 1\n1.5 0\n3 0", r"line 3: r = 1.5; expected more than the 2 before"),
        ("0 4\n2 1\n3 0\n4 0", r"line 1: r = 0; expected a distance above 0"),
        ("1 4\n2 1 7\n3 0\n4 0", r"line 2: 3 numbers; expected r, U and maybe F in each row"),
        ("1 4\n2 one\n3 0\n4 0", r"line 2: expected numbers, not '2 one'"),
        ("1 4\n2 nan\n3 0\n4 0", r"line 2: expected finite numbers"),
        ("1 4\n2 1\n3 0", r"3 rows; expected 4 or more"),
        ("# r U\n", r"there are none"),
        (
            "1 4 -3\n2 1 -3\n3 -2 -3\n4 -5 -3",
            r"line 2: from the row .* by the forces it would be 3",
        ),
        ("\x00\xff", r"expected"),
    ],
)
def test_wrong_files_are_refused_with_the_line(tmp_path, text, words):
    file = tmp_path / "pair.txt"
    file.write_bytes(text.encode("latin-1"))
    with pytest.raises(CaseError, match=words):
        Table(file=str(file))


def test_errors_name_the_key_of_the_case(tmp_path):
    case = tmp_path / "case.toml"
    case.write_text(
        "[run]\nsteps = 1\n[box]\nsize = [8, 8]\n[solutes]\npolymers = [{ number = 2 }]\n"
        'pair = { rule = "table", file = "no.txt" }\n'
    )
    with pytest.raises(CaseError, match=r"solutes.pair.file = '.*no.txt': no such file$"):
        mesokit.Case.from_toml(case)
    with pytest.raises(CaseError, match=r"Table: energy: expected a number"):
        Table.from_function(lambda r: "a", tmp_path / "x.txt", 0.5, 1)
