"""Walls and their virtual particles on a device: the bits of the processor's engine.

States hold how the flow rises from each piece of surface, and readings what each surface took.
"""

from __future__ import annotations

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
from tests.gpu.conftest import CHIPS, FURTHER, LONG
from tests.helpers.on_devices import pair
from tests.helpers.shapes import EVERY, SIZE, example, walls_of

STEPS = 30  # three sorts more than that at the start, at this timestep
MEASURED = ("walls",)
MIXED = (Species(mass=1, density=3), Species(mass=2.5, density=5))
MOVING = {2: Surface(velocity=(0.2, 0.0)), 3: Surface(velocity=(0.2, 0.0, 0.1))}
TURNING = {2: Surface(rotation=0.1), 3: Surface(rotation=(0.0, 0.0, 0.1))}
QUICK = {"2D turning solid": "checked (9, 0)"}
ON_HOST = "2D moving plates"
WIDE = (ON_HOST, "2D solid that tops up, dense", "3D solid, AT, mixture")


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


def kinds() -> dict[str, dict]:
    """Every rule of virtual particles, at plates and solids, and every way to draw them.

    A kind costs its compiling, so that each has several parts at once.
    """
    kept = {"thermostat": Rescale()}
    drawn = {"collision": AT(), "thermostat": NoThermostat()}
    angular = {"collision": SRDPlusA(angle=130.0)}
    mixed, many = {"species": MIXED}, {"density": 40}  # numbers of those are drawn in parts
    diffuse = Surface("diffuse")

    def plates(d: int, **parts) -> Plates:
        return Plates("y", lower=MOVING[d], upper=diffuse, **parts)

    def turning(d: int, **parts) -> Disk | Sphere:
        return solid(d, surface=TURNING[d], **parts)

    return {
        "2D moving plates": fluid(2, walls=[plates(2)]),
        "2D turning solid": fluid(2, walls=[turning(2)]),
        "2D plates that fill, mixture": fluid(2, walls=[plates(2, virtual="fill")], **mixed),
        "2D plates that top up, SRD+a": fluid(2, walls=[plates(2, virtual="top-up")], **angular),
        "2D plates and solid, AT": fluid(2, walls=[Plates("y"), solid(2)], **drawn),
        "2D solid that fills, SRD+a": fluid(2, walls=[turning(2, virtual="fill")], **angular),
        "2D solid that tops up, dense": fluid(2, walls=[turning(2, virtual="top-up")], **many),
        "2D solid, mixture": fluid(2, walls=[solid(2)], **mixed),
        "3D plates, energy kept": fluid(3, walls=[plates(3)], **kept),
        "3D plates, SRD+a": fluid(3, walls=[plates(3)], **angular),
        "3D plates that fill, AT": fluid(3, walls=[plates(3, virtual="fill")], **drawn),
        "3D solid that fills, dense": fluid(3, walls=[turning(3, virtual="fill")], **many),
        "3D solid, AT, mixture": fluid(3, walls=[turning(3)], **drawn, **mixed),
        "3D solid that tops up": fluid(3, walls=[solid(3, virtual="top-up")]),
        "3D plates and solid, energy kept": fluid(3, walls=[Plates("y"), solid(3)], **kept),
    }


KINDS = kinds()


def rows():
    """Every kind on a chip, one of them on the host too; few are quick, in two dimensions."""
    for place, kind in enumerate(KINDS):
        chip = QUICK.get(kind, f"checked {CHIPS[place % len(CHIPS)]}")
        for device in (chip, "host") if kind == ON_HOST else (chip,):
            marks = () if kind in QUICK else LONG if kind in WIDE else FURTHER
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


@pytest.mark.long
def test_walls_without_measurements_have_the_same_bits(devices) -> None:
    both = pair(devices("host"), **KINDS["2D moving plates"])
    both.advance(STEPS)
    both.require_same()


@pytest.mark.long
@pytest.mark.parametrize(("name", "d", "side"), EVERY)
def test_every_shape_has_the_same_bits(devices, name, d, side, tmp_path) -> None:
    """Kernels are the same for all shapes; tables differ."""
    parts = {"size": SIZE[d], "walls": walls_of(example(name, d, side, tmp_path), d)}
    both = pair(devices("host"), MEASURED, **fluid(d, density={2: 16, 3: 8}[d]) | parts)
    both.advance(STEPS)
    both.require_same()
    assert (both.cpu.wall_impulse != 0.0).any()
