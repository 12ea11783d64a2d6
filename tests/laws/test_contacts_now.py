"""Contacts as an engine lists them: their forces add up to those on each sphere, and no more."""

import numpy as np
import pytest

from mesokit import (
    Disk,
    LennardJones,
    Plates,
    RandomStart,
    Rectangle,
    SpringDashpot,
    Surface,
)
from mesokit.method.spheres.common.contacts.now import in_order
from tests.helpers.rigid_grains import exact, rigid
from tests.helpers.soft_spheres import at_rest, pile, soft

ROLLING = SpringDashpot(0.4, contact_time=0.02, friction=0.5, rolling=0.1)


def on_each(engine, found):
    """The sum of the forces of contacts on each sphere."""
    total, between = np.zeros((engine.n, engine.dimension)), ~found.at_walls
    np.add.at(total, found.pairs[:, 0], found.forces)
    np.subtract.at(total, found.pairs[between, 1], found.forces[between])
    return total


def bed(threads=1):
    """Spheres in 3D that have fallen on a plate that moves."""
    engine = soft(
        [4.0, 4.0, 6.0], walls=[Plates("z", lower=Surface(velocity=[0.3, 0.0, 0.0]))], number=40,
        kT=0.1, gravity=[0.0, 0.0, -10.0], start=RandomStart(), pair=ROLLING, threads=threads,
    )  # fmt: skip
    engine.advance(6000)
    return engine


def settled(threads=1):
    """Disks that have fallen on a plate and on a block that stands askew."""
    engine = pile(threads)
    engine.advance(8000)
    return engine


@pytest.mark.parametrize("made", [settled, bed])
def test_forces_of_contacts_add_up_to_those_on_each_sphere(made):
    engine = made()
    engine.system.find_forces(engine.time)  # those of the present velocities, as of contacts
    found, forces = engine.contacts(), engine.forces()
    assert found.at_walls.sum() > 3
    assert (~found.at_walls).sum() > 20
    assert found.tangential_forces.max() > 0.01 * found.normal_forces.max()
    assert on_each(engine, found) == pytest.approx(forces, abs=1e-9 * np.abs(forces).max())
    ends = np.concatenate([found.pairs[:, 0], found.pairs[~found.at_walls, 1]])
    assert np.array_equal(np.bincount(ends, minlength=engine.n), engine.coordination())


def test_contacts_lie_in_order_with_normals_gaps_and_places():
    engine = settled()
    found, between = engine.contacts(), ~engine.contacts().at_walls
    order = np.lexsort((found.pairs[:, 1], found.pairs[:, 0]))
    assert np.array_equal(found.pairs[order], found.pairs)
    assert (found.pairs[between, 0] < found.pairs[between, 1]).all()
    assert np.linalg.norm(found.normals, axis=1) == pytest.approx(np.ones(len(found.gaps)))
    one, other = found.pairs[between].T
    way = engine.positions()[one] - engine.positions()[other]
    way[:, 0] -= 16 * np.rint(way[:, 0] / 16)  # x repeats
    apart, radii = np.linalg.norm(way, axis=1), engine.diameters() / 2
    assert found.gaps[between] == pytest.approx(apart - radii[one] - radii[other], abs=1e-12)
    assert found.normals[between] == pytest.approx(way / apart[:, None], abs=1e-9)
    assert (found.gaps < 0).all()
    away = found.places - engine.positions()[found.pairs[:, 0]]
    away[:, 0] -= 16 * np.rint(away[:, 0] / 16)
    depth = np.where(between, 0.5, 1.0) * -found.gaps  # of pairs in the middle of the overlap
    wanted = -(radii[found.pairs[:, 0]] - depth)[:, None] * found.normals
    assert away == pytest.approx(wanted, abs=1e-9)
    assert ((found.places >= 0) & (found.places[:, :1] < 16)).all()


