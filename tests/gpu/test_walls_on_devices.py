"""Walls and their virtual particles on a device: the bits of the processor's engine.

States hold how the flow rises from each piece of surface, and readings what each surface took.
"""

from __future__ import annotations

import functools

import pytest

from mesokit import (
    AT,
    SRD,
    Disk,
    MaxwellBoltzmann,
    NoThermostat,
    Plates,
    Rescale,
    Species,
    Sphere,
    SRDPlusA,
    Surface,
    Uniform,
)
from mesokit.devices.checked import Checked
from mesokit.devices.host import Host
from mesokit.method.mpcd.engine.cuda.refused import refused
from tests.helpers.on_devices import pair
from tests.helpers.small_fluids import make_case

STEPS = 30  # three sorts more than that at the start, at this timestep
MEASURED = ("walls",)
CHIPS = ((9, 0), (8, 0), (12, 0))
DEVICES = {
    "host": lambda: Host(3),
    **{f"checked {chip}": functools.partial(Checked, chip) for chip in CHIPS},
}
MIXED = (Species(mass=1, density=3), Species(mass=2.5, density=5))
MOVING = {2: Surface(velocity=(0.2, 0.0)), 3: Surface(velocity=(0.2, 0.0, 0.1))}
TURNING = {2: Surface(rotation=0.1), 3: Surface(rotation=(0.0, 0.0, 0.1))}
QUICK = {
    "2D moving plates": "host",
    "2D turning solid": "checked (9, 0)",
    "2D plates, mixture": "checked (9, 0)",
}


def fluid(dimension: int, **parts) -> dict:
    """A fluid in a small box that is driven along x."""
    size = {2: (10, 11), 3: (6, 7, 6)}[dimension]
    force = Uniform((0.02,) + (0.0,) * (dimension - 1))
    held = {"collision": SRD(angle=130.0), "thermostat": MaxwellBoltzmann(), "force": force}
    return {"size": size, "density": 8, "timestep": 0.5} | held | parts


def solid(dimension: int, **parts) -> Disk | Sphere:
    """A solid in tables."""
    if dimension == 2:
        return Disk(centre=(5.2, 5.0), radius=3.0, **parts)
    return Sphere(centre=(3.1, 3.0, 3.0), radius=1.8, **parts)


def kinds(dimension: int) -> dict[str, dict]:
    """Every rule of virtual particles, at plates and solids, and every way to draw them."""
    made = functools.partial(fluid, dimension)
    between, around = Plates("y"), solid(dimension)
    moving = Plates("y", lower=MOVING[dimension], upper=Surface("diffuse"))
    found = {
        "moving plates": made(walls=[moving]),
        "turning solid": made(walls=[solid(dimension, surface=TURNING[dimension])]),
    }
    for rule in ("extrapolate", "fill", "top-up"):
        found[f"plates, {rule}"] = made(walls=[Plates("y", virtual=rule)])
        found[f"solid, {rule}"] = made(walls=[solid(dimension, virtual=rule)])
    for name, wall in {"plates": between, "solid": around}.items():
        found[f"{name}, energy kept"] = made(walls=[wall], thermostat=Rescale())
        found[f"{name}, AT"] = made(walls=[wall], collision=AT(), thermostat=NoThermostat())
        found[f"{name}, SRD+a"] = made(walls=[wall], collision=SRDPlusA(angle=130.0))
        found[f"{name}, mixture"] = made(walls=[wall], species=MIXED)
    found["dense"] = made(walls=[around], density=40)  # numbers are drawn in parts
    found["plates and solid"] = made(walls=[between, around])
    return found


KINDS = {f"{d}D {name}": parts for d in (2, 3) for name, parts in kinds(d).items()}


@pytest.fixture(scope="module")
def devices():
    """Each device once: kernels are made for the first fluid that needs them."""
    made = {}
    return lambda name: made.setdefault(name, DEVICES[name]())


def rows():
    """Every kind on one device; few of them are quick, in two dimensions."""
    for place, kind in enumerate(KINDS):
        device = QUICK.get(kind, f"checked {CHIPS[place % len(CHIPS)]}")
        marks = [] if kind in QUICK else [pytest.mark.long]
        yield pytest.param(device, kind, marks=marks, id=f"{kind}, {device}")


@pytest.mark.parametrize(("device", "kind"), list(rows()))
def test_walls_have_the_same_bits(devices, device, kind) -> None:
    """Momentum that walls took and the flow near them are there, and go on from a checkpoint."""
    both = pair(devices(device), MEASURED, **KINDS[kind])
    both.advance(STEPS)
    both.require_same()
    both.cpu.advance(1)
    both.on_device.restore(both.cpu.state())
    both.advance(STEPS)
    both.require_same()
    assert (both.cpu.wall_impulse != 0.0).any()
    known = both.cpu.numbers.virtual == "extrapolate"
    assert (both.cpu.state()["wall_rates"] != 0.0).any() == known
    assert getattr(devices(device), "faults", {}) == {}


def test_walls_without_measurements_have_the_same_bits(devices) -> None:
    both = pair(devices("host"), **KINDS["2D moving plates"])
    both.advance(STEPS)
    both.require_same()


@pytest.mark.parametrize("kind", KINDS)
def test_virtual_particles_of_no_kind_are_refused(kind) -> None:
    assert list(refused(make_case(**KINDS[kind]))) == []
