"""Beads of solutes start from arrays, files of other programs and earlier runs."""

import gsd.hoomd
import numpy as np
import pytest

from mesokit import Harmonic
from mesokit.errors import CaseError
from mesokit.method.mpcd.engine.cpu.engine import CPU
from mesokit.method.mpcd.solutes import Polymer, Solutes
from mesokit.method.mpcd.start.first_state import first_state
from mesokit.method.mpcd.start.fluid import start
from mesokit.method.mpcd.start.section import Start
from tests.helpers.small_fluids import make_case

SIZE = (8, 8, 8)
CHAINS = {"polymers": (Polymer(3, length=4),), "mass": 5.0, "bond": Harmonic(K=1.0)}


def case_from(**parts):
    given = CHAINS | parts | {"start": Start(**parts.get("start", {}))}
    return make_case(SIZE, density=2, solutes=Solutes(**given))


@pytest.fixture
def fluid():
    cpu = CPU(case_from())
    start(cpu)
    cpu.advance(5)
    return cpu


def written(path, fluid, change=lambda frame: None):
    """The beads as another program would write them, in an order of its own."""
    order = np.random.default_rng(1).permutation(12)
    row = np.argsort(order)
    frame = gsd.hoomd.Frame()
    r, v, boxes = fluid.solutes.folded()
    frame.configuration.box = [*SIZE, 0, 0, 0]
    frame.particles.N = 12
    frame.particles.position = (r - 4.0)[order]
    frame.particles.velocity = v[order]
    frame.particles.image = boxes[order]
    frame.particles.mass = np.full(12, 5.0)
    frame.bonds.N = 9
    frame.bonds.group = row[fluid.solutes.bonds]
    change(frame)
    with gsd.hoomd.open(path, "w") as file:
        file.append(frame)
    return path


def test_from_arrays(fluid):
    r, v = fluid.solutes.places.copy(), fluid.solutes.velocities.copy()
    state = first_state(case_from(), beads=r, bead_velocities=v)
    other = CPU(case_from())
    start(other, *state)
    np.testing.assert_array_equal(other.solutes.places, r)
    np.testing.assert_array_equal(other.solutes.velocities, v)


def test_from_a_gsd_file_whose_beads_are_in_another_order(tmp_path, fluid):
    path = written(tmp_path / "chains.gsd", fluid)
    state = first_state(case_from(start={"file": str(path)}))
    way = state.beads.reshape(3, 4, 3)
    way = way[:, 1:] - way[:, :-1]
    truth = fluid.solutes.places.reshape(3, 4, 3)
    truth = truth[:, 1:] - truth[:, :-1]
    found = sorted(np.linalg.norm(way, axis=2).sum(axis=1))
    np.testing.assert_allclose(found, sorted(np.linalg.norm(truth, axis=2).sum(axis=1)), atol=1e-5)
    np.testing.assert_allclose(
        state.bead_velocities.sum(axis=0), fluid.solutes.velocities.sum(axis=0), atol=1e-5
    )


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda f: setattr(f.particles, "mass", np.full(12, 2.0)), "has mass 2; expected 5"),
        (lambda f: setattr(f.configuration, "box", [9, 8, 8, 0, 0, 0]), "it has a box of"),
        (lambda f: setattr(f.bonds, "group", np.roll(f.bonds.group, 1)), "bonds"),
    ],
)
def test_another_file_is_refused(tmp_path, fluid, change, says):
    path = written(tmp_path / "chains.gsd", fluid, change)
    with pytest.raises(CaseError, match=r"^solutes\.start\.file = .*" + says):
        first_state(case_from(start={"file": str(path)}))


def test_arrays_that_do_not_fit():
    with pytest.raises(
        CaseError, match=r"solutes\.start\.positions: shape \(4, 3\): expected \(12, 3\)"
    ):
        first_state(case_from(), beads=np.zeros((4, 3)))
    with pytest.raises(CaseError, match="beads: there are no solutes"):
        first_state(make_case(SIZE, density=2), beads=np.zeros((4, 3)))


def test_from_an_earlier_run(tmp_path):
    from mesokit import Simulation

    earlier = Simulation(case_from(), output=tmp_path / "run", threads=1)
    earlier.run()
    later = Simulation(case_from(start={"run": str(tmp_path / "run")}), threads=1)
    np.testing.assert_array_equal(later.engine.solutes.places, earlier.engine.solutes.places)
    with pytest.raises(CaseError, match=r"solutes\.start\.run = .* that run has solutes\.polymers"):
        Simulation(
            case_from(polymers=(Polymer(2, length=6),), start={"run": str(tmp_path / "run")})
        )
