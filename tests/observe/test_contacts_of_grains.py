"""Forces and network of contacts: known distributions, lattices and chains, and their errors."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from mesokit import (
    Box,
    Case,
    ContactForces,
    ContactNetwork,
    Plates,
    RandomStart,
    Run,
    Simulation,
    SoftSpheres,
    SphereKind,
    SpringDashpot,
)
from mesokit.method.spheres.common.contacts.now import Contacts
from mesokit.method.spheres.common.observe.bearing import bearing
from mesokit.method.spheres.common.observe.contact_network import bearers, derivative
from mesokit.method.spheres.rigid.law.contact import RigidContact
from mesokit.method.spheres.rigid.section import RigidSpheres
from tests.helpers.comparisons import by_name
from tests.helpers.grains import grains
from tests.helpers.soft_spheres import at_rest

MU = 0.5


def case_of(n=400, walls=(), friction=MU, d=2, **spheres):
    return Case(
        run=Run(1, method="soft-spheres"), box=Box([60.0] * d), walls=list(walls),
        spheres=SoftSpheres(number=n, pair=SpringDashpot(friction=friction), **spheres),
    )  # fmt: skip


def state(pairs, normals, normal, tangential=0.0, n=400):
    """An engine with these contacts; the tangential forces of disks."""
    normals, pairs = np.asarray(normals, float), np.asarray(pairs)
    across = np.stack([-normals[:, 1], normals[:, 0]], axis=1) if normals.shape[1] == 2 else 0.0
    normal, tangential = (np.broadcast_to(f, len(pairs))[:, None] for f in (normal, tangential))
    forces = normal * normals + tangential * across
    found = Contacts(pairs, normals, forces, np.zeros_like(normals), np.zeros(len(pairs)))
    return SimpleNamespace(contacts=lambda: found, n=n, dimension=normals.shape[1])


def random_pairs(rng, m, n=400):
    one = rng.integers(0, n - 1, m)
    return np.stack([one, one + 1], axis=1)


def turned(rng, m):
    angle = rng.uniform(0, 2 * np.pi, m)
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


def measured(observable, states, case=None):
    """The result, its comparisons by name, of samples of an engine."""
    case = case_of() if case is None else case
    accumulator = observable.accumulator(case)
    for each in states:
        accumulator.observe(each)
    result = accumulator.result()
    return result, by_name(result)


# --- forces -------------------------------------------------------------------------------------


def test_exponential_forces_have_their_density_decay_and_errors():
    """Of exp(-f): beta = 1, 1 - 1/e below the mean; of uniform shares of friction 1/2."""
    rng, m = np.random.default_rng(3), 20_000
    force = rng.exponential(2.5, m)
    share = rng.uniform(0, 1, m)
    one = state(random_pairs(rng, m), turned(rng, m), force, MU * share * force)
    result, said = measured(ContactForces(), [one] * 4)  # at rest: samples are all the same
    low, high = result.extra["edges"][:-1], result.extra["edges"][1:]
    wanted = (np.exp(-low) - np.exp(-high)) / (high - low)
    off = (result.value - wanted) / result.error
    assert np.abs(off).max() < 4.5
    assert 0.4 < (off**2).mean() < 2.0
    mean = said["mean normal force"]
    assert abs(mean.measured - 2.5) < 4 * mean.error
    # errors are those of groups of grains, as if of so many contacts, though time repeats them
    assert mean.error == pytest.approx(2.5 / math.sqrt(m), rel=0.75)
    beta, below = said["decay above the mean, beta"], said["share of contacts below the mean"]
    assert abs(beta.measured - 1.0) < 4 * beta.error < 0.2
    assert abs(below.measured - (1 - math.exp(-1))) < 4 * below.error < 0.05
    assert result.extra["logarithmic"]
    known = result.extra["beside"][result.x["force"] > 1]
    assert known == pytest.approx(np.exp(-result.x["force"][result.x["force"] > 1]), rel=0.2)
    friction, said = measured(ContactForces(of="friction", bins=10), [one])
    assert np.abs((friction.value - 1.0) / friction.error).max() < 4.5
    mobilised = said["mean share of the largest friction"]
    assert abs(mobilised.measured - 0.5) < 4 * mobilised.error < 0.02
    assert said["share of contacts that slide"].measured == pytest.approx(0.001, abs=0.001)


def test_forces_are_over_the_mean_of_their_time_and_walls_are_left_out():
    """Two samples, of which the second has ten times the forces; at walls they are larger."""
    rng, m = np.random.default_rng(4), 500
    pairs, normals, force = random_pairs(rng, m), turned(rng, m), rng.uniform(0.5, 1.5, m)
    pairs[:50, 1] = -1
    force[:50] = 40.0
    states = [state(pairs, normals, scale * force) for scale in (1.0, 10.0)]
    result, said = measured(ContactForces(bins=16), states)
    assert result.value[result.x["force"] > 2.0].max() == 0.0
    assert (result.value * np.diff(result.extra["edges"])).sum() == pytest.approx(1.0)
    wanted = 5.5 * force[50:].mean()
    assert said["mean normal force"].measured == pytest.approx(wanted)


def test_contacts_that_pull_or_bear_nothing_do_not_count():
    rng = np.random.default_rng(5)
    pairs, normals = random_pairs(rng, 100), turned(rng, 100)
    force = np.repeat([1.0, -0.2, 0.0, 1e-9], [60, 20, 10, 10])
    engine = state(pairs, normals, force)
    found = bearing(engine.contacts(), 1e-6)
    assert len(found.normal) == 60
    assert found.pulled == 20
    assert len(bearing(engine.contacts(), 0.0).normal) == 70
    _, said = measured(ContactForces(), [engine])
    assert said["mean normal force"].measured == pytest.approx(1.0)
    assert said["contacts that pull, for each that pushes"].measured == pytest.approx(1 / 3)
    accumulator = ContactForces().accumulator(case_of())
    accumulator.observe(state(pairs, normals, -1.0))
    empty = accumulator.result()
    assert empty.comparisons == ()
    assert np.isnan(empty.value).all()


def test_disks_of_a_compressed_triangular_lattice_press_alike():
    """Each overlap is 0.02, so each force is 0.02 k; six contacts; no direction."""
    a, law = 0.98, SpringDashpot(1.0, contact_time=0.02)
    rows = np.array([[i + 0.5 * (j % 2) + 0.25, j + 0.5] for j in range(6) for i in range(6)])
    places = rows * [a, a * math.sqrt(3) / 2]
    case = Case(
        run=Run(0, method="soft-spheres"),
        box=Box([6 * a, 6 * a * math.sqrt(3) / 2]),
        spheres=SoftSpheres(number=36, pair=law, start=RandomStart()),
    )
    engine = Simulation(case, threads=1, **at_rest(places)).engine
    stiffness, _ = law.constants(0.5 * engine.masses()[0])
    _, said = measured(ContactForces(), [engine], case)
    assert said["mean normal force"].measured == pytest.approx(0.02 * stiffness, rel=1e-9)
    result, said = measured(ContactNetwork(), [engine], case)
    assert result.value.tolist() == [0.0] * 6 + [1.0] + [0.0] * 4
    assert said["coordination without rattlers"].measured == 6.0
    assert said["coordination without rattlers"].expected == pytest.approx(4 - 2 / 36)
    for k in (1, 2):
        assert said[f"fabric eigenvalue {k}"].measured == pytest.approx(0.5)
    assert math.isnan(said["direction of most contacts"].measured)


# --- network ------------------------------------------------------------------------------------


def test_rattlers_leave_one_after_another():
    """A ring of four with a tail of two, and one alone."""
    pairs = np.array([[0, 1], [1, 2], [2, 3], [0, 3], [3, 4], [4, 5]])
    assert bearers(pairs, 7, 2).tolist() == [True] * 4 + [False] * 3
    assert bearers(pairs, 7, 1).tolist() == [True] * 6 + [False]
    assert not bearers(pairs, 7, 3).any()
    held = np.array([[0, 1], [1, -1], [0, -1]])
    assert bearers(held, 3, 2).tolist() == [True, True, False]


@pytest.mark.parametrize(
    ("friction", "gravity", "kept"), [(0.5, (), 9), (0.0, (), 3), (0.0, (0.0, -1.0), 9)]
)
def test_fewest_contacts_that_hold_a_grain(friction, gravity, kept):
    """Three grains with three contacts, six with two; d + 1, of which the weight may be one."""
    pairs = np.array([[0, 1], [1, 2], [0, 2], [0, -1], [1, -1], [2, -2]])
    pairs = np.concatenate([pairs, [[k, -1] for k in range(3, 9)], [[k, -2] for k in range(3, 9)]])
    case = case_of(10, [Plates("y")], friction, gravity=gravity)
    normals = np.tile([0.0, 1.0], (len(pairs), 1))
    _, said = measured(ContactNetwork(), [state(pairs, normals, 1.0, n=10)], case)
    assert said["share of rattlers"].measured == pytest.approx(1 - kept / 10)
    assert said["contacts of a grain"].measured == pytest.approx((3 * 3 + 6 * 2) / 10)
    # three pairs and three contacts with walls, and with two at walls for each of the others
    wanted = 2 * (6 + 2 * (kept - 3)) / kept
    assert said["coordination without rattlers"].measured == pytest.approx(wanted)
    assert said["coordination without rattlers"].expected == (3.0 if friction else 4.0)


def test_fabric_of_contacts_with_a_known_direction():
    """Eigenvalues are 1/2 + a/4 and 1/2 - a/4 of P(theta) = (1 + a cos 2(theta - t))/2 pi."""
    rng, a, t, m = np.random.default_rng(6), 0.6, np.radians(40.0), 20_000
    angle = rng.uniform(0, 2 * np.pi, 4 * m)
    chosen = angle[rng.uniform(0, 1 + a, 4 * m) < 1 + a * np.cos(2 * (angle - t))][:m]
    normals = np.stack([np.cos(chosen), np.sin(chosen)], axis=1)
    _, said = measured(ContactNetwork(), [state(random_pairs(rng, m), normals, 1.0)] * 5)
    for name, wanted in (
        ("fabric eigenvalue 1", 0.5 + a / 4),
        ("fabric eigenvalue 2", 0.5 - a / 4),
        ("fabric anisotropy", a / 2),
        ("direction of most contacts", 40.0),
    ):
        assert abs(said[name].measured - wanted) < 4 * said[name].error
    # of N contacts: the variance of n_x n_x - n_y n_y is 1/2 - (a/2)^2, and sigma of an angle
    # is half of that of n_x n_y over the anisotropy
    assert said["fabric anisotropy"].error == pytest.approx(
        math.sqrt((0.5 - (a / 2) ** 2) / m), rel=0.75
    )
    turn = np.degrees(math.sqrt(0.125 / m) / (a / 2))
    assert said["direction of most contacts"].error == pytest.approx(turn, rel=0.75)


@pytest.mark.parametrize("d", [2, 3])
def test_derivatives_of_a_form_are_those_by_each_entry(d):
    rng = np.random.default_rng(8)
    half, one, other = rng.normal(size=(d, d)), rng.normal(size=d), rng.normal(size=d)
    tensor = half + half.T
    entries = tensor[np.triu_indices(d)]
    assert derivative(one, other) @ entries == pytest.approx(one @ tensor @ other)


def test_samples_of_a_network_at_rest_make_no_error_smaller():
    rng = np.random.default_rng(9)
    one = state(random_pairs(rng, 800), turned(rng, 800), rng.exponential(1.0, 800))
    single, said = measured(ContactForces(), [one])
    many, said_of_many = measured(ContactForces(), [one] * 200)
    assert many.error == pytest.approx(single.error)
    assert (single.error[single.value > 0] > 0).all()
    for name in ("mean normal force", "decay above the mean, beta"):
        assert said_of_many[name].error == pytest.approx(said[name].error)


def test_fabric_in_space_has_three_eigenvalues():
    rng, m = np.random.default_rng(7), 2000
    normals = np.concatenate([np.tile([0.0, 0.0, 1.0], (m, 1)), np.tile([1.0, 0.0, 0.0], (m, 1))])
    pairs, case = random_pairs(rng, 2 * m), case_of(d=3)
    wide = rng.normal(size=(2 * m, 3)) * [1.0, 1.0, 2.0]
    wide /= np.linalg.norm(wide, axis=1, keepdims=True)
    _, upright = measured(ContactNetwork(), [state(pairs, wide, 1.0)], case)
    parts = [upright[f"direction of most contacts along {axis}"] for axis in "xyz"]
    # of z, beside which x and y are small and have errors; abs(z) has its error in second order
    assert parts[2].measured == pytest.approx(1.0, abs=0.01)
    assert parts[2].error < 0.1 * parts[0].error
    for part in parts[:2]:
        assert part.measured < 4 * part.error < 0.2
    _, said = measured(ContactNetwork(), [state(pairs, normals, np.repeat([1.0, 0.5], m))], case)
    values = [said[f"fabric eigenvalue {k}"].measured for k in (1, 2, 3)]
    assert values == pytest.approx([0.5, 0.5, 0.0])
    assert said["coordination without rattlers"].expected == pytest.approx(4.0, abs=0.01)


@pytest.mark.long
def test_rigid_grains_without_friction_are_isostatic():
    """300 poured disks in a bin: twice the contacts over the grains is 2 d = 4."""
    case = Case(
        run=Run(400, method="contact-dynamics", warmup=1600, seed=2),
        box=Box([22, 30]),
        walls=[Plates("y"), Plates("x")],
        spheres=RigidSpheres(
            number=300, kinds=[SphereKind(1.0, spread=0.2)], gravity=[0.0, -1.0], kT=0.01,
            start=RandomStart(), contact=RigidContact(friction=0.0), timestep=0.02,
        ),
        observe=[ContactNetwork(every=20)],
    )  # fmt: skip
    simulation = Simulation(case, threads=1)
    simulation.run()
    said = by_name(simulation["contact-network"])
    found = said["coordination without rattlers"]
    assert found.expected == 4.0
    assert abs(found.measured - 4.0) < 4 * found.error < 0.3
    assert said["share of rattlers"].measured < 0.05


# --- in runs ------------------------------------------------------------------------------------


def test_a_bed_has_the_contacts_of_its_engine(tmp_path):
    """The run, stopped and gone on with, has the same numbers; they are those of the engine."""
    observe = [ContactForces(every=500), ContactNetwork(every=500, least=0.0)]
    observe.append(ContactForces(of="friction", name="mobilisation", every=500))
    case = grains(observe=observe, trajectory=False)
    whole = Simulation(case, threads=1)
    whole.run()
    first = Simulation(case, output=tmp_path / "run", threads=1)
    first.run(9000)
    first.checkpoint()
    second = Simulation.resume(tmp_path / "run", threads=1)
    second.run()
    names = ("contact-forces", "contact-network", "mobilisation")
    assert [second[name] == whole[name] for name in names] == [True] * 3
    accumulator = ContactNetwork(least=0.0).accumulator(case)
    accumulator.observe(whole.engine)
    found = whole.engine.contacts()
    pushing = found.pairs[found.normal_forces > 0]
    said = by_name(accumulator.result())
    count = np.bincount(pushing[pushing >= 0], minlength=60)
    assert said["contacts of a grain"].measured == pytest.approx(count.mean())
    assert count.mean() <= whole.engine.coordination().mean()
