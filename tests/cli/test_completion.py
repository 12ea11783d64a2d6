"""What the shell offers, and what `mesokit new` starts from."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.shell_completion import ShellComplete

from mesokit import Case
from mesokit.cli import main
from mesokit.cli.commands import cli
from mesokit.cli.reference import EXAMPLES, KNOWN, STUDIES, TEMPLATES

ROOT = Path(__file__).parents[2]
CASE = """
[run]
steps = 10
[box]
size = [9, 9]
[fluid]
collision = { rule = "srd" }
[[wall]]
shape = "plates"
axis = "y"
[[observe]]
quantity = "velocity-profile"
"""


def offered(*words: str) -> list[str]:
    *before, begun = words
    shell = ShellComplete(cli, {}, "mesokit", "_MESOKIT_COMPLETE")
    return [item.value for item in shell.get_completions(before, begun)]


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def new(*words: str) -> None:
    with pytest.raises(SystemExit) as finish:
        main(["new", *words])
    assert not finish.value.code


def test_pictures_and_templates() -> None:
    assert offered("plot", "run", "--kind", "s") == ["streamlines", "speed", "sites", "space-time"]
    assert offered("animate", "run", "--kind", "vo") == ["vorticity"]
    templates = ["poiseuille", "phase_separation"]
    examples = sorted(file.stem for file in (ROOT / "examples").glob("p*.toml"))
    names = [*templates, *(name for name in examples if name not in templates)]
    assert offered("new", "p") == offered("new", "x", "--template", "p") == names


def test_keys_of_a_case(here: Path) -> None:
    (here / "a.toml").write_text(CASE)
    assert offered("run", "a.toml", "--set", "fluid.de") == ["fluid.density="]
    assert "fluid.collision.angle=" in offered("check", "a.toml", "--set", "fluid.collision.")
    walls = offered("run", "a.toml", "--set", "wall.1.")
    assert "wall.1.axis=" in walls and not any("observe" in key for key in walls)
    assert "observe.velocity-profile.every=" in offered("run", "a.toml", "--set", "observe.vel")
    assert offered("run", "a.toml", "--set", "fluid.density=") == []
    assert offered("run", "nowhere.toml", "--set", "fluid.") == []
    assert offered("run", "--set", "fluid.") == []


def test_what_is_offered_can_be_set(here: Path) -> None:
    """Every key is one of the case: what is refused is the value."""
    (here / "a.toml").write_text(CASE)
    found = [key for start in ("fluid.", "run.", "box.", "wall.1.", "observe.velocity-profile.")
             for key in offered("run", "a.toml", "--set", start)]  # fmt: skip
    assert len(found) > 20
    for key in found:
        with pytest.raises(Exception, match=r"\S") as refused:
            Case.from_toml(here / "a.toml", {key.rstrip("="): "{ no = 'value' }"})
        last = key.rstrip("=").rpartition(".")[2]
        assert f"{last}: unknown key" not in str(refused.value)


@pytest.mark.parametrize("name", [*EXAMPLES][::6])
def test_examples_are_templates(name: str, here: Path) -> None:
    new("mine", "--template", name)
    made = Case.from_toml(here / "mine.toml")
    assert not made.missing_files()
    text = (here / "mine.toml").read_text("utf-8")
    stem = name.rpartition("/")[2]
    assert "mesokit run mine.toml" in text and f"mesokit run {stem}" not in text
    assert made.title == Case.from_toml(ROOT / "examples" / f"{name}.toml").title


def test_names_are_of_one_case_each() -> None:
    """`mesokit new` takes templates, examples and studies by name."""
    assert TEMPLATES and len(KNOWN) == len(TEMPLATES) + len(EXAMPLES) + len(STUDIES)


@pytest.mark.parametrize("name", [*EXAMPLES])
def test_examples_are_run_where_they_stand(name: str) -> None:
    """`mesokit new` looks for these words, and writes them for the new file."""
    text = (ROOT / "examples" / f"{name}.toml").read_text("utf-8")
    assert f"mesokit run {name.rpartition('/')[2]}.toml" in text


def test_a_picture_of_solids_comes_along(here: Path) -> None:
    new("junction")
    assert (here / "junction.png").read_bytes() == (ROOT / "examples/junction.png").read_bytes()
    new("viscoelastic/fig_4_1")
    assert (here / "fig_4_1.toml").exists() and "viscoelastic/fig_4_1" in KNOWN
