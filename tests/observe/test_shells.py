"""Profiles about an axis and next to solids, of fluids whose flow is known."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import (
    SRD,
    Cylinder,
    Disk,
    Forces,
    MaxwellBoltzmann,
    Plates,
    RadialProfile,
    Rectangle,
    Sphere,
    Surface,
    SurfaceProfile,
    Uniform,
    theory,
)
from mesokit.case.case import Case
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.observe.radial_profile import ring_average
from mesokit.run.simulation import Simulation
from tests.helpers.comparisons import by_name, comparisons
from tests.helpers.fake_fluid import FakeFluid


def watched(case, observable, field=None, samples=300, seed=1):
    accumulator = observable.accumulator(case)
    fluid = FakeFluid(case, seed, field=field or np.zeros_like)
    for _ in range(samples):
        fluid.jump(10)
        accumulator.observe(fluid)
    return accumulator.result()


def turning(rate, middle, axis=2):
    """The field of a velocity rate(r) r about an axis."""
    i, j = (axis + 1) % 3, (axis + 2) % 3

    def field(r):
        v, arm = np.zeros(r.shape), r - middle
        speed = rate(np.hypot(arm[:, i], arm[:, j]))
        v[:, i], v[:, j] = -speed * arm[:, j], speed * arm[:, i]
        return v

    return field


def gap_walls(rate=0.1, outer_rate=0.0):
    return [
        Disk(centre=[8, 8], radius=2.5, surface=Surface(rotation=rate)),
        Disk(centre=[8, 8], radius=7, fluid="inside", surface=Surface(rotation=outer_rate)),
    ]


def test_ring_averages_are_those_of_the_area():
    edges = np.array([0.0, 1.0, 3.0])
    assert ring_average(lambda r: r, edges) == pytest.approx([2 / 3, 2 / 3 * 26 / 8])
    assert ring_average(lambda r: 0 * r + 1, edges) == pytest.approx([1, 1])


def test_taylor_couette_has_its_profile_and_slip(make_case):
    case = make_case((16, 16), walls=gap_walls(0.4), thermostat=MaxwellBoltzmann())

    def flow(slip):
        def rate(r):
            r = np.maximum(r, 1e-9)
            return (1 - slip) * theory.taylor_couette_velocity(r, 2.5, 7, 0.4, 0) / r

        return turning(rate, np.array([8, 8]))

    result = watched(case, RadialProfile(), flow(0.0))
    assert result.extra["edges"][[0, -1]] == pytest.approx([2.5, 7])
    assert np.abs(result.deviation).max() < 4.5
    found = by_name(result)
    for name in ("inner", "outer"):
        slip = found[f"slip at the {name} surface"]
        assert abs(slip.deviation) < 4 and slip.error < 3
    assert abs(found["chi-square per degree of freedom"].deviation) < 4
    slipping = by_name(watched(case, RadialProfile(), flow(0.2)))
    slip = slipping["slip at the inner surface"]
    assert abs(slip.measured + 20) < 4 * slip.error
    assert slipping["chi-square per degree of freedom"].deviation > 5


def test_error_bars_are_those_of_repeated_runs(make_case):
    case = make_case((16, 16), walls=gap_walls(0.4), thermostat=MaxwellBoltzmann())
    results = [watched(case, RadialProfile(), samples=40, seed=seed) for seed in range(16)]
    spread = np.std([r.value for r in results], axis=0, ddof=1)
    quoted = np.sqrt(np.mean([r.error**2 for r in results], axis=0))
    assert 0.85 < (quoted / spread).mean() < 1.2


def test_rigid_rotation_in_3d_about_any_axis(make_case):
    for axis, letter in enumerate("xyz"):
        size = [12, 12, 12]
        size[axis] = 4
        middle = np.array(size) / 2
        walls = [
            Cylinder(
                centre=list(middle), radius=5, axis=letter, fluid="inside",
                surface=Surface(rotation=0.2),
            )
        ]  # fmt: skip
        case = make_case(size, walls=walls, thermostat=MaxwellBoltzmann())
        result = watched(case, RadialProfile(), turning(lambda r: 0.2 + 0 * r, middle, axis), 60)
        assert result.theory == "drum" and np.abs(result.deviation).max() < 4.5
        rate = by_name(result)["rate of rotation"]
        assert rate.expected == 0.2 and abs(rate.deviation) < 4 and rate.error < 0.01
        axial = watched(case, RadialProfile(of="axial"), turning(lambda r: 0.2, middle, axis), 20)
        assert np.all(axial.expected == 0) and np.abs(axial.deviation).max() < 4.5


def test_pipe_gives_the_viscosity_that_drove_the_flow(make_case):
    walls = [Cylinder(centre=[8, 8, 0], radius=7, fluid="inside")]
    case = make_case((16, 16, 4), walls=walls, force=Uniform((0, 0, 0.05)),
                     thermostat=MaxwellBoltzmann())  # fmt: skip
    nu = setting.transport(case).viscosity

    def field(r):
        v, square = np.zeros(r.shape), (r[:, 0] - 8) ** 2 + (r[:, 1] - 8) ** 2
        v[:, 2] = 0.05 * (49 - square) / (4 * 1.5 * nu) + 0.1
        return v

    result = watched(case, RadialProfile(of="axial"), field, 120, seed=2)
    found = by_name(result)
    viscosity = found["viscosity from curvature"]
    assert viscosity.expected == nu and abs(viscosity.measured - 1.5 * nu) < 4 * viscosity.error
    assert viscosity.error < 0.1 * nu
    centre = 0.05 * 49 / (6 * nu) + 0.1
    slip = found["slip at the wall"]
    assert abs(slip.measured - 10 / centre) < 4 * slip.error and slip.error < 3
    assert ((result.value - result.fit) ** 2 / result.error**2).mean() < 1.6


def test_density_and_temperature_in_rings(make_case):
    case = make_case((16, 16), walls=gap_walls(0.0), thermostat=MaxwellBoltzmann(), kT=1.7)
    density = watched(case, RadialProfile(of="density"))
    assert np.abs(density.value - 10).max() < 5 * density.error.max() + 0.01
    spin = turning(lambda r: 1.0 + 0 * r, np.array([8, 8]))
    warm = watched(case, RadialProfile(of="temperature"), spin)
    mean = by_name(warm)["mean temperature"]
    # what is left in a ring of width 1/4 of a rotation at rate 1
    assert mean.measured == pytest.approx(1.7, abs=4 * mean.error + 0.01)


def test_rings_about_a_place_of_ones_own(make_case):
    case = make_case((12, 12), walls=[Plates(axis="y")])
    observable = RadialProfile(centre=(0.0, 6.0), radii=(1.0, 5.0), of="density", bins_per_cell=2)
    result = watched(case, observable)
    assert len(result.value) == 8 and np.abs(result.deviation).max() < 4.5
    corner = RadialProfile(centre=(0.0, 0.0), radii=(0.0, 5.0), of="density", bins_per_cell=1)
    volumes = corner.accumulator(case).volumes
    assert volumes == pytest.approx(np.pi / 2 * np.diff(np.arange(6.0) ** 2), rel=0.02)


@pytest.mark.parametrize(
    ("observable", "words"),
    [
        (RadialProfile(axis="z"), "axis = 'z': only in 3D"),
        (RadialProfile(of="axial"), "of = 'axial': only in 3D"),
        (RadialProfile(centre=(1, 2, 3)), "expected 2 numbers"),
        (RadialProfile(radii=(3, 2)), r"radii = \[3, 2\]: expected 0 <= innermost < outermost"),
        (SurfaceProfile(solid="disc"), "solid = 'disc': expected one of disk-1"),
        (SurfaceProfile(flow="x"), "flow: no effect with of = 'density'"),
        (SurfaceProfile(of="speed", flow="z"), "flow = 'z': a 2D box"),
    ],
)
def test_what_makes_no_sense_is_refused(make_case, observable, words):
    with pytest.raises(CaseError, match=words) as error:
        make_case((8, 8), [observable], [Disk(centre=[4, 4], radius=1)])
    assert "\n" not in str(error.value)


def test_surface_profile_needs_a_surface_and_a_flow(make_case):
    with pytest.raises(CaseError, match="needs a"):
        make_case((8, 8), [SurfaceProfile()])
    with pytest.raises(CaseError, match="flow: missing"):
        make_case((8, 8, 8), [SurfaceProfile(of="speed")], [Sphere(centre=[4, 4, 4], radius=1)])


# --- next to surfaces ---------------------------------------------------------------------------


def shell_volume(walls, size, make_case, **kwargs):
    accumulator = SurfaceProfile(**kwargs).accumulator(make_case(size, walls=walls))
    return accumulator.edges, accumulator.volumes


def test_volumes_of_shells(make_case):
    e, volume = shell_volume([Disk(centre=[8.3, 8.1], radius=3)], (16, 16), make_case)
    assert volume == pytest.approx(np.pi * np.diff((e + 3) ** 2), rel=2e-3)
    slab = [Rectangle(centre=[8.2, 8], size=[5, 3], angle=20)]
    e, volume = shell_volume(slab, (16, 16), make_case, depth=2)
    assert volume == pytest.approx(np.diff(16 * e + np.pi * e**2), rel=2e-3)
    e, volume = shell_volume([Sphere(centre=[5, 5, 5], radius=2.5)], (10, 10, 10), make_case,
                             depth=2, bins_per_cell=4)  # fmt: skip
    assert volume == pytest.approx(4 / 3 * np.pi * np.diff((e + 2.5) ** 3), rel=2e-3)
    both = [Plates(axis="y"), Disk(centre=[8, 8], radius=2, name="post")]
    e, volume = shell_volume(both, (16, 16), make_case, depth=2, solid="post")
    assert volume == pytest.approx(np.pi * np.diff((e + 2) ** 2), rel=2e-3)


def test_density_is_uniform_up_to_a_surface_or_not(make_case):
    case = make_case((16, 16), walls=[Disk(centre=[8.3, 8.1], radius=3)])
    result = watched(case, SurfaceProfile())
    assert np.abs(result.deviation).max() < 4.5 and len(result.value) == 24
    found = by_name(result)
    assert abs(found["density in the cell at the surface"].deviation) < 4
    assert abs(found["chi-square per degree of freedom"].deviation) < 4
    accumulator, fluid = SurfaceProfile().accumulator(case), FakeFluid(case, field=np.zeros_like)
    for _ in range(300):
        fluid.jump(10)
        arm = fluid.unwrapped - (8.3, 8.1)
        close = np.hypot(*arm.T) < 3.5
        fluid.unwrapped[close] += 1.0 * (arm / np.hypot(*arm.T)[:, None])[close]
        accumulator.observe(fluid)
    assert by_name(accumulator.result())["density in the cell at the surface"].deviation < -5


def test_temperature_about_the_motion_along_the_surface(make_case):
    walls = [Disk(centre=[8, 8], radius=3, surface=Surface(rotation=0.5))]
    case = make_case((16, 16), walls=walls, thermostat=MaxwellBoltzmann())
    spin = turning(lambda r: 9.0 / np.maximum(r, 1) ** 2, np.array([8, 8]))
    result = watched(case, SurfaceProfile(of="temperature"), spin)
    assert np.abs(result.value - 1).max() < 5 * result.error.max() + 0.01
    speed = watched(case, SurfaceProfile(of="speed"), spin)
    r = 3 + speed.x["distance"]
    assert np.abs((speed.value - 9 / r) / speed.error).max() < 4.5


def test_speed_with_the_flow_past_a_body(make_case):
    walls = [Disk(centre=[8, 8], radius=3)]
    case = make_case((16, 16), walls=walls, force=Uniform((0.01, 0)))
    result = watched(case, SurfaceProfile(of="speed"), lambda r: np.full(r.shape, (0.5, 0.0)))
    # the part of a uniform flow that is along a circle: the mean of |sin|
    assert np.abs((result.value - 0.5 * 2 / np.pi) / result.error).max() < 4.5
    assert result.expected is None


def test_a_real_fluid_is_uniform_up_to_a_post(make_case):
    observe = [SurfaceProfile(), SurfaceProfile(of="temperature", name="warmth"),
               RadialProfile(of="density")]  # fmt: skip
    parts = make_case((16, 16), observe, [Disk(centre=[8, 8], radius=3)],
                      thermostat=MaxwellBoltzmann(), collision=SRD(angle=90))  # fmt: skip
    run = type(parts.run)(steps=5000, warmup=200)
    simulation = Simulation(Case(**{**vars(parts), "run": run}), threads=1)
    simulation.run()
    for result in simulation.results.values():
        assert np.abs(result.deviation).max() < 5, result.name
        for found in comparisons(result):
            assert abs(found.deviation) < 4.5, str(found)


def test_a_real_fluid_between_turning_surfaces(make_case):
    """Velocity of Taylor and Couette, and the torques of a fluid that loses angular momentum."""
    walls = [
        Disk(centre=[11, 11], radius=3),
        Disk(centre=[11, 11], radius=9, fluid="inside", surface=Surface(rotation=0.04)),
    ]
    parts = make_case((22, 22), [RadialProfile(), Forces()], walls,
                      thermostat=MaxwellBoltzmann(), collision=SRD(angle=90))  # fmt: skip
    run = type(parts.run)(steps=6000, warmup=1500)
    simulation = Simulation(Case(**{**vars(parts), "run": run}), threads=1)
    simulation.run()
    profile = by_name(simulation["radial-profile"])
    for name in ("inner", "outer"):
        slip = profile[f"slip at the {name} surface"]
        assert abs(slip.measured) < 4 * slip.error + 2 and slip.error < 4
    outer = by_name(simulation["forces"])["torque on disk-2"]
    one_sided = 2 * np.pi * 81 * 0.04 * 10 * setting.transport(parts).viscosity_collisional
    assert one_sided > 0.5 * abs(outer.expected) > 5 * outer.error
    assert outer.measured == pytest.approx(outer.expected, rel=0.1, abs=4 * outer.error)
