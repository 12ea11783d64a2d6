"""Laws of packings, silos, orifices, dense flow and columns beside counts, quadrature, sources."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mesokit import theory


def equations(dimension: int, grains: int, friction: bool) -> int:
    """Rank of force balance of grains in a periodic box that is full of contacts."""
    rng = np.random.default_rng(dimension)
    turns = dimension * (dimension - 1) // 2 if friction else 0
    each = dimension + turns
    columns = []
    for _ in range(4 * grains * each):
        i, j = rng.choice(grains, 2, replace=False)
        normal = rng.normal(size=dimension)
        normal /= np.linalg.norm(normal)
        for force in np.eye(dimension) if friction else normal[None]:
            column = np.zeros((grains, each))
            column[i, :dimension], column[j, :dimension] = force, -force
            if friction:  # both grains are turned the same way by a force along the surface
                wide = np.cross(np.append(normal, [0.0] * (3 - dimension)), np.append(force, 0)[:3])
                column[[i, j], dimension:] = -wide[-turns:]
            columns.append(column.ravel())
    return int(np.linalg.matrix_rank(np.array(columns)))


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("friction", [False, True])
def test_isostatic_coordination_is_a_count_of_equations(dimension, friction):
    """Contacts have one state of stress more than force balance has equations."""
    forces = equations(dimension, 8, friction) + 1
    contacts = forces / (dimension if friction else 1)
    known = theory.isostatic_coordination(dimension, friction, grains=8)
    assert known == pytest.approx(2 * contacts / 8)
    many = theory.isostatic_coordination(dimension, friction)
    assert many == (dimension + 1 if friction else 2 * dimension)
    assert theory.isostatic_coordination(dimension, friction, 10**9) == pytest.approx(many)


@pytest.mark.parametrize("dimension", [2, 3])
def test_janssen_beside_the_balance_of_slices(dimension):
    """Weight of a slice is carried by the stress below it and by friction at the walls."""
    diameter, mu, K, density, gravity = 12.0, 0.4, 0.6, 0.8, 2.0
    area, edge = (diameter, 2.0) if dimension == 2 else (36 * math.pi, diameter * math.pi)

    def right(z, stress):
        return density * gravity - mu * K * stress * edge / area

    z = np.array([0.0, 3.0, 20.0, 60.0])
    solved = solve_ivp(right, (0, 60), [1.5], t_eval=z, rtol=1e-10, atol=1e-12).y[0]
    length = theory.janssen_length(diameter, mu, K, dimension)
    stress = theory.janssen_stress(z, length, density, gravity, load=1.5)
    assert stress == pytest.approx(solved, rel=1e-8)
    floor = theory.janssen_stress(60.0, length, density, gravity) / (60.0 * density * gravity)
    assert theory.janssen_share(60.0, length) == pytest.approx(float(floor))
    assert theory.janssen_share(1e-9, length) == pytest.approx(1.0)


def test_active_stress_ratio_is_at_the_limit_of_friction():
    """On the steepest plane the shear stress is the normal one times tan(angle), nowhere more."""
    angle = math.radians(25)
    K = theory.stress_ratio(angle)
    plane = np.linspace(0, math.pi, 100_001)
    normal = K * np.cos(plane) ** 2 + np.sin(plane) ** 2
    shear = (1 - K) * np.sin(plane) * np.cos(plane)
    assert np.max(abs(shear) / normal) == pytest.approx(math.tan(angle), rel=1e-8)
    assert K < theory.stress_ratio(angle, "at-rest") == pytest.approx(1 - math.sin(angle))


@pytest.mark.parametrize(("dimension", "power"), [(2, 1.5), (3, 2.5)])
def test_beverloo_has_the_power_of_free_fall(dimension, power):
    """Mass per time has no other power of density, gravity and the free opening."""
    rate = theory.beverloo_rate(9.0, 2.0, 0.6, 9.8, dimension, blocked=1.5)
    usual = {2: 1.03, 3: 0.58}[dimension]
    assert rate == pytest.approx(usual * 0.6 * math.sqrt(9.8) * 6.0**power)
    assert theory.beverloo_rate([0.0, 3.0], 2.0, 0.6, 9.8, dimension, blocked=1.5).max() == 0
    assert theory.beverloo_line(rate, dimension) ** power == pytest.approx(rate)


@pytest.mark.parametrize("dimension", [2, 3])
def test_beverloo_fit_has_honest_error_bars(dimension):
    """Over 400 sets of noisy rates the errors of C and k have the spread that is said."""
    rng = np.random.default_rng(3)
    opening = np.array([6.0, 8.0, 10.0, 12.0])
    known = theory.beverloo_rate(opening, 1.2, 0.8, 1.5, dimension, 1.1, 2.1)
    fits = np.array(
        [
            theory.beverloo_fit(
                opening, known + 0.02 * known * rng.normal(size=4), 0.02 * known, 1.2, 0.8, 1.5,
                dimension,
            )
            for _ in range(400)
        ]
    )  # fmt: skip
    off = (fits[:, :2] - [1.1, 2.1]) / fits[:, 2:]
    assert off.std(axis=0) == pytest.approx([1.0, 1.0], abs=4 / math.sqrt(800))
    assert off.mean(axis=0) == pytest.approx([0.0, 0.0], abs=4 / math.sqrt(400))


def test_beverloo_fit_of_the_scatter():
    opening = np.array([6.0, 8.0, 10.0, 12.0])
    known = theory.beverloo_rate(opening, 1.0, 0.8, 1.0, 2, 1.1, 2.1)
    found = theory.beverloo_fit(opening, known, None, 1.0, 0.8, 1.0, 2)
    assert found == pytest.approx((1.1, 2.1, 0.0, 0.0), abs=1e-9)


def test_inertial_number_is_a_ratio_of_times():
    """A disk of the mass m that the pressure P pulls moves by its size in sqrt(m/P)."""
    mass = 2.5 * math.pi * 0.8**2 / 4
    disks = theory.inertial_number(-0.3, 4.0, 0.8, 2.5, 2)
    assert disks == pytest.approx(0.3 * math.sqrt(mass / 4.0))
    spheres = theory.inertial_number([0.3, 0.6], [4.0, 16.0], 0.8, 2.5, 3)
    assert spheres == pytest.approx([0.3 * 0.8 * math.sqrt(2.5 / 4.0)] * 2)


def test_dense_flow_has_the_published_constants():
    """da Cruz et al. 2005 for disks; Jop et al. 2006: mu_s = 0.38, mu_2 = 0.64, I_0 = 0.279."""
    number = np.array([0.01, 0.2])
    assert theory.friction_of_disks(number) == pytest.approx([0.261, 0.47])
    assert theory.fraction_of_disks(number) == pytest.approx([0.807, 0.75])
    ends = theory.friction_of_spheres([0.0, 1e12])
    assert ends == pytest.approx([0.38, 0.64], abs=0.005)
    assert theory.friction_of_spheres(0.279) == pytest.approx(ends.mean())


@pytest.mark.parametrize(
    ("grains", "ratio", "published"),
    [
        ("disks", [0.76, 1.63, 3.15, 6.28], [1.90, 4.08, 7.25, 11.8]),
        ("slot", [1.0, 8.0], [1.2, 7.6]),
        ("cylinder", [1.0, 9.0], [1.24, 4.8]),
    ],
)
def test_run_out_of_columns(grains, ratio, published):
    assert theory.run_out(ratio, grains) == pytest.approx(published, abs=0.05)


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: theory.isostatic_coordination(1, True), "dimension = 1"),
        (lambda: theory.isostatic_coordination(2, True, 1), "grains = 1"),
        (lambda: theory.stress_ratio(0.5, "passive"), "state = 'passive'"),
        (lambda: theory.stress_ratio(2.0), "angle = 2.0"),
        (lambda: theory.janssen_length(1.0, 0.0, 0.5, 2), "friction = 0.0"),
        (lambda: theory.janssen_stress([1.0, -1.0], 1.0, 1.0, 1.0), "depth = -1"),
        (lambda: theory.janssen_share(math.nan, 1.0), "height = nan"),
        (lambda: theory.beverloo_rate(-1.0, 1.0, 1.0, 1.0, 2), "opening = -1"),
        (lambda: theory.beverloo_rate(1.0, 1.0, 1.0, 1.0, 2, 0.0), "prefactor = 0.0"),
        (lambda: theory.beverloo_line(-1.0, 2), "rate = -1"),
        (
            lambda: theory.beverloo_fit([1.0, 2.0, 3.0], [0.0, 1.0, 2.0], None, 1.0, 1.0, 1.0, 2),
            "rate = 0",
        ),
        (lambda: theory.inertial_number(1.0, [1.0, 0.0], 1.0, 1.0, 2), "pressure = 0"),
        (lambda: theory.friction_of_disks(-0.1), "inertial = -0.1"),
        (lambda: theory.friction_of_spheres(0.1, scale=0.0), "scale = 0.0"),
        (lambda: theory.run_out(1.0, "sand"), "grains = 'sand'"),
        (lambda: theory.run_out(-1.0), "ratio = -1"),
    ],
)
def test_numbers_out_of_range_are_refused(call, said):
    with pytest.raises(ValueError, match=f"^{said}: expected "):
        call()
