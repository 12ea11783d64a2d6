"""Sweeps over contacts of rigid grains, beside sweeps: chains, columns, lattices, waves."""

import itertools
import math

import numpy as np
import pytest

from mesokit import theory


def random_sweeps(initial):
    """Mean and standard error of the middle contact after one sweep in random order.

    Of 17 contacts, one of 200,000 orders each: a walk of more than 8 steps has the share 1e-8.
    """
    rng = np.random.default_rng(1)
    place = np.arange(-9, 10)
    forces = np.tile(initial(place.astype(float)), (200_000, 1))
    orders = rng.permuted(np.tile(np.arange(1, 18), (len(forces), 1)), axis=1)
    rows = np.arange(len(forces))
    for contact in orders.T:
        forces[rows, contact] = (forces[rows, contact - 1] + forces[rows, contact + 1]) / 2
    return forces[:, 9].mean(), forces[:, 9].std() / math.sqrt(len(forces))


def test_spread_of_a_random_sweep():
    """Forces x^2 grow by 2 q."""
    mean, error = random_sweeps(lambda x: x**2)
    assert theory.sweep_spread("random") == pytest.approx(mean / 2, abs=2 * error)
    assert theory.sweep_spread("random") == pytest.approx(0.79744, abs=5e-6)
    assert error < 0.004


@pytest.mark.parametrize("wave_number", [0.5, 1.5, 3.0])
def test_factor_of_a_random_sweep(wave_number):
    mean, error = random_sweeps(lambda x: np.cos(wave_number * x))
    assert theory.sweep_factor(wave_number, "random") == pytest.approx(mean, abs=4 * error)


@pytest.mark.parametrize("order", ["random", "coloured", "ordered", "jacobi"])
def test_spread_is_the_factor_of_long_waves(order):
    factor = theory.sweep_factor(1e-3, order)
    assert (1 - factor) / 1e-6 == pytest.approx(theory.sweep_spread(order), rel=1e-5)


def swept(forces, order, column):
    """Errors after one sweep; the ends have none, or the first contact is that of the floor."""
    count = len(forces)
    new, old = forces.copy(), forces.copy()
    turns = [*range(0, count, 2), *range(1, count, 2)] if order == "coloured" else range(count)
    for i in turns:
        read = old if order == "jacobi" else new
        right = read[i + 1] if i + 1 < count else 0.0
        left = read[i - 1] if i > 0 else (right if column else 0.0)
        new[i] = (left + right) / 2
    return new


@pytest.mark.parametrize("order", ["coloured", "ordered", "jacobi"])
@pytest.mark.parametrize("column", [False, True])
def test_slowest_error_of_a_chain(order, column):
    """The growth over two sweeps, since modes of `jacobi` come with both signs."""
    forces = np.ones(9)
    for _ in range(600):
        forces = swept(forces, order, column)
    later = swept(swept(forces, order, column), order, column)
    known = theory.sweep_error(2, 9, order, column)
    assert np.linalg.norm(later) / np.linalg.norm(forces) == pytest.approx(float(known), rel=1e-7)


def test_sweeps_of_a_column():
    """Random sweeps until all forces of 16 grains are right to 1e-6 of the weight."""
    rng = np.random.default_rng(16)
    known, forces, sweeps = 16 - np.arange(17.0), np.zeros(17), 0
    while abs(forces - known).max() > 1e-6 * 16:
        for i in rng.permutation(16):
            forces[i] = 1 + forces[1] if i == 0 else (forces[i - 1] + forces[i + 1]) / 2
        sweeps += 1
    expected = theory.sweeps_needed(16, 1e-6 * math.pi**2 / 8, column=True)
    assert expected == pytest.approx(sweeps, rel=0.02)
    assert expected / 16**2 == pytest.approx(6.93, rel=0.01)


@pytest.mark.parametrize(("dimension", "more"), [(2, 64), (3, 16)])
def test_sweeps_across_a_packing_have_their_power(dimension, more):
    few, many = theory.packing_sweeps(10**6, dimension), theory.packing_sweeps(64e6, dimension)
    assert many / few == pytest.approx(more, rel=1e-3)


def test_one_contact_takes_one_sweep():
    assert theory.sweeps_needed(1, 1e-6, "ordered") == 1


BONDS = {
    "chain": [[1, 0, 0]],
    "square": [[1, 0, 0], [0, 1, 0]],
    "cubic": np.eye(3).tolist(),
    "triangular": [[1, 0, 0], [0.5, 0.75**0.5, 0], [-0.5, 0.75**0.5, 0]],
    "bcc": [[1, s, t] for s, t in itertools.product((1, -1), repeat=2)],
    "fcc": [[1, 1, 0], [1, -1, 0], [1, 0, 1], [1, 0, -1], [0, 1, 1], [0, 1, -1]],
}


@pytest.mark.parametrize("lattice", BONDS)
def test_parallel_update_of_lattices(lattice):
    """The largest eigenvalue over waves of a grid that has the corners of the zone."""
    bonds = np.array(BONDS[lattice], float)
    normals = bonds / np.linalg.norm(bonds, axis=1, keepdims=True)
    axis = np.arange(12) * math.pi / 6
    waves = np.array(list(itertools.product(axis, axis / 0.75**0.5, axis)))
    if lattice != "triangular":
        waves = np.array(list(itertools.product(axis, repeat=3)))
    weight = 1 - np.cos(waves @ bonds.T)
    matrices = np.einsum("qb,bi,bj->qij", weight, normals, normals)
    largest = np.linalg.eigvalsh(matrices).max()
    assert theory.parallel_factor(lattice) == pytest.approx(1 - largest)
    limit = theory.largest_relaxation(lattice)
    assert theory.parallel_factor(lattice, limit) == pytest.approx(-1)


