"""One part of each family from outside the package, as docs/extending.md says.

In a script, and in a case file by an entry point; run, resumed and plotted.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.long

PAGE = Path(__file__).parents[2] / "docs" / "extending.md"
PATIENCE = "mesokit: reading the case"
SCRIPT = "python script"
STOPPING = """
import os, signal
import my_parts
observe = my_parts.KurtosisAccumulator.observe
def stopping(self, fluid):
    observe(self, fluid)
    if fluid.step == 20:
        os.kill(os.getpid(), signal.SIGTERM)
my_parts.KurtosisAccumulator.observe = stopping
"""
RESUMED = """
import my_parts
from mesokit import Simulation, open
simulation = Simulation.resume("run")
assert 20 <= simulation.step < 30, simulation.step
simulation.run()
assert open("run")["kurtosis"].samples == 21
assert all(path.exists() for path in open("run").plot())
"""


def blocks(language: str) -> list[str]:
    found = re.findall(r"^```([^\n]*)\n(.*?)^```", PAGE.read_text(), re.DOTALL | re.MULTILINE)
    return [text for name, text in found if name == language]


@pytest.fixture(scope="module")
def module(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the user's file, not installed."""
    folder = tmp_path_factory.mktemp("script")
    (folder / "my_parts.py").write_text("\n".join(blocks("python")))
    return folder


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory, module: Path) -> Path:
    """A folder with the same file as an installed package has it: with metadata beside it."""
    folder = tmp_path_factory.mktemp("site-packages")
    (folder / "my_parts.py").write_text((module / "my_parts.py").read_text())
    metadata = folder / "my_parts-1.2.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: my-parts\nVersion: 1.2\n")
    (text,) = blocks("toml entry-points")
    text = re.sub(r'\[project\.entry-points\."(.*)"\]', r"[\1]", text).replace('"', "")
    (metadata / "entry_points.txt").write_text(text)
    return folder


def python(
    folder: Path, *arguments: str, path: Path | None = None
) -> subprocess.CompletedProcess[str]:
    """Run Python in a folder, with a folder of packages on its path."""
    where = {"PYTHONPATH": str(path)} if path else {"PYTHONPATH": ""}
    return subprocess.run(
        [sys.executable, *arguments],
        cwd=folder,
        env=os.environ | where,
        capture_output=True,
        text=True,
    )


def mesokit(folder: Path, *arguments: str, path: Path | None = None) -> str:
    done = python(folder, "-m", "mesokit", *arguments, path=path)
    assert done.returncode == 0, done.stderr
    return done.stdout + done.stderr


def refused(folder: Path, *arguments: str, path: Path | None = None) -> str:
    """The one line with which a command is refused."""
    done = python(folder, "-m", "mesokit", *arguments, path=path)
    assert done.returncode
    # what takes long says so
    lines = [line for line in done.stderr.strip().splitlines() if not line.startswith(PATIENCE)]
    assert len(lines) == 1, done.stderr
    return lines[0]


