"""Kinds of solutes: what is inherited, mixed and refused, and their names in observables."""

import numpy as np
import pytest

from mesokit import (
    FENE,
    WCA,
    Box,
    Case,
    Fluid,
    Harmonic,
    LennardJones,
    MeanSquareDisplacement,
    Molecule,
    MoleculeSize,
    Polymer,
    RadialDistribution,
    Run,
    Solutes,
    Species,
    Table,
)
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected.displacement import Displacement
from mesokit.method.mpcd.expected.molecules import (
    free_bond,
    least_times_of,
    mode_times_of,
    springs_of,
)
from mesokit.method.mpcd.expected.selection import bonds_of, group_of, kind_of
from mesokit.method.mpcd.groups import bonded_pairs
from mesokit.method.mpcd.method import METHOD
from mesokit.method.mpcd.solute.polymer import Between

CHAIN = Polymer(2, length=4, name="chain", bond=Harmonic(K=1.0))
BALL = Polymer(3, name="ball", mass=9.0, pair=WCA(sigma=2.0, epsilon=4.0))


def case_of(solutes, fluid=None, **parts):
    return Case(
        run=Run(1), box=Box([16, 16]), fluid=fluid or Fluid(density=5), solutes=solutes, **parts
    )


def test_kinds_have_what_they_say_and_the_rest_from_all():
    solutes = Solutes([CHAIN, BALL, Polymer(1, length=3)], mass=2.0, bond=FENE(), pair=WCA())
    assert solutes.masses == (2.0, 9.0, 2.0)
    assert solutes.names == ("chain", "ball", "polymer-3")
    assert [solutes.bond_of(k) for k in range(3)] == [Harmonic(K=1.0), None, FENE()]
    assert solutes.total_mass == 2.0 * 8 + 9.0 * 3 + 2.0 * 3
    assert solutes.pairs[1][1] == WCA(sigma=2.0, epsilon=4.0)
    assert solutes.pairs[0][1] == solutes.pairs[1][0] == WCA(sigma=1.5, epsilon=2.0)


def test_what_is_said_between_two_kinds_counts():
    given = Between(["ball", 1], LennardJones(sigma=0.7))
    solutes = Solutes([CHAIN, BALL], between=[given])
    assert solutes.pairs == ((None, given.pair), (given.pair, BALL.pair))
    assert Solutes([CHAIN, BALL]).pairs[0] == (None, None)  # no potential, no force


def test_theory_of_ideal_chains_ends_where_others_push_them():
    pushed = Solutes([CHAIN, BALL], between=[Between([1, 2], WCA())], solvent="random")
    assert springs_of(case_of(Solutes([CHAIN, BALL], solvent="random")), "chain") is not None
    assert springs_of(case_of(pushed), "chain") is None


@pytest.mark.parametrize(
    ("parts", "says"),
    [
        ({"polymers": [CHAIN, BALL, Polymer(pair=LennardJones())]},
         r"^Solutes\.between: missing; pair potentials of 'ball' \(wca\) and 'polymer-3' "
         r"\(lennard-jones\) have no rule"),
        ({"between": [Between(["chain", "bal"])]}, r"between\[#1\]\.kinds: kind = 'bal': .*'ball'"),
        ({"between": [Between([2, 2])]}, r"between\[#1\]\.kinds = \[2, 2\]: expected two kinds"),
        ({"between": [Between([1, 2]), Between([2, 1])]}, r"between\[#2\]\.kinds .* said before"),
        ({"polymers": [CHAIN, CHAIN]}, r"polymers\[#2\]\.name = 'chain': expected another"),
    ],
)  # fmt: skip
def test_what_does_not_go_together(parts, says):
    with pytest.raises(CaseError, match=says):
        Solutes(**{"polymers": [CHAIN, BALL]} | parts)


def test_observables_know_kinds_by_name():
    solutes = Solutes([BALL, CHAIN])
    case = case_of(solutes, observe=[MoleculeSize(kind="chain")])
    assert group_of(case, "beads", "chain") == group_of(case, "beads", 2)
    with pytest.raises(CaseError, match=r"kind = 'chian': expected .* did you mean 'chain'"):
        case_of(solutes, observe=[MoleculeSize(kind="chian")])
    assert [kind.name for kind in case.groups[1].kinds] == ["ball", "chain"]
    assert [kind.diameter for kind in case.groups[1].kinds] == [2.0, 0.5]


TRIMERS = Fluid(density=6, molecule=Molecule(length=3, bond=Harmonic(K=2.0)))