def test_errors_double_on_the_triangular_lattice():
    """Forces of all contacts at once, 6 x 6 disks, from a random error."""
    cell = np.array([[1, 0], [0.5, 0.75**0.5]])
    contacts = []
    for i, j in itertools.product(range(6), repeat=2):
        for a, b in ((1, 0), (0, 1), (-1, 1)):
            normal = np.array([a, b]) @ cell
            row = np.zeros((6, 6, 2))
            row[i, j] -= normal
            row[(i + a) % 6, (j + b) % 6] += normal
            contacts.append(row.ravel())
    gaps = np.array(contacts)
    errors = np.random.default_rng(0).normal(size=len(gaps))
    for _ in range(60):
        errors /= np.linalg.norm(errors)
        before, errors = errors, errors - gaps @ (gaps.T @ errors) / 2
    assert np.linalg.norm(errors) == pytest.approx(abs(theory.parallel_factor("triangular")))
    assert errors @ before < 0


def standing_wave(grains, sweeps, order, steps, seed):
    """Frequency and decay per step of the longest wave between fixed walls, as it is simulated.

    Amplitudes of a damped oscillation obey a[t + 1] = T a[t] - D a[t - 1].
    """
    rng = np.random.default_rng(seed)
    mode = np.sin(math.pi * np.arange(grains + 2) / (grains + 1))
    velocity, forces = mode.copy(), np.zeros(grains + 1)
    moved = [1] + [2] * (grains - 1) + [1]  # grains that a contact moves
    amplitude = [1.0]
    for _ in range(steps):
        velocity[1:-1] -= np.diff(forces)
        v, R = velocity.tolist(), forces.tolist()
        for _ in range(sweeps):
            turns = rng.permutation(grains + 1) if order == "random" else range(grains + 1)
            for j in turns:
                change = (v[j] - v[j + 1]) / moved[j]
                R[j] += change
                v[j] -= change * (j > 0)
                v[j + 1] += change * (j < grains)
        velocity, forces = np.array(v), np.array(R)
        amplitude.append(2 * velocity @ mode / (grains + 1))
    a = np.array(amplitude)
    (T, D), *_ = np.linalg.lstsq(np.stack([a[1:-1], -a[:-2]], axis=-1), a[2:], rcond=None)
    return math.acos(T / 2 / math.sqrt(D)), -math.log(D) / 2


@pytest.mark.parametrize(("order", "runs"), [("ordered", 1), ("random", 6)])
def test_rigid_chain_swings(order, runs):
    """The ends count by up to 1 %; random orders scatter on top of that."""
    known = np.array(theory.rigid_chain_wave(math.pi / 63, 5, 1.0, order))
    found = np.array([standing_wave(63, 5, order, 150, seed) for seed in range(runs)]) / known
    error = found.std(axis=0) / math.sqrt(max(runs - 1, 1))
    assert np.all(abs(found.mean(axis=0) - 1) < 0.01 + 4 * error)
    assert np.all(error < 0.015)


def test_long_waves_of_a_rigid_chain():
    """Speed, damping and the chain of springs that has them."""
    chain = theory.rigid_chain(20, 0.01, 1.5, 2.0, "random")
    wave = theory.rigid_chain_wave(1e-3, 20, 0.01, "random")
    assert wave.frequency * 1.5 / 1e-3 == pytest.approx(chain.speed, rel=1e-4)
    assert wave.decay == pytest.approx(20 * theory.sweep_spread("random") * 1e-6 / 0.02, rel=1e-4)
    assert 1.5 * math.sqrt(chain.stiffness / 2.0) == pytest.approx(chain.speed)
    k = 2 * math.pi * 1.5 / chain.shortest  # where the decay is the frequency
    damping = 20 * theory.sweep_spread("random") * k**2 / 0.02
    assert damping == pytest.approx(chain.speed * k / 1.5)


@pytest.mark.parametrize(("dimension", "power"), [(2, 2.0), (3, 4 / 3)])
def test_stiffness_of_equal_cost(dimension, power):
    """Steps in which a grain moves by its radius are as many as sweeps across the packing."""
    K = theory.stiffness_of_equal_cost(5000, dimension, 0.5, 2.0, 0.1)
    assert 0.5 / 0.1 * math.sqrt(K / 2.0) == pytest.approx(5000 ** (power / 2))


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: theory.sweep_spread("parallel"), "order = 'parallel'"),
        (lambda: theory.sweep_factor(0.1, "parallel"), "order = 'parallel'"),
        (lambda: theory.slowest_wave(0), "contacts = 0"),
        (lambda: theory.sweep_error(-1, 5), "sweeps = -1"),
        (lambda: theory.sweeps_needed(5, 1.0), "accuracy = 1.0"),
        (lambda: theory.packing_sweeps(0, 2), "grains = 0"),
        (lambda: theory.packing_sweeps(10, 4), "dimension = 4"),
        (lambda: theory.parallel_factor("hexagonal"), "lattice = 'hexagonal'"),
        (lambda: theory.parallel_factor("fcc", 0.0), "relaxation = 0.0"),
        (lambda: theory.rigid_chain(5, 0.0, 1.0, 1.0), "timestep = 0.0"),
        (lambda: theory.rigid_chain_wave(0.1, 5, 1.0, "jacobi"), "order = 'jacobi'"),
        (lambda: theory.rigid_chain_wave(3.0, 5, 1.0), "wave_number = 3"),
        (lambda: theory.stiffness_of_equal_cost(10, 2, speed=0.0), "speed = 0.0"),
    ],
)
def test_numbers_out_of_range_are_refused(call, said):
    with pytest.raises(ValueError, match=f"^{said}: expected "):
        call()
