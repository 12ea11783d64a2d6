"""A part becomes one of mesokit's own by a file in the folder of its kind, and nothing else."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "extending.md").read_text()
CASE = "[run]\nsteps = 10\n[box]\nsize = [8, 8]\n"
FOLDERS = {
    "observable": ("observe", "[[observe]]\nquantity = 'kurtosis'\n"),
    "collision rule": ("method/mpcd/collision", "[fluid]\ncollision = { rule = 'reversal' }\n"),
    "thermostat": ("method/mpcd/thermostat", "[fluid]\nthermostat = { rule = 'relax' }\n"),
    "body force": (
        "method/mpcd/field",
        "[fluid]\nforce = { rule = 'ramp', slope = 1e-3, height = 8 }\n",
    ),
    "potential": (
        "potential",
        "[solutes]\npolymers = [{ length = 2 }]\nbond = { rule = 'quartic' }\n",
    ),
    "shape": (
        "geometry/shape",
        "[[wall]]\nshape = 'diamond'\ncentre = [4, 4]\nradius = 2\n",
    ),
}


def section(kind: str) -> str:
    """The code of one section of the page, with the imports that all share."""
    texts = re.findall(r"^## An? (.*?)\n(.*?)(?=^## )", PAGE, re.DOTALL | re.MULTILINE)
    blocks = re.compile(r"^```python\n(.*?)^```", re.DOTALL | re.MULTILINE)
    first = blocks.search(PAGE)
    assert first is not None
    code = EXTRA.get(kind, "") + "".join(blocks.findall(dict(texts)[kind]))
    # of the names that all sections share, a file imports those that it needs
    shared = re.sub(
        r"^    (\w+),\n",
        lambda name: name[0] if re.search(rf"\b{name[1]}\b", code) else "",
        first[1],
        flags=re.MULTILINE,
    )
    return shared + code


# what an earlier section of the page has imported
EXTRA = {
    "thermostat": (
        "from mesokit.method.mpcd.thermostat.protocol import root_of_ratio, stretch\n"
        "from mesokit.scalar.jit import optional\n"
    ),
    "shape": "import math\n",
}


@pytest.mark.parametrize("kind", FOLDERS)
def test_a_file_in_the_folder_is_all(kind: str, tmp_path: Path) -> None:
    package = tmp_path / "mesokit"
    shutil.copytree(ROOT / "src" / "mesokit", package, ignore=shutil.ignore_patterns("*.pyc"))
    folder, lines = FOLDERS[kind]
    (package / folder / "my_own.py").write_text(section(kind))
    (tmp_path / "case.toml").write_text(CASE + lines)
    done = subprocess.run(
        [sys.executable, "-m", "mesokit", "check", "case.toml"],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    assert "run time" in done.stdout and "is not here" not in done.stderr