class TestAmongMolecules:
    """A fluid of molecules is a kind of its own, called fluid."""

    def test_either_can_be_named(self):
        case = case_of(Solutes([BALL, CHAIN]), TRIMERS)
        assert case.particles == 1536
        fluid, chain = group_of(case, "beads", "fluid"), group_of(case, "beads", "chain")
        assert (fluid.first, fluid.length, fluid.number) == (0, 3, 512)
        assert (chain.first, chain.length, chain.number) == (1539, 4, 2)
        assert group_of(case, "beads") == group_of(case, "beads", "ball")  # unless said
        assert group_of(case, "particles", None) == fluid
        assert [kind_of(case, group) for group in (fluid, chain)] == ["fluid", 2]
        assert bonds_of(case, "fluid") == slice(0, 1024)
        assert bonds_of(case, "chain") == slice(1024, 1030)
        linked = bonded_pairs(case)
        assert linked[:2].tolist() == [[0, 1], [1, 2]] and linked[1024].tolist() == [1539, 1540]

    def test_a_fluid_of_molecules_alone_has_two_names(self):
        case = case_of(None, TRIMERS)
        assert group_of(case, "beads", "fluid") == group_of(case, "beads", 1)
        with pytest.raises(CaseError, match=r"kind = 2: expected 1 or 'fluid' in a fluid of"):
            case_of(None, TRIMERS, observe=[MoleculeSize(kind=2)])
        with pytest.raises(CaseError, match=r"kind = 'fluid': expected 'ball'"):
            case_of(Solutes([BALL]), observe=[MoleculeSize(kind="fluid")])

    def test_what_is_at_rest_has_its_theory_and_what_moves_has_none(self):
        """Statics do not depend on the solvent; nobody knows how fast anything is in this one."""
        case = case_of(Solutes([BALL, CHAIN]), TRIMERS)
        assert (free_bond(case, "fluid"), free_bond(case, "chain")) == (0.5, 1.0)
        assert mode_times_of(case, "fluid") == (
            None,
            "no theory of a fluid of molecules with solutes",
        )
        assert mode_times_of(case, "chain")[0] is None
        for of, kind in (("particles", None), ("centres", "fluid"), ("beads", 1), ("centres", 2)):
            found = Displacement(case, MeanSquareDisplacement(of=of, kind=kind))
            assert np.isnan(found.coefficient()[0]) and found.expected(np.arange(3)) is None
            assert 0 < found.diffusive_from() < 1000

    def test_error_bars_know_how_slow_molecules_are_at_least(self):
        """In 3D: as slow as in the fluid without bonds, or without solutes."""
        solutes = Solutes([BALL, CHAIN])
        parts = {"run": Run(1), "box": Box([6, 6, 6])}
        both = Case(fluid=TRIMERS, solutes=solutes, **parts)
        simple, alone = (
            Case(fluid=Fluid(density=6), solutes=solutes, **parts),
            Case(fluid=TRIMERS, **parts),
        )
        for kind, other in (("chain", simple), ("fluid", alone)):
            found, wanted = least_times_of(both, kind), mode_times_of(other, kind)[0]
            assert found is not None and (found.mode == wanted.mode).all()

    def test_check_counts_both(self):
        case = case_of(Solutes([BALL, CHAIN], substeps=7), TRIMERS)
        rows = {name: (value, word) for name, value, word in METHOD.summary(case, 1).rows}
        assert rows["molecules"] == ("512", "chains of 3") and rows["beads of solutes"][0] == "11"
        assert rows["sub-steps of solutes"] == ("7", "verlet")
        assert int(rows["sub-steps"][0]) == TRIMERS.molecule.number_of_substeps(2, 0.1, 1.0, 1.0)

    def test_pairs_of_both(self):
        case = case_of(Solutes([BALL, CHAIN]), TRIMERS)
        observable = RadialDistribution(kinds=("fluid", "chain"), particles=30)
        accumulator = observable.accumulator(case)
        assert [len(beads) for beads in (*accumulator.beads, *accumulator.others)] == [10, 2]
        assert accumulator.expected() == 1.0

    @pytest.mark.parametrize(
        ("parts", "says"),
        [
            ({"coupling": "potential", "solvent_pair": WCA()},
             r"^solutes\.coupling = 'potential': not with fluid\.molecule; leave one"),
            ({"solvent": "random"}, r"^solutes\.solvent = 'random': not with fluid\.molecule"),
            ({"polymers": [BALL, Polymer(name="fluid")]},
             r"^solutes\.polymers\[#2\]\.name = 'fluid': this names the molecules of the fluid"),
        ],
    )  # fmt: skip
    def test_what_is_refused(self, parts, says):
        with pytest.raises(CaseError, match=says):
            case_of(Solutes(**{"polymers": [BALL]} | parts), TRIMERS)


def test_displacement_of_one_species():
    fluid = Fluid(species=[Species(1.0, 2.0), Species(4.0, 3.0)])
    case = case_of(None, fluid, observe=[MeanSquareDisplacement(kind=2)])
    accumulator = case.observe[0].accumulator(case)
    assert accumulator.ids.min() >= 512 and accumulator.theory.mass == 4.0
    everybody = MeanSquareDisplacement().accumulator(case)
    assert everybody.theory.number == 1280
    with pytest.raises(CaseError, match=r"kind = 3: expected 1 to 2 \(fluid\.species\)"):
        case_of(None, fluid, observe=[MeanSquareDisplacement(kind=3)])


def test_tables_of_kinds_are_kept_with_the_run(tmp_path):
    file = tmp_path / "soft.txt"
    soft = Table.from_function(lambda r: 5 * (1 - r) ** 2, file, start=0.1, end=1.0)
    own = [Polymer(name=f"kind{k}", pair=soft) for k in range(2)]
    case = case_of(Solutes([*own, BALL], between=[Between([k, 3], soft) for k in (1, 2)]))
    kept = METHOD.initial.kept(case, tmp_path)
    file.unlink()
    names = [p.pair.file for p in kept.solutes.polymers[:2]]
    names += [between.pair.file for between in kept.solutes.between]
    assert len(set(names)) == 4
    again = Table(file=names[3])
    np.testing.assert_array_equal(again.rows, soft.rows)
    kernels = [solutes.kernel(2, case.fluid).pair for solutes in (kept.solutes, case.solutes)]
    assert kernels[0] == kernels[1]
