"""Groups by address keep compiled functions short: arguments are what compiling cost most."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

MOST = 120
PROGRAM = """
import json
import llvmlite.binding as llvm
from mesokit import (
    Box, Case, Fluid, MaxwellBoltzmann, OscillatingForce, Plates, Run, Simulation, Uniform
)
from mesokit.kernels.kept import kept

force = OscillatingForce(Uniform([0.01, 0.0]), frequency=1.0)
fluid = Fluid(thermostat=MaxwellBoltzmann(), force=force)
case = Case(run=Run(steps=2), box=Box([8, 8]), fluid=fluid, walls=[Plates("y")])
Simulation(case, threads=1).run(progress=False)
longest = {}
for _, entry in kept().own.parts():
    for function in llvm.parse_bitcode(kept().own.code(entry.code).body).functions:
        if not function.is_declaration:
            longest[entry.name] = max(longest.get(entry.name, 0), len(list(function.arguments)))
print(json.dumps(longest))
"""


def test_no_part_of_a_slit_takes_hundreds_of_values(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM], capture_output=True, text=True, timeout=300,
        env=os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    longest = json.loads(done.stdout.splitlines()[-1])
    assert len(longest) > 100
    assert {name: values for name, values in longest.items() if values > MOST} == {}
