"""Every figure of the thesis on viscoelastic fluids is a case that runs and compares."""

import dataclasses
import math
from pathlib import Path

import pytest

from mesokit import Case, Run, Simulation

pytestmark = pytest.mark.long

ROOT = Path(__file__).resolve().parents[2]
CASES = sorted((ROOT / "examples" / "viscoelastic").glob("*.toml"))
FIGURES = ["4_1", "4_2", *(f"5_{n}" for n in range(1, 13)), "6_1", "6_2"]


def test_one_for_each_figure() -> None:
    assert {f"fig_{name}" for name in FIGURES} < {case.stem for case in CASES}


@pytest.mark.parametrize("file", CASES, ids=lambda case: case.stem)
def test_it_runs_and_compares(file: Path) -> None:
    """As its first lines say, but shorter."""
    assert f"\n#   mesokit run {file.name}\n" in file.read_text()
    case = dataclasses.replace(Case.from_toml(file), run=Run(steps=60, warmup=10))
    simulation = Simulation(case, threads=1)
    simulation.run()
    found = [c for o in case.observe for c in simulation[o.label].comparisons]
    assert any(math.isfinite(c.expected) for c in found)


@pytest.mark.parametrize("page", ["examples/README.md", "docs/validation/viscoelastic.md"])
def test_it_is_listed(page: str) -> None:
    text = (ROOT / page).read_text()
    assert [case.name for case in CASES if case.name not in text] == []
