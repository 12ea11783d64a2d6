"""Fluids of molecules, beside the same harmonic chains in LAMMPS."""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from benchmarks import lammps_peer, once
from mesokit import Harmonic, Molecule
from mesokit.method.mpcd.start.conformation import drawn
from mesokit.method.mpcd.start.draws import Draws
from mesokit.scalar.random import INITIAL_POSITION

LENGTH, DENSITY = 30, 10
BEADS = {"dimers": 2, "decamers": 10}
SUBSTEPS = (1, 5, 10)
REACH = 5.0  # cells: no bond with K = 1 is longer


def molecule(name: str, substeps: int) -> Molecule:
    """Chains with K = 1."""
    return Molecule(length=BEADS[name], bond=Harmonic(K=1.0), substeps=substeps)


def table(rounds: int, seconds: float) -> Iterator[str]:
    """Nanoseconds per particle-step and per particle-sub-step, ours and theirs, in turn."""
    lammps_peer.install()
    yield "## Fluids of molecules"
    yield ""
    yield (
        f"3D, {LENGTH}^3 cells, density {DENSITY}, harmonic chains with K = 1, one thread; "
        "nanoseconds. A sub-step is what ten cost more than five, over five. LAMMPS runs the same "
        "chains with `bond_style harmonic` and `fix nve`, with no fluid; its step is one sub-step."
    )
    yield ""
    yield (
        "| chains | particle-step, 1 sub-step | 5 | 10 | particle-sub-step | LAMMPS | ratio | "
        "5 sub-steps with collisions, per sub-step |"
    )
    yield "|---|---|---|---|---|---|---|---|"
    for name in BEADS:
        names = [f"B-{name}-{n}" for n in SUBSTEPS]
        for one in names:
            once.run(one, 1, 0.0)
        ours: list[list[float]] = []
        theirs: list[float] = []
        with tempfile.TemporaryDirectory() as folder:
            data = Path(folder) / "chains.data"
            write_chains(data, BEADS[name])
            for _ in range(rounds):
                ours.append([float(once.run(one, 1, seconds)["nanoseconds"]) for one in names])
                theirs.append(lammps(data, seconds))
        whole = [median(column) for column in zip(*ours, strict=True)]
        each = [(row[2] - row[1]) / (SUBSTEPS[2] - SUBSTEPS[1]) for row in ours]
        ratio = median(b / a for a, b in zip(each, theirs, strict=True))
        yield (
            f"| {name} | {whole[0]:.1f} | {whole[1]:.1f} | {whole[2]:.1f} | {median(each):.2f} | "
            f"{median(theirs):.1f} | {ratio:.0f} | {whole[1] / SUBSTEPS[1]:.2f} |"
        )


def write_chains(path: Path, beads: int) -> None:
    """Chains at thermal equilibrium as a LAMMPS data file."""
    n = DENSITY * LENGTH**3
    shape: Any = Molecule(length=beads, bond=Harmonic(K=1.0))
    random, box = Draws(1, INITIAL_POSITION, np.arange(n // beads)), np.full(3, float(LENGTH))
    r = drawn(shape, 1.0, box, random, lambda places: np.ones(places.shape[:-1], bool))
    starts = np.arange(0, n, beads)
    bonds = (starts[:, None, None] + np.array(shape.bonds)).reshape(-1, 2)
    write_data(path, LENGTH, r, bonds, beads, "1 1.0 0.0")


def write_data(path: Path, side: int, r: Any, bonds: Any, beads: int, bond: str | None) -> None:
    """Molecules of so many beads in a cubic box; `bond`: the parameters of their bonds."""
    images = np.floor(r / side).astype(int)
    r, n = r - images * side, len(r)
    with path.open("w", encoding="utf-8") as file:
        file.write(f"chains\n\n{n} atoms\n{len(bonds)} bonds\n1 atom types\n1 bond types\n\n")
        file.write("".join(f"0 {side} {k}lo {k}hi\n" for k in "xyz"))
        file.write("\nMasses\n\n1 1.0\n")
        if bond is not None:
            file.write(f"\nBond Coeffs\n\n{bond}\n")
        file.write("\nAtoms\n\n")
        for i in range(n):
            x, y, z = r[i]
            a, b, c = images[i]
            file.write(f"{i + 1} {i // beads + 1} 1 {x:.6f} {y:.6f} {z:.6f} {a} {b} {c}\n")
        file.write("\nBonds\n\n")
        file.writelines(f"{k + 1} 1 {a + 1} {b + 1}\n" for k, (a, b) in enumerate(bonds))


def lammps(data: Path, seconds: float) -> float:
    """Nanoseconds per particle-step."""
    steps = max(20, int(seconds * 100))
    took = loop_time("in.lammps_bonds", data=data, steps=steps, reach=REACH)
    return 1e9 * took / (DENSITY * LENGTH**3 * steps)


def loop_time(script: str, **variables: object) -> float:
    """Seconds that LAMMPS takes for its last run."""
    folder = Path(sys.executable).parent
    command = [str(folder / "mpiexec"), "-n", "1", str(folder / "lmp"), "-in", script]
    command += ["-log", "none"]
    for name, value in variables.items():
        command += ["-var", name, str(value)]
    done = subprocess.run(
        command,
        cwd=lammps_peer.INPUTS,
        env=lammps_peer.environment(),
        capture_output=True,
        text=True,
    )
    if done.returncode != 0:
        raise RuntimeError(f"LAMMPS failed: {done.stdout[-500:]} {done.stderr[-500:]}")
    return float(re.findall(r"Loop time of ([\d.e+-]+)", done.stdout)[-1])