@pytest.fixture(scope="module")
def case(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("case")
    (text,) = blocks("toml case")
    (folder / "case.toml").write_text(text)
    return folder


def test_in_a_script_with_resume_and_plot(module: Path) -> None:
    (script,) = blocks(SCRIPT)
    done = python(module, "-c", script)
    assert done.returncode == 0, done.stderr
    assert "kurtosis along x" in done.stdout
    written = script.replace("simulation.run()", "simulation.write_to('run')\nsimulation.run()")
    stopped = python(module, "-c", STOPPING + written)
    assert "stopped at step 2" in stopped.stderr  # at 20 or soon after
    done = python(module, "-c", RESUMED)
    assert done.returncode == 0, done.stderr
    (kurtosis,) = [
        part
        for part in json.loads((module / "run" / "provenance.json").read_text())["parts"]
        if part["name"] == "kurtosis"
    ]
    assert kurtosis["class"] == "my_parts:Kurtosis" and "version" not in kurtosis
    done = python(module, "-m", "mesokit", "--import", "my_parts", "info", "run")
    assert done.returncode == 0 and "kurtosis along x" in done.stdout, done.stderr
    line = refused(module.parent, "plot", str(module / "run"))
    assert "'reversal'" in line and "my_parts:Reversal" in line and "import" in line


def test_in_a_case_file_by_an_entry_point(case: Path, installed: Path) -> None:
    assert "relax" in mesokit(case, "check", "case.toml", path=installed)
    mesokit(case, "run", "case.toml", path=installed)
    mesokit(case, "plot", "case", path=installed)
    mesokit(case, "resume", "case", path=installed)
    assert (case / "case" / "kurtosis.png").exists()
    parts = json.loads((case / "case" / "provenance.json").read_text())["parts"]
    assert {part["name"] for part in parts} == {
        "reversal", "relax", "ramp", "quartic", "soft", "diamond", "kurtosis",
    }  # fmt: skip
    assert all(part["distribution"] == "my-parts" and part["version"] == "1.2" for part in parts)
    import h5py

    with h5py.File(case / "case" / "run.h5") as file:
        assert json.loads(file["parameters/provenance"].asstr()[()])["parts"] == parts
    for command in ("plot", "resume"):
        line = refused(case, command, "case")
        assert "install my-parts 1.2" in line and "'reversal'" in line


def test_without_the_package_the_names_are_unknown(case: Path) -> None:
    line = refused(case, "check", "case.toml")
    assert "fluid.collision.rule = 'reversal': expected" in line and "'srd'" in line


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("reversel", "my_parts:Reversal", "did you mean 'reversel'"),
        ("reversal", "nowhere:Reversal", "of my-parts 1.2 cannot be loaded: ModuleNotFoundError"),
        ("reversal", "my_parts:Nothing", "cannot be loaded: AttributeError"),
        ("reversal", "broken:Reversal", "cannot be loaded: ZeroDivisionError: not today"),
        (
            "reversal",
            "clash:Second",
            "collision rule 'srd' is mesokit.method.mpcd",
        ),
        ("reversal", "my_parts:Reversing", ""),
        ("reversal", "my_parts:Relax", ""),
        ("reversal", "plain:Plain", "is no collision rule with rule = 'reversal'"),
    ],
)
def test_what_is_wrong_with_an_entry_point_is_one_line(
    name: str, value: str, words: str, case: Path, installed: Path, tmp_path: Path
) -> None:
    metadata = tmp_path / "my_parts-1.2.dist-info"
    metadata.mkdir()
    (tmp_path / "my_parts.py").write_text((installed / "my_parts.py").read_text())
    (tmp_path / "broken.py").write_text("raise ZeroDivisionError('not today')\n")
    (tmp_path / "plain.py").write_text("class Plain:\n    pass\n")
    (tmp_path / "clash.py").write_text(
        "from typing import Literal\nfrom mesokit import component, tag\nfrom my_parts import *\n"
        "@component\nclass Second(Reversal):\n    rule: Literal['srd'] = tag('srd')\n"
    )
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: my-parts\nVersion: 1.2\n")
    (metadata / "entry_points.txt").write_text(f"[mesokit.collision]\n{name} = {value}\n")
    small = tmp_path / "small.toml"
    small.write_text(
        "[run]\nsteps = 1\n[box]\nsize = [8, 8]\n"
        "[fluid]\ncollision = { rule = 'reversal', probability = 0.4 }\n"
    )
    if words:
        assert words in refused(tmp_path, "check", "small.toml", path=tmp_path)
    else:  # the module defines the rule all the same
        mesokit(tmp_path, "check", "small.toml", path=tmp_path)


def test_two_packages_with_one_name_are_one_line(installed: Path, tmp_path: Path) -> None:
    metadata = tmp_path / "other-3.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: other\nVersion: 3\n")
    (metadata / "entry_points.txt").write_text("[mesokit.observable]\nkurtosis = other:Kurtosis\n")
    (tmp_path / "case.toml").write_text(
        "[run]\nsteps = 1\n[box]\nsize = [8, 8]\n[[observe]]\nquantity = 'kurtosis'\n"
    )
    both = Path(f"{installed}{os.pathsep}{tmp_path}")
    line = refused(tmp_path, "check", "case.toml", path=both)
    assert "observable 'kurtosis' is brought by my-parts 1.2 and by other 3; remove one" in line


def test_known_names_load_no_entry_point(installed: Path, tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text("[run]\nsteps = 1\n[box]\nsize = [8, 8]\n")
    program = (
        "import sys\nfrom mesokit import Case\nCase.from_toml('case.toml')\n"
        "assert 'my_parts' not in sys.modules\n"
    )
    done = python(tmp_path, "-c", program, path=installed)
    assert done.returncode == 0, done.stderr
