"""Functions that one process defines twice, as after `importlib.reload`: the last one runs."""

from __future__ import annotations

import json

import pytest

from tests.helpers.module_with_kernels import Place

AGAIN = """
import json, importlib, os, pathlib, shutil
import numpy as np
import law

def total(before="", after=""):
    text = source.replace(before, after) if before else source
    pathlib.Path("law.py").write_text(text)
    shutil.rmtree("__pycache__", ignore_errors=True)
    importlib.reload(law)
    out = np.zeros(4)
    law.add(law.Line(1.0), (1.0, 2.0), out)
    law.double(out)
    return float(out.sum())

source = pathlib.Path("law.py").read_text()
found = [total(), total("FACTOR = 3.0", "FACTOR = 6.0"), total("return 2.0 *", "return 4.0 *"),
         total("shape.slope * x", "shape.slope * x + 1.0"), total()]
print(json.dumps(found))
"""


@pytest.mark.parametrize("how", ["scalar", "seldom", "stage"])
def test_a_module_that_is_imported_again(tmp_path, how: str) -> None:
    place = Place(tmp_path)
    text = place.law.read_text()
    text = text.replace(
        "import by_type, generic, scalar", "import by_type, generic, scalar, seldom"
    )
    if how == "stage":
        one, other = text.split("@kernel\ndef add")
        one += "from mesokit.kernels.part import stage\n\n@stage\ndef added"
        sides, double = other.split("@kernel\n")
        call = "@kernel\ndef add(shape, rows, out):\n    added(shape, rows, out)\n\n\n"
        text = one + sides + call + "@kernel\n" + double
    elif how == "seldom":
        text = text.replace("@scalar", "@seldom")
    place.law.write_text(text)
    wanted = [72.0, 144.0, 288.0, 120.0, 72.0]
    assert json.loads(json.dumps(place.run(program=AGAIN))) == wanted
    assert place.run(program=AGAIN) == wanted  # with all states in the store


def test_a_class_and_its_functions_in_one_script(tmp_path) -> None:
    script = """
import json
import numpy as np
from mesokit.kernels.kernel import kernel
from mesokit.scalar.jit import scalar, seldom

@kernel
def fill(out):
    for i in range(len(out)):
        out[i] = factor(float(i))

found = []
for number in (1.0, 2.0, 3.0):
    @seldom
    def factor(x):
        return x * NUMBER

    NUMBER = number
    @kernel
    def fill(out):
        for i in range(len(out)):
            out[i] = factor(float(i))
    out = np.zeros(4)
    fill(out)
    found.append(float(out.sum()))
print(json.dumps(found))
"""
    place = Place(tmp_path)
    (tmp_path / "script.py").write_text(script)
    run = "import runpy\nrunpy.run_path('script.py', run_name='__main__')"
    assert place.run(program=run) == [6.0, 12.0, 18.0]
    assert place.run(program=run) == [6.0, 12.0, 18.0]