def test_surfaces_are_counted_as_those_that_take_momentum():
    """A disk on the floor, one on a round obstacle, one at the ceiling: surfaces 0, 2 and 1."""
    walls = [Plates("y"), Disk(centre=[8.0, 3.0], radius=1.0)]
    places = [[3.0, 0.495], [8.0, 4.495], [12.0, 5.51]]
    engine = soft(
        [16.0, 6.0], walls=walls, given=at_rest(places), number=3, pair=ROLLING,
        start=RandomStart(),
    )  # fmt: skip
    found = engine.contacts()
    assert found.pairs.tolist() == [[0, -1], [1, -3], [2, -2]]
    engine.advance(1)
    taken = engine.wall_impulse / engine.timestep
    assert found.forces == pytest.approx(-taken[[0, 2, 1]], rel=0.05)
    assert found.places[:, 1] == pytest.approx([0.0, 4.0, 6.0])


def test_contacts_have_the_same_bits_on_any_number_of_threads():
    one, three = settled(1).contacts(), settled(3).contacts()
    assert [np.array_equal(a, b) for a, b in zip(one, three, strict=True)] == [True] * 5


def test_contacts_of_a_potential_are_none_and_faces_of_one_surface_have_an_order():
    engine = soft([6.0, 6.0], number=9, kT=0.1, pair=LennardJones(), timestep=0.001)
    assert len(engine.contacts().pairs) == 0
    pairs, values = np.array([[2, -1], [2, -1], [0, 1]]), np.zeros((3, 10))
    values[:, 6] = [3.0, 1.0, 9.0]
    found = in_order(pairs, values, 2, lambda places: places)
    assert found.pairs.tolist() == [[0, 1], [2, -1], [2, -1]]
    assert found.places[:, 0].tolist() == [9.0, 1.0, 3.0]


def rigid_pile(threads=1):
    """The same walls, with rigid grains that touch or fall."""
    engine = rigid(
        [16, 14], walls=[Plates("y"), Rectangle(centre=[8, 2], size=[9, 3], angle=20)], number=60,
        kT=0.5, gravity=[0.0, -2.0], start=RandomStart(), timestep=0.01, threads=threads,
        contact={"friction": 0.5},
    )  # fmt: skip
    engine.advance(400)
    return engine


def test_forces_of_rigid_contacts_change_velocities_as_they_did_in_the_last_step():
    engine = rigid_pile()
    before = engine.velocities().copy()
    engine.advance(1)
    change = (engine.velocities() - before) / engine.timestep - np.array([0.0, -2.0])
    found = engine.contacts()
    wanted = engine.masses()[:, None] * change
    assert found.at_walls.sum() > 3
    assert (~found.at_walls).sum() > 20
    assert on_each(engine, found) == pytest.approx(wanted, abs=1e-9 * np.abs(wanted).max())
    # normals are those of now, so they have turned since the impulses were found
    turned = 2 * np.linalg.norm(before, axis=1).max() * engine.timestep
    size = np.linalg.norm(found.forces, axis=1)
    assert (found.normal_forces >= -turned * size).all()
    assert (found.tangential_forces <= 0.5 * found.normal_forces + 1.5 * turned * size).all()


def test_a_column_of_rigid_grains_carries_its_weight_contact_by_contact():
    places = [[3.0, 0.5 + k] for k in range(5)]
    engine = rigid(
        [6.0, 8.0], walls=[Plates("y")], given=at_rest(places), gravity=[0.0, -2.0],
        timestep=0.01, solver=exact(),
    )  # fmt: skip
    engine.advance(5)
    found = engine.contacts()
    assert found.pairs.tolist() == [[0, -1], [0, 1], [1, 2], [2, 3], [3, 4]]
    # each grain is pushed up from below, and the first of a pair down by those above
    wanted = [10.0, -8.0, -6.0, -4.0, -2.0]
    assert found.forces[:, 1] == pytest.approx(wanted, rel=1e-6)
    assert found.normals[:, 1].tolist() == [1.0, -1.0, -1.0, -1.0, -1.0]
    assert found.places[:, 1] == pytest.approx([0.0, 1.0, 2.0, 3.0, 4.0], abs=1e-3)
