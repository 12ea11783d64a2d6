"""Fingerprints: what every case of the repository computes in a few steps, as hashes of the bits.

    python -m benchmarks.fingerprints now.txt [--only PART-OF-A-NAME]
    diff before.txt now.txt

The referee of a change that must keep every bit: the hash of all positions, velocities and images
by particle number, and one of every number that the observables report. The results of one machine
and one version of numba can be compared.
"""

from __future__ import annotations

import argparse
import hashlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
STEPS = 24
COMBINATIONS = {
    "2d at+a plates": """
box = { size = [12, 10] }
fluid = { collision = { rule = "at+a" }, force = { rule = "uniform", acceleration = [0.01, 0] } }
wall = [{ shape = "plates", axis = "y", virtual = "fill" }]
""",
    "3d srd plates top-up": """
box = { size = [8, 8, 6] }
fluid = { collision = { rule = "srd", angle = 130 }, thermostat = { rule = "rescale" } }
wall = [{ shape = "plates", axis = "z", virtual = "top-up" }]
""",
    "3d srd+a mixture": """
box = { size = [8, 8, 8] }
[fluid]
collision = { rule = "srd+a", angle = 130 }
species = [{ mass = 1, density = 6 }, { mass = 4, density = 3 }]
""",
    "2d at disk top-up": """
box = { size = [16, 12] }
fluid = { collision = { rule = "at" }, force = { rule = "uniform", acceleration = [0.01, 0] } }
wall = [{ shape = "disk", centre = [8, 6], radius = 3, virtual = "top-up" }]
""",
    "3d at+a sphere fill": """
box = { size = [10, 10, 10] }
fluid = { collision = { rule = "at+a" }, thermostat = { rule = "none" } }
wall = [{ shape = "sphere", centre = [5, 5, 5], radius = 2.5, virtual = "fill" }]
""",
    "3d srd sheared oscillating": """
box = { size = [8, 8, 8], shear_rate = 0.1, shear_frequency = 0.5 }
fluid = { thermostat = { rule = "maxwell-boltzmann" } }
""",
    "3d thermostatted decamers": """
box = { size = [8, 8, 8], shear_rate = 0.05 }
[fluid]
thermostat = { rule = "maxwell-boltzmann" }
[fluid.molecule]
length = 10
bond = { rule = "fene" }
pair = { rule = "wca" }
""",
}


def cases() -> Iterator[tuple[str, Any]]:
    """Name and case, cut to some steps with every observable looking at each fourth."""
    from mesokit import Case
    from mesokit.run.warm import shortened

    folders = [ROOT / "examples", ROOT / "src" / "mesokit"]
    files = sorted(f for folder in folders for f in folder.rglob("*.toml"))
    for file in files:
        if file.parent.name == "studies":  # several cases each
            continue
        name = file.relative_to(ROOT).as_posix().removeprefix("src/mesokit/").split("/")
        name = "/".join(part for part in name if part not in ("method", "mpcd"))
        yield name, shortened(file, {}, STEPS)
    for name, text in COMBINATIONS.items():
        yield name, Case.from_toml(_written(f"run = {{ steps = {STEPS} }}\n{text}"))


def _written(text: str) -> Path:
    import tempfile

    path = Path(tempfile.mkdtemp()) / "case.toml"
    observed = ["conservation", "velocity-profile"]
    lines = [f'[[observe]]\nquantity = "{name}"\nevery = 4' for name in observed]
    path.write_text("\n".join([text, *lines]))
    return path


def fingerprint(case: Any, threads: int) -> tuple[str, str]:
    """Hash of the state by particle number, and of what the observables report."""
    from mesokit import Simulation

    simulation = Simulation(case, threads=threads)
    simulation.run()
    return _hash(state(simulation)), _hash(list(_numbers(simulation.results)))


def state(simulation: Any) -> list[np.ndarray]:
    """Positions and velocities of all particles and beads, or the sites of a lattice."""
    engine = simulation.engine
    if hasattr(engine, "sites"):
        return [engine.sites()]
    if not hasattr(engine, "whole_positions"):  # a method whose particles have no velocities
        return [engine.positions(unwrapped=True)]
    arrays = [engine.whole_positions(), engine.velocities()]
    if engine.solutes is not None:
        arrays += [engine.solutes.places, engine.solutes.velocities]
    return arrays


def _numbers(results: Any) -> Iterator[np.ndarray]:
    for result in results.values():
        for array in (result.value, result.error, result.expected, *result.x.values()):
            if array is not None and np.asarray(array).dtype.kind in "fi":
                yield np.asarray(array, float)
        for row in result.comparisons:
            yield np.array([row.measured, row.error, row.expected])


def _hash(arrays: list[np.ndarray]) -> str:
    code = hashlib.sha256()
    for array in arrays:
        code.update(np.ascontiguousarray(array).tobytes())
    return code.hexdigest()[:16]


def main() -> None:
    """Write one line for each case."""
    given = argparse.ArgumentParser(description=__doc__)
    given.add_argument("output", type=Path)
    given.add_argument("--only", default="")
    given.add_argument("--threads", type=int, default=2)
    options = given.parse_args()
    with options.output.open("w") as out:
        for name, case in cases():
            if options.only in name:
                line = " ".join([name, *fingerprint(case, options.threads)])
                print(line, file=out, flush=True)
                print(line, flush=True)


if __name__ == "__main__":
    main()
