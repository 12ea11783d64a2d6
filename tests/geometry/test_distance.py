"""Signed distances: no steeper than 1, of the right sign, exact where shapes are simple."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mesokit import (
    Array,
    Capsule,
    CosineChannel,
    Cuboid,
    Cylinder,
    Disk,
    Ellipse,
    HalfSpace,
    Intersection,
    Rectangle,
    Sphere,
    Spheroid,
    Union,
)
from mesokit.geometry.primitive import CONVEX, KINDS, MOVABLE
from tests.helpers.shapes import (
    EVERY,
    FIRST,
    PLACES,
    ROUND,
    SECOND,
    SIZE,
    anywhere,
    example,
    from_ellipse,
    on_surface,
    solids_of,
    walls_of,
)

NEAR = 0.999  # distances are exact within 1


def periodic(r: np.ndarray, centre: tuple[float, ...]) -> np.ndarray:
    """Shortest vectors from a place to points, over all images."""
    size = np.array(SIZE[r.shape[-1]])
    away = r - np.array(centre[: r.shape[-1]])
    return away - size * np.round(away / size)


def from_ball(r, centre=FIRST, radius=1.9):
    return np.linalg.norm(periodic(r, centre), axis=1) - radius


def turned(x, degrees):
    """Vectors in the frame that is turned about z."""
    turn = np.exp(-1j * math.radians(degrees)) * (x[:, 0] + 1j * x[:, 1])
    return np.stack([turn.real, turn.imag, *x.T[2:]], axis=1)


def from_box(r, angle=0.0):
    half = 0.5 * np.array((3.6, 2.8, 3.1)[: r.shape[1]])
    q = np.abs(turned(periodic(r, FIRST), angle)) - half
    return np.linalg.norm(np.maximum(q, 0), axis=1) + np.minimum(q.max(axis=1), 0)


def from_oval(r):
    return from_ellipse(1.8, 1.4, *np.abs(turned(periodic(r, FIRST), 27.0)).T)


def from_spheroid(r):
    x, axis = periodic(r, FIRST), np.array([1.0, 2.0, -2.0]) / 3
    return from_ellipse(2.7, 1.9, np.abs(x @ axis), np.linalg.norm(np.cross(x, axis), axis=1))


def from_line(r):
    span = np.subtract(SECOND, FIRST)[: r.shape[1]]
    best = np.full(len(r), np.inf)
    for share in np.linspace(0, 1, 2001):
        best = np.minimum(
            best, np.linalg.norm(periodic(r, FIRST[: len(span)] + share * span), axis=1)
        )
    return best - 1.9


def from_cosines(r):
    x, y = r[:, 0], r[:, 1] - 0.5 * SIZE[2][1]
    return 2.5 + 0.8 * np.cos(2 * np.pi * x / SIZE[2][0]) - np.abs(y)


def from_array(r):
    steps = np.array(SIZE[r.shape[1]]) / 2
    away = r - (2.4, 1.7, 2.2)[: r.shape[1]]
    return np.linalg.norm(away - steps * np.round(away / steps), axis=1) - 1.1


# Distance by a formula of its own, and how exact: None where only the sign is.
SAMPLED = 0.02
FORMULAS = {
    "plates": (lambda r: np.minimum(r[:, 1], SIZE[2][1] - r[:, 1]), 1e-12),
    "disk": (from_ball, 1e-12),
    "sphere": (from_ball, 1e-12),
    "cylinder": (lambda r: from_ball(r[:, :2]), 1e-12),
    "rectangle": (lambda r: from_box(r, 27.0), 1e-12),
    "cuboid": (lambda r: from_box(r, 27.0), 1e-12),
    "capsule": (from_line, 1e-5),
    "ellipse": (from_oval, 1e-12),
    "spheroid": (from_spheroid, 1e-12),
    "cosine-channel": (from_cosines, None),
    "union": (lambda r: np.minimum(from_ball(r), from_ball(r, SECOND, 1.4)), 1e-12),
    "intersection": (lambda r: np.maximum(from_ball(r), from_ball(r, SECOND, 1.4)), 1e-12),
    "array": (from_array, 1e-12),
    "sampled": (from_ball, SAMPLED),
    "picture": (from_ball, SAMPLED),
    "mesh": (from_ball, SAMPLED),
}


def formula(name: str, side: str, r: np.ndarray):
    """Distance by a formula, and how exact."""
    if name == "half-space":
        above = (r[:, 1] - FIRST[1]) * (1 if side == "outside" else -1)
        return np.minimum(above, FORMULAS["plates"][0](r)), 1e-12
    found, exact = FORMULAS[name]
    return found(r) * (1 if side == "outside" else -1), exact


def test_no_steeper_than_one(every):
    _, d, _, solids = every
    rng = np.random.default_rng(1)
    a = anywhere(d, 20_000)
    step = rng.standard_normal(a.shape)
    step *= (10 ** rng.uniform(-6, 0.5, len(a)) / np.linalg.norm(step, axis=1))[:, None]
    high, low = (np.clip(solids.distance(r), -1.0, 1.0) for r in (a, a + step))
    assert (np.abs(high - low) <= np.linalg.norm(step, axis=1) + 1e-12).all()


KNOWN = [case for case in EVERY if case[0] in {*FORMULAS, "half-space"}]


@pytest.mark.parametrize("every", KNOWN, ids=lambda case: "-".join(map(str, case)), indirect=True)
def test_it_is_what_a_formula_says(every):
    name, d, side, solids = every
    r = anywhere(d, 20_000)
    expected, exact = formula(name, side, r)
    got = solids.distance(r)
    clear = np.abs(expected) > (exact or 0.0) + 1e-9
    np.testing.assert_array_equal(got[clear] > 0, expected[clear] > 0)
    if exact is None:
        return
    near = np.abs(expected) < (NEAR if exact < SAMPLED else 0.3)
    tolerance = exact if exact < SAMPLED else exact + 0.15 * np.abs(expected[near])
    assert (np.abs(got[near] - expected[near]) < tolerance).all()
    assert (got[~near & (expected > 0)] > 0.2).all()


def test_both_signs_come_near_each_surface(every):
    """Just off a surface place, along the normal, one side is fluid and the other solid."""
    _, _, _, solids = every
    r, normal = on_surface(solids, 500)
    assert len(r) > 100
    # but at some of the corners, where many of these places are
    assert (solids.distance(r + 1e-6 * normal) > 0).mean() > 0.75
    assert (solids.distance(r - 1e-6 * normal) < 0).mean() > 0.75


def test_normals_are_gradients(every):
    _, d, _, solids = every
    r = anywhere(d, 20_000)
    body, distance, normal = solids.nearest(r)
    near = (body >= 0) & (np.abs(distance) < 0.6)
    r, normal = r[near], normal[near]
    slopes = []
    for step in (1e-4, 1e-5):
        slopes.append(
            np.stack(
                [
                    (solids.nearest(r + e)[1] - solids.nearest(r - e)[1]) / (2 * step)
                    for e in step * np.eye(d)
                ],
                axis=1,
            )
        )
    smooth = np.abs(slopes[0] - slopes[1]).max(axis=1) < 1e-4
    smooth &= np.linalg.norm(slopes[1], axis=1) > 0.2  # not on a ridge between samples
    assert smooth.mean() > 0.5
    direction = slopes[1] / np.linalg.norm(slopes[1], axis=1)[:, None]
    np.testing.assert_allclose(np.linalg.norm(normal, axis=1), 1.0, atol=1e-12)
    assert np.abs(direction - normal)[smooth].max() < 2e-3


def test_sampled_gradients_are_near_one_at_the_surface(tmp_path):
    for name, d in (("sampled", 2), ("sampled", 3), ("picture", 2), ("mesh", 2), ("mesh", 3)):
        solids = solids_of((example(name, d, "outside", tmp_path),), d)
        r, normal = on_surface(solids, 500)
        rise = solids.distance(r + 0.05 * normal) - solids.distance(r - 0.05 * normal)
        assert 0.85 < rise.min() / 0.1 <= rise.max() / 0.1 < 1.0 + 1e-9


PLACED = (
    "disk", "sphere", "capsule", "rectangle", "cuboid", "cylinder", "sampled", "ellipse", "spheroid"
)  # fmt: skip


@given(
    st.sampled_from([case for case in EVERY if case[0] in PLACED]),
    st.tuples(*[st.floats(0, 1)] * 3),
)
@settings(max_examples=40)
def test_images_reach_across_the_edges(tmp_path_factory, case, share):
    name, d, side = case
    by = [q * length - x for q, length, x in zip(share, SIZE[d], FIRST, strict=False)]
    wall = example(name, d, side, tmp_path_factory.getbasetemp())
    keys = [*(key for key in PLACES if getattr(wall, key, None) is not None)]
    keys += ["origin"] if name == "sampled" else []
    places = {
        key: tuple(x + dx for x, dx in zip(getattr(wall, key), by, strict=False)) for key in keys
    }
    moved = dataclasses.replace(wall, **places)
    r = anywhere(d, 500)
    a = solids_of((wall,), d).distance(r)
    b = solids_of((moved,), d).distance(r + np.array(by[:d]))
    np.testing.assert_allclose(np.clip(a, -1, 1), np.clip(b, -1, 1), atol=1e-9)


@pytest.mark.parametrize(
    ("name", "d"), sorted({(name, d) for name, d, side in EVERY if side == "inside"})
)
def test_the_other_side_is_the_complement(name, d, tmp_path):
    a, b = (solids_of((example(name, d, side, tmp_path),), d) for side in ("outside", "inside"))
    r = anywhere(d, 5000)
    one, other = a.distance(r), b.distance(r)
    near = np.abs(one) < NEAR
    np.testing.assert_allclose(one[near], -other[near], atol=1e-12)
    assert ((one > 0) == (other < 0))[one != 0].all()


@pytest.mark.parametrize("d", [2, 3])
def test_unions_and_intersections(d):
    a, b = ROUND[d](FIRST[:d], 1.9), ROUND[d](SECOND[:d], 1.4)
    hole = dataclasses.replace(b, fluid="inside")
    r = anywhere(d, 5000)
    one, other = (np.minimum(solids_of((wall,), d).distance(r), 1) for wall in (a, b))

    def check(wall, expected):
        np.testing.assert_allclose(
            np.minimum(solids_of((wall,), d).distance(r), 1), np.minimum(expected, 1), atol=1e-12
        )

    check(Union((a, b)), np.minimum(one, other))
    both = np.maximum(one, other)
    clear = (one < 1) & (other < 1)
    got = solids_of((Intersection((a, b)),), d).distance(r)
    np.testing.assert_allclose(got[clear], both[clear], atol=1e-12)
    cut = solids_of((Intersection((a, hole)),), d).distance(r)
    deep = (one < 1) & (np.abs(other) < 1)
    np.testing.assert_allclose(cut[deep], np.maximum(one, -other)[deep], atol=1e-12)
    check(Union((Intersection((a, b)), b)), np.minimum(np.where(clear, both, 1), other))


WAVES = CosineChannel(width=5, amplitude=0.8)
VOLUMES = {
    "disk": (Disk((0.2, 9.9), 1.9), 120 - np.pi * 1.9**2),
    "disk inside": (Disk((5, 5), 4, fluid="inside"), np.pi * 16),
    "rectangle": (Rectangle((11.9, 0.1), (3.6, 2.8), 27), 120 - 3.6 * 2.8),
    "capsule": (Capsule((2, 3), (8, 6), 1), 120 - np.pi - 2 * math.hypot(6, 3)),
    "ellipse": (Ellipse((11.9, 0.1), (6.4, 4.8), 27), 120 - np.pi * 3.2 * 2.4),
    "waves": (WAVES, 12 * 5),
    "winding": (dataclasses.replace(WAVES, winding=True), 12 * 5),
    "array": (Array(of=Disk((1, 1), 0.8), repeat=(4, 5)), 120 - 20 * np.pi * 0.64),
    "two disks": (Union((Disk((3, 3), 1), Disk((8, 8), 1.5))), 120 - np.pi * 3.25),
    "half disk": (Intersection((Disk((5, 5), 3), HalfSpace((5, 5), (0, 1)))), 120 - np.pi * 4.5),
    "sphere": (Sphere((0, 0, 8.9), 2.2), 1080 - 4 / 3 * np.pi * 2.2**3),
    "spheroid": (Spheroid((0, 0, 8.9), 3, 2, axis=(1, 2, 3)), 1080 - 4 / 3 * np.pi * 9 * 2),
    "cylinder": (Cylinder((1, 9, 3), 2), 1080 - 9 * 4 * np.pi),
    "pipe": (Cylinder((6, 5, 4.5), 4, axis="x", fluid="inside"), 12 * 16 * np.pi),
    "cuboid": (Cuboid((6, 0, 0), (3.6, 2.8, 3.1), 27), 1080 - 3.6 * 2.8 * 3.1),
    "rod": (
        Capsule((3, 3, 3), (8, 6, 5), 1),
        1080 - 4 / 3 * np.pi - np.pi * math.sqrt(25 + 9 + 4),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", VOLUMES)
def test_free_volume(name):
    wall, expected = VOLUMES[name]
    d = 3 if name in ("sphere", "cylinder", "pipe", "cuboid", "rod", "spheroid") else 2
    got = solids_of((wall,), d).free_volume
    assert abs(got - expected) < 3e-3 * abs(math.prod(SIZE[d]) - expected)
    assert solids_of(walls_of(wall, d), d).open_cells.sum() == got


@pytest.mark.parametrize("points", [[1.0, 2.0, 3.0], np.zeros((4, 3)), np.zeros((2, 0)), 5.0])
def test_points_have_one_number_for_each_axis(points):
    solids = solids_of((Disk((5, 5), 2),), 2)
    for ask in (solids.distance, solids.nearest, solids.depths(2.0)):
        with pytest.raises(ValueError, match=r"points: expected shape \(n, 2\), not"):
            ask(points)
    assert solids.distance([5.0, 8.0]).tolist() == [1.0]
    assert solids.distance(np.zeros((3, 4, 2))).shape == (12,)


def test_bodies_that_move_consist_of_convex_parts():
    """Flights that tangent planes rule out are not followed (`bodies.state.heights_on_flight`)."""
    movable = {name for name, number in KINDS.items() if MOVABLE[number]}
    assert movable == {"ball", "capsule", "brick", "ellipsoid"}
    assert all(CONVEX[KINDS[name]] for name in movable)
