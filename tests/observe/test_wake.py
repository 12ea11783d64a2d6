"""The flow behind a body, and oscillations at a place."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import (
    Array,
    Cylinder,
    Disk,
    MaxwellBoltzmann,
    OscillatingForce,
    Plates,
    Probe,
    Rectangle,
    Sphere,
    Uniform,
    Wake,
    theory,
)
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected import recognise
from mesokit.method.mpcd.expected.setting import transport
from mesokit.method.mpcd.observe.wake import Standing
from tests.helpers.comparisons import by_name
from tests.helpers.fake_fluid import FakeFluid

PUSHED = {"force": Uniform((0.01, 0)), "thermostat": MaxwellBoltzmann()}


def watched(case, observable, field, samples=300, seed=1):
    accumulator = observable.accumulator(case)
    fluid = FakeFluid(case, seed, field=field)
    for _ in range(samples):
        fluid.jump(10)
        accumulator.observe(fluid)
    return accumulator.result()


def behind(rear, length, slope=0.2, sign=1):
    """Velocity along x that passes zero at this distance behind the rear, in line with it."""

    def field(r):
        v = np.zeros(r.shape)
        away = sign * (r[:, 0] - rear)
        v[:, 0] = sign * slope * np.clip(away - length, -1.5, 1.5)
        return v

    return field


@pytest.mark.parametrize("sign", [1, -1])
def test_length_of_the_part_that_flows_back(make_case, sign):
    case = make_case((24, 12), walls=[Disk(centre=[12 - 4 * sign, 6], radius=2)],
                     force=Uniform((0.01 * sign, 0)))  # fmt: skip
    found = by_name(watched(case, Wake(), behind(12 - 2 * sign, 3.0, sign=sign)))
    length = found["L_r/D"]
    assert length.measured == pytest.approx(0.75, abs=4 * length.error) and length.error < 0.03
    back = found["velocity in the cell behind the body"]
    assert back.measured == pytest.approx(-0.3, abs=4 * back.error)


def test_error_of_the_length_is_that_of_repeated_runs(make_case):
    case = make_case((24, 12), walls=[Disk(centre=[8, 6], radius=2)], **PUSHED)
    found = [
        by_name(watched(case, Wake(), behind(10, 3.0), 60, seed))["L_r/D"] for seed in range(20)
    ]
    spread = np.std([c.measured for c in found], ddof=1)
    assert 0.6 < np.sqrt(np.mean([c.error**2 for c in found])) / spread < 1.6


def test_no_length_where_nothing_flows_back(make_case):
    case = make_case((24, 12), walls=[Disk(centre=[8, 6], radius=2)], **PUSHED)
    result = watched(case, Wake(), lambda r: np.full(r.shape, (0.3, 0.0)), 60)
    assert "L_r/D" not in by_name(result) and result.extra["recirculation"] == 0.0


def standing(make_case, walls, size=(24, 12), **kwargs):
    case = make_case(size, walls=walls, force=Uniform((0.01,) + (0,) * (len(size) - 1)))
    return Standing(Wake(**kwargs), case)


def test_where_bodies_stand(make_case):
    body = standing(make_case, [Disk(centre=[8, 6], radius=2)])
    assert (body.rear, body.size, body.room) == pytest.approx((2, 4, 20), abs=0.02)
    body = standing(make_case, [Plates(axis="y"), Rectangle(centre=[8, 6], size=[3, 5])])
    assert (body.rear, body.size, body.room) == pytest.approx((1.5, 5, 21), abs=0.02)
    body = standing(make_case, [Array(of=Disk(centre=[3, 3], radius=1), repeat=[4, 2])])
    assert (body.rear, body.size, body.room) == pytest.approx((1, 2, 4), abs=0.02)
    round_rod = [Cylinder(centre=[8, 6, 0], radius=2)]
    assert standing(make_case, round_rod, (24, 12, 6)).across == [1]
    assert standing(make_case, [Sphere(centre=[8, 6, 6], radius=2)], (24, 12, 12)).across == [1, 2]


@pytest.mark.parametrize(
    ("observable", "walls", "words"),
    [
        (Wake(), [], "needs a"),
        (Wake(solid="post"), [Disk(centre=[4, 4], radius=1)], "solid = 'post': expected one of"),
        (Wake(), [Disk(centre=[4, 4], radius=1)], "flow: missing"),
        (Wake(flow="z"), [Disk(centre=[4, 4], radius=1)], "flow = 'z': a 2D box"),
        (Wake(flow="x"), [Disk(centre=[4, 4], radius=3, fluid="inside")], "is not in it"),
        (Probe(), [Disk(centre=[4, 4], radius=1)], r"centre = \[4, 4\]: lies in a solid"),
        (Probe(centre=(1.0,)), [], r"centre = \[1\]: expected 2 numbers"),
        (Probe(size=(1.0, 9.0)), [], "size = .* expected lengths that fit"),
        (Probe(component="z"), [], "component = 'z': a 2D box"),
        (Probe(speed=0.1), [], "speed: no effect without length"),
    ],
)
def test_what_makes_no_sense_is_refused(make_case, observable, walls, words):
    with pytest.raises(CaseError, match=words) as error:
        make_case((8, 8), [observable], walls)
    assert "\n" not in str(error.value)


def test_known_channels_are_recognised(make_case):
    plates = Plates(axis="y")
    for body, kind in (
        (Disk(centre=[8, 16], radius=2), "disk"),
        (Rectangle(centre=[8, 16], size=[4, 4]), "square"),
        (Rectangle(centre=[8, 16], size=[4, 5]), None),
        (Disk(centre=[8, 12], radius=2), None),
        (Disk(centre=[8, 16], radius=4), None),
    ):
        assert recognise.in_channel(make_case((48, 32), walls=[plates, body])) == kind


# --- probe --------------------------------------------------------------------------------------


def shaken(case, observable, frequency, amplitude=0.5, samples=3000, seed=1):
    """A fluid that swings along y."""
    accumulator = observable.accumulator(case)
    fluid = FakeFluid(case, seed)
    swing = np.zeros(2)
    fluid.field = lambda r: np.tile(swing, (len(r), 1))
    for _ in range(samples):
        fluid.jump(10)
        swing[:] = 0.2, amplitude * np.sin(2 * np.pi * frequency * fluid.time)
        accumulator.observe(fluid)
    return accumulator.result()


def test_probe_finds_the_frequency(make_case):
    observable = Probe(centre=(2, 2), size=(4, 4), speed=0.2, length=3.0)
    case = make_case((8, 8), [observable], density=5, **PUSHED)
    result = shaken(case, observable, 0.0213)
    found = by_name(result)
    peak = found["dominant frequency"]
    assert abs(peak.measured - 0.0213) < 4 * peak.error and peak.error < 2e-4
    number = found["Strouhal number"]
    assert number.measured == pytest.approx(15 * peak.measured)
    assert number.error == pytest.approx(15 * peak.error)
    mean = found["mean velocity v_x"]
    assert abs(mean.measured - 0.2) < 4 * mean.error
    assert result.extra["component"] == "y"
    assert result.extra["velocity"].shape == (3000, 2)
    variance = np.trapezoid(result.value, result.x["frequency"])
    assert variance == pytest.approx(result.extra["velocity"][:, 1].var(), rel=0.1)


def test_noise_has_no_frequency(make_case):
    case = make_case((8, 8), [Probe()], density=5, **PUSHED)
    assert "dominant frequency" not in by_name(shaken(case, Probe(), 0.02, amplitude=0.0))


def test_a_probe_ends_at_plates_and_goes_on_beyond_periodic_ends(make_case):
    walls = (Plates("y"),)
    make_case((8, 8), [Probe(centre=(0, 1))], walls=walls)
    make_case((8, 8), [Probe(centre=(0, 0))])
    for centre in ((4, 0.9), (4, 7.1)):
        with pytest.raises(CaseError, match=r"centre = .*reaches over a plate along y"):
            make_case((8, 8), [Probe(centre=centre)], walls=walls)


def test_probe_remembers_where_nobody_is(make_case):
    case = make_case((8, 8), [Probe(size=(0.05, 0.05))], density=1)
    result = shaken(case, Probe(size=(0.05, 0.05)), 0.02, samples=100)
    assert np.isfinite(result.extra["velocity"]).all()
    assert len(np.unique(result.extra["velocity"][:, 0])) < 20


@pytest.mark.parametrize("phase", [0.0, -90.0])
@pytest.mark.parametrize("walls", [[], [Plates("y")]], ids=["open", "slit"])
def test_swing_with_a_force(make_case, walls, phase):
    """Amplitude and lag of a known velocity, whatever the phase of the force; and theory."""
    frequency, size, lag = 0.3, 0.4, 50.0
    force = OscillatingForce(Uniform((0.05, 0)), frequency, phase)
    case = make_case((16, 8), walls=walls, force=force, thermostat=MaxwellBoltzmann())
    probe = Probe(size=[16, 4])
    accumulator = probe.accumulator(case)

    def field(r):
        v = np.zeros(r.shape)
        v[:, 0] = 0.1 + size * np.cos(frequency * fluid.time + np.radians(phase - lag))
        return v

    fluid = FakeFluid(case, 3, field=field)
    for _ in range(1500):
        fluid.jump(10)
        accumulator.observe(fluid)
    found = by_name(accumulator.result())
    amplitude, behind_it = (found[f"{w} of v_x {x} the force"] for w, x in
                            (("amplitude", "with"), ("lag", "behind")))  # fmt: skip
    assert amplitude.measured == pytest.approx(size, abs=4 * amplitude.error)
    assert behind_it.measured == pytest.approx(lag, abs=4 * behind_it.error)
    assert amplitude.error < 0.02 and behind_it.error < 2
    if not walls:
        assert np.isnan(amplitude.expected) and np.isnan(behind_it.expected)
        return
    nu = transport(case).viscosity
    y = np.linspace(2, 6, 4001)
    chi = 0.05 * theory.oscillating_slit_response(y, 8, nu, frequency).mean()
    assert amplitude.expected == pytest.approx(abs(chi), rel=1e-3)
    assert behind_it.expected == pytest.approx(-np.angle(chi, deg=True), abs=0.1)


def test_nothing_swings_with_a_steady_force(make_case):
    found = by_name(watched(make_case((8, 8), **PUSHED), Probe(), lambda r: np.zeros(r.shape)))
    assert not any("force" in what for what in found)
