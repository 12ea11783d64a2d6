"""What the kernels of a device's engine need, by the assembler of cards; no card is needed.

    python -m benchmarks.gpu_kernels [chip ...]        such as 80 90 120

A table in Markdown: instructions of the text (PTX), registers of each chip, bytes of spills and of
the thread's own memory, double precision operations, and accesses to global memory. An addition of
a whole record is one access.
"""

from __future__ import annotations

import re
import sys
from collections import Counter
from collections.abc import Iterator
from typing import Any, NamedTuple

from numba import typeof

from mesokit import (
    AT,
    FENE,
    SRD,
    WCA,
    ATPlusA,
    Box,
    Case,
    Disk,
    Fluid,
    Harmonic,
    MaxwellBoltzmann,
    Molecule,
    NoThermostat,
    Plates,
    Polymer,
    Run,
    Solutes,
    Sphere,
    SRDPlusA,
    SteadyShear,
    Uniform,
)
from mesokit.devices.cubins import made
from mesokit.devices.host import Host
from mesokit.method.mpcd.engine.cuda.engine import CUDA

CHIPS = ((8, 0), (9, 0), (12, 0))
HELD = {"collision": SRD(angle=130), "thermostat": MaxwellBoltzmann()}
FORCE = {2: Uniform([0.01, 0.0]), 3: Uniform([0.01, 0.0, 0.0])}
CASES: dict[str, tuple[int, dict[str, Any]]] = {
    "3D SRD": (3, {"collision": SRD(angle=130), "thermostat": NoThermostat()}),
    "3D SRD, thermostat": (3, HELD),
    "3D AT": (3, {"collision": AT()}),
    "3D SRD+a, thermostat": (3, HELD | {"collision": SRDPlusA(angle=130)}),
    "3D AT+a": (3, {"collision": ATPlusA()}),
    "3D sheared, thermostat": (3, HELD | {"shear": SteadyShear(0.05)}),
    "2D SRD, thermostat": (2, HELD),
    "3D slit, thermostat": (3, HELD | {"walls": [Plates("z")], "force": FORCE[3]}),
    "3D sphere, thermostat": (
        3, HELD | {"walls": [Sphere(centre=[4, 4, 4], radius=2)], "force": FORCE[3]},
    ),
    "3D dimers, thermostat": (3, HELD | {"molecule": Molecule(bond=Harmonic(K=4.0))}),
    "3D slit, SRD+a, thermostat": (
        3, HELD | {"collision": SRDPlusA(angle=130), "walls": [Plates("z")], "force": FORCE[3]},
    ),
    "3D chains, thermostat": (
        3, HELD | {"solutes": Solutes((Polymer(2, length=4),), bond=FENE(), pair=WCA())},
    ),
    "3D beads in the fluid, thermostat": (
        3, HELD | {"solutes": Solutes((Polymer(2),), coupling="potential", solvent_pair=WCA())},
    ),
    "2D disk, thermostat": (
        2, HELD | {"walls": [Disk(centre=[4, 4], radius=2)], "force": FORCE[2]},
    ),
}  # fmt: skip


class Needs(NamedTuple):
    """What a kernel needs on a chip."""

    instructions: int
    registers: int
    spills: int
    own_memory: int
    double: int
    loads: int
    stores: int
    additions: int


class Listing(Host):
    """A device that notes the kernels that an engine asks for, for a chip."""

    def __init__(self, chip: tuple[int, int]) -> None:
        super().__init__()
        self.chip = chip
        self.asked: dict[str, tuple[Any, Any]] = {}

    def kernel(self, body: Any, given: tuple[Any, ...]) -> Any:
        self.asked[body.__name__] = body, tuple(map(typeof, given))
        return super().kernel(body, given)


def case_of(name: str, cells: int = 8) -> Case:
    """A case of the table in a small box."""
    d, parts = CASES[name]
    parts = dict(parts)
    walls, shear = parts.pop("walls", ()), parts.pop("shear", None)
    solutes = parts.pop("solutes", None)
    box = Box([cells] * d, shear=shear) if shear else Box([cells] * d)
    return Case(run=Run(steps=1), box=box, fluid=Fluid(**parts), walls=walls, solutes=solutes)


def kernels_of(name: str, chip: tuple[int, int]) -> dict[str, tuple[Any, Any]]:
    """Bodies and types of arguments of the kernels of a case's step, by their names."""
    listing = Listing(chip)
    CUDA(case_of(name), listing, ())
    return listing.asked


def needs(body: Any, kinds: Any, chip: tuple[int, int]) -> Needs:
    """What a kernel needs, from its text and the words of the assembler."""
    new = made(body, kinds, chip)
    lines = [line for line in new.ptx.splitlines() if line.startswith("\t")]
    names = Counter(re.sub(r"@!?%p\d+\s+", "", line.strip()).split()[0] for line in lines)

    def number(pattern: str) -> int:
        return sum(many for name, many in names.items() if re.match(pattern, name))

    def most(pattern: str) -> int:
        return max(map(int, re.findall(pattern, new.said)), default=0)

    return Needs(
        instructions=sum(many for name, many in names.items() if not name.startswith(".")),
        registers=most(r"Used (\d+) registers"),
        spills=most(r"(\d+) bytes spill stores"),
        own_memory=most(r"(\d+) bytes stack frame"),
        double=number(r"(add|sub|mul|fma|div|sqrt|rcp|setp\.\w+)[.\w]*f64"),
        loads=number(r"ld\.global"),
        stores=number(r"st\.global"),
        additions=len(re.findall(r"\b(?:red|atom)\.[\w.]+|cp\.reduce", new.ptx)),
    )


def rows(name: str, chips: tuple[tuple[int, int], ...]) -> Iterator[list[str]]:
    """Kernel and needs of each kernel of a case; numbers in which chips differ side by side."""
    kernels = {chip: kernels_of(name, chip) for chip in chips}
    for kernel in kernels[chips[0]]:
        found = [needs(*kernels[chip][kernel], chip) for chip in chips]
        cells = (dict.fromkeys(map(str, column)) for column in zip(*found, strict=True))
        same = [" / ".join(column) for column in cells]
        same[1] = " / ".join(str(one.registers) for one in found)
        yield [f"`{kernel}`", *same]


def main() -> None:
    given = tuple((int(word) // 10, int(word) % 10) for word in sys.argv[1:]) or CHIPS
    print("| case | kernel | " + " | ".join(Needs._fields).replace("_", " ") + " |")
    print("|---" * (2 + len(Needs._fields)) + "|")
    for name in CASES:
        for row in rows(name, given):
            print(f"| {name} | " + " | ".join(row) + " |", flush=True)


if __name__ == "__main__":
    main()
