"""Groups by address keep compiled functions short: arguments are what compiling cost most."""

from __future__ import annotations

import llvmlite.binding as llvm

from mesokit import Box, Case, Fluid, Plates, Run, Simulation
from mesokit.kernels.kept import kept

MOST = 120


def test_no_part_takes_hundreds_of_values() -> None:
    case = Case(run=Run(steps=2), box=Box([8, 8]), fluid=Fluid(), walls=[Plates("y")])
    Simulation(case, threads=1).run(progress=False)
    store = kept().own
    assert store is not None
    number, longest = 0, {}
    for _, entry in store.parts():
        code = store.code(entry.code)
        assert code is not None
        for function in llvm.parse_bitcode(code.body).functions:
            if not function.is_declaration:
                number += 1
                longest[code.name] = max(longest.get(code.name, 0), len(list(function.arguments)))
    assert number > 200
    assert {name: values for name, values in longest.items() if values > MOST} == {}
