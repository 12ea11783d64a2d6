"""Tapes of small fluids: recorded where no card is, played on a card with no compiler beside it.

    python -m benchmarks.tapes record FOLDER --chip 9.0
    python -m benchmarks.tapes play FOLDER --device cuda

To record takes a C compiler and some minutes. To play takes mesokit's sources, numpy and
cuda.bindings; `--device emulated:9.0` plays on the processor. Exit status 1: some bits differ.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

from mesokit.devices.named import opened
from mesokit.devices.recorded import Tape
from mesokit.errors import RunError


def fluids() -> dict[str, dict[str, Any]]:
    """Fluids of a few hundred particles: bulk, walls, molecules and solutes."""
    from mesokit import (
        FENE,
        SRD,
        WCA,
        Disk,
        Harmonic,
        MaxwellBoltzmann,
        Molecule,
        Plates,
        Polymer,
        Solutes,
        SRDPlusA,
        Uniform,
    )
    from tests.helpers.on_devices import bulk, kinds_of_bulk

    kinds = kinds_of_bulk()
    held = {"collision": SRD(angle=130.0), "thermostat": MaxwellBoltzmann()}
    driven = bulk(2) | held | {"force": Uniform((0.02, 0.0)), "size": (10, 11)}
    disk = {"walls": [Disk(centre=(5.2, 5.0), radius=3.0)], "collision": SRDPlusA(angle=130.0)}
    chains = Molecule(length=3, bond=Harmonic(K=1.0), substeps=2)
    solutes = Solutes((Polymer(5, length=4),), mass=4.0, bond=FENE(), pair=WCA(), substeps=50)
    return {
        "at": kinds["2D AT"],
        "thermostat": kinds["2D SRD"],
        "angular-momentum": kinds["2D SRDPlusA"],
        "sheared-mixture": kinds["3D mixture"],
        "plates": driven | {"walls": [Plates("y")]},
        "disk": driven | disk,
        "molecules": bulk(3) | held | {"density": 9, "molecule": chains},
        "solutes": bulk(3) | held | {"solutes": solutes},
    }


def record(folder: Path, chip: tuple[int, int]) -> None:
    """Write a tape of each fluid for cards of a compute capability."""
    from tests.helpers import on_devices

    folder.mkdir(parents=True, exist_ok=True)
    for name, parts in fluids().items():
        on_devices.record(folder / f"{name}.tape", chip, **parts)
        print(f"{name}: recorded", flush=True)


def play(folder: Path, device: Any) -> int:
    """Play all tapes of a folder; how many came out with other bits than were expected."""
    files, wrong = sorted(folder.glob("*.tape")), 0
    if not files:
        sys.exit(f"{folder}: no tape there")
    for file in files:
        tape = Tape(file)
        if device.chip[0] != tape.chip[0] or device.chip < tape.chip:
            sys.exit(f"{file}: for compute capability {tape.chip}; {device.name} has {device.chip}")
        differ = len(tape.play(device).expected)
        wrong += differ > 0
        print(f"{file.stem}: {'OTHER BITS' if differ else 'same bits'}", flush=True)
    return wrong


def main() -> None:
    """Record or play."""
    asked = argparse.ArgumentParser(prog="benchmarks.tapes")
    asked.add_argument("what", choices=("record", "play"))
    asked.add_argument("folder", type=Path)
    asked.add_argument("--chip", default="9.0")
    asked.add_argument("--device", default="cuda")
    given = asked.parse_args()
    if given.what == "record":
        major, _, minor = given.chip.partition(".")
        record(given.folder, (int(major), int(minor)))
        return
    try:
        sys.exit(play(given.folder, opened(given.device)) > 0)
    except RunError as error:
        sys.exit(str(error))


if __name__ == "__main__":
    main()
