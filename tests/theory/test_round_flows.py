"""Flows about round solids: equations of motion, balances, and values known otherwise."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesokit.theory import (
    channel_cylinder,
    cubic_array_drag,
    cubic_array_drag_dilute,
    cubic_array_permeability,
    hagen_poiseuille_flow_rate,
    hagen_poiseuille_velocity,
    square_array_drag,
    square_array_drag_dilute,
    square_array_permeability,
    square_wake_length,
    taylor_couette_coefficients,
    taylor_couette_torque,
    taylor_couette_velocity,
)

rate = st.floats(-2, 2)


@given(inner=st.floats(1, 5), gap=st.floats(0.5, 10), w1=rate, w2=rate)
def test_taylor_couette_solves_navier_stokes(inner, gap, w1, w2):
    outer = inner + gap
    r = np.array([inner, outer])
    assert taylor_couette_velocity(r, inner, outer, w1, w2) == pytest.approx(
        [inner * w1, outer * w2], abs=1e-9
    )
    a, _ = taylor_couette_coefficients(inner, outer, w1, w2)
    r, h = inner + gap / 2, 1e-3 * gap  # d/dr (1/r d(r u)/dr) = 0
    vorticity = [
        (
            (x + h) * taylor_couette_velocity(x + h, inner, outer, w1, w2)
            - (x - h) * taylor_couette_velocity(x - h, inner, outer, w1, w2)
        )
        / (2 * h * x)
        for x in (r - h, r + h)
    ]
    assert vorticity == pytest.approx([2 * a] * 2, abs=1e-5)


@given(inner=st.floats(1, 5), gap=st.floats(0.5, 10), w1=rate, w2=rate)
def test_torques_of_taylor_couette_balance(inner, gap, w1, w2):
    torques = taylor_couette_torque(inner, inner + gap, w1, w2, 3.0)
    assert sum(torques) == pytest.approx(0, abs=1e-9)
    rigid = taylor_couette_torque(inner, inner + gap, w1, w1, 3.0)
    assert rigid == pytest.approx((0, 0), abs=1e-9)


def test_torque_in_a_narrow_gap_is_that_of_plane_couette():
    inner, outer = taylor_couette_torque(1000.0, 1001.0, 0.0, 0.1 / 1001, 2.0)
    shear_stress = 2.0 * 0.1
    assert inner == pytest.approx(2 * np.pi * 1000**2 * shear_stress, rel=2e-3)
    assert outer == -inner


def test_one_sided_stress_drags_on_rigid_rotation():
    torques = taylor_couette_torque(1.0, 2.0, 0.3, 0.3, 1.0, one_sided=0.5)
    assert torques == pytest.approx((np.pi * 0.3, -4 * np.pi * 0.3))


@given(radius=st.floats(0.5, 20), g=st.floats(0.001, 1), nu=st.floats(0.1, 5))
def test_pipe(radius, g, nu):
    edges = np.linspace(0, radius, 2001)
    r = (edges[1:] + edges[:-1]) / 2
    u = hagen_poiseuille_velocity(r, radius, g, nu)
    assert hagen_poiseuille_velocity(radius, radius, g, nu) == 0
    volume = (u * np.pi * np.diff(edges**2)).sum()
    assert hagen_poiseuille_flow_rate(radius, g, nu) == pytest.approx(volume, rel=1e-5)
    drag = -2 * np.pi * radius * nu * (u[-1] - u[-2]) / (r[-1] - r[-2])
    assert drag == pytest.approx(np.pi * radius**2 * g, rel=2e-3)  # on the wall, over rho


@pytest.mark.parametrize(
    ("c", "published"),
    [
        (0.05, 15.56), (0.1, 24.83), (0.2, 51.53), (0.3, 102.90), (0.4, 217.89), (0.5, 532.55),
        (0.6, 1763), (0.7, 13520),
    ],
)  # fmt: skip
def test_square_array_is_that_of_sangani_and_acrivos(c, published):
    assert square_array_drag(c) == pytest.approx(published, rel=1e-3 if c > 0.5 else 2e-4)


def test_square_array_tends_to_the_dilute_series():
    for c, off in ((0.001, 1e-4), (0.05, 3e-4), (0.1, 1e-3), (0.2, 0.015)):
        assert square_array_drag_dilute(c) == pytest.approx(square_array_drag(c), rel=off)


def test_square_array_in_lubrication():
    """Close to touching, F/(eta U) tends to 9 pi/(2 sqrt 2) (1 - (c/c_max)^(1/2))^(-5/2)."""
    c, touching = 0.65, np.pi / 4
    limit = 9 * np.pi / (2 * 2**0.5) * (1 - (c / touching) ** 0.5) ** -2.5
    assert square_array_drag(c) == pytest.approx(limit, rel=0.2)


@pytest.mark.parametrize(
    ("c", "published"),
    [
        (0.000125, 1.096), (0.001, 1.212), (0.008, 1.525), (0.027, 2.008), (0.064, 2.810),
        (0.125, 4.292), (0.216, 7.442), (0.343, 15.4), (0.45, 28.1), (0.5236, 42.1),
    ],
)  # fmt: skip
def test_cubic_array_is_that_of_zick_and_homsy(c, published):
    assert cubic_array_drag(c) == pytest.approx(published, rel=5e-4)


def test_cubic_array_tends_to_that_of_hasimoto():
    for c, off in ((1e-4, 1e-5), (0.008, 1e-3), (0.027, 1e-3)):
        assert cubic_array_drag_dilute(c) == pytest.approx(cubic_array_drag(c), rel=off)


def test_cubic_array_is_smooth_where_the_sources_change():
    c = np.linspace(0.23, 0.27, 41)
    steps = np.diff(np.log([cubic_array_drag(x) for x in c]))
    assert np.ptp(steps) < 0.1 * steps.mean()


def test_permeability_is_that_of_the_balance_of_forces():
    c, pitch = 0.1, 12.0
    radius = pitch * (c / np.pi) ** 0.5
    assert radius < pitch / 2
    assert square_array_permeability(c, pitch) == pitch**2 / square_array_drag(c)
    radius = pitch * (3 * c / (4 * np.pi)) ** (1 / 3)
    drag = 6 * np.pi * radius * cubic_array_drag(c)
    assert cubic_array_permeability(c, pitch) == pytest.approx(pitch**3 / drag)


def test_reference_values_of_cylinders_in_channels():
    assert channel_cylinder("L_r/D", 10).value == 0.145
    drag = channel_cylinder("drag coefficient", 25)
    assert drag.value == pytest.approx(2.03) and drag.error == pytest.approx(0.0406)
    assert square_wake_length(10) == pytest.approx(0.489)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: taylor_couette_velocity(1, 2, 1, 0, 0), "outer = 1"),
        (lambda: hagen_poiseuille_velocity(1, 2, 0.1, 0), "viscosity = 0"),
        (lambda: square_array_drag(0.75), "at most 0.7"),
        (lambda: cubic_array_drag(0.6), "at most pi/6"),
        (lambda: channel_cylinder("L_r/D", 50), "10 to 40"),
        (lambda: channel_cylinder("lift", 20), "expected one of"),
        (lambda: square_wake_length(4), "more than 5"),
    ],
)
def test_what_is_out_of_range_is_refused(call, words):
    with pytest.raises(ValueError, match=words):
        call()
