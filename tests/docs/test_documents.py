"""Everything that the README and the guide tell users to type works."""

import contextlib
import importlib.util
import io
import json
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from mesokit import Case
from mesokit.cli import main
from mesokit.seam.method import method_of
from mesokit.study.local import Here

ROOT = Path(__file__).resolve().parents[2]
GUIDE = re.findall(r"^- .*\]\((.*)\)", (ROOT / "docs/guide/index.md").read_text(), re.MULTILINE)
PAGES = [
    "README.md",
    "docs/guide/index.md",
    *(f"docs/guide/{page}" for page in GUIDE),
    "docs/studies.md",
    "docs/own.md",
    "docs/methods/brownian.md",
    "docs/methods/event_driven.md",
    "docs/methods/flock.md",
    "docs/methods/kinetic_monte_carlo.md",
    "docs/methods/mpcd.md",
    "docs/methods/soft_spheres.md",
    "docs/methods/spheres.md",
    "docs/methods/which_method.md",
]
SHORT = ["--set", "run.steps=40", "--set", "run.warmup=10"]


def blocks(page: str, language: str) -> list[str]:
    """Fences one after the other: the end of one must not pass for the start of another."""
    text = (ROOT / page).read_text()
    fences = re.findall(r"^```([^\n]*)\n(.*?)^```[ \t]*$", text, re.DOTALL | re.MULTILINE)
    return [block for name, block in fences if name.strip() == language]


def commands(page: str) -> list[str]:
    lines = "\n".join(blocks(page, "")).splitlines()
    return [line.split("#")[0].strip() for line in lines if line.strip()]


CASES = [(page, i) for page in PAGES for i in range(len(blocks(page, "toml")))]


@pytest.mark.parametrize(("page", "number"), CASES)
def test_every_case_is_valid(page: str, number: int, tmp_path: Path) -> None:
    file = tmp_path / "case.toml"
    file.write_text(blocks(page, "toml")[number])
    case = Case.from_toml(file)
    assert case.run.steps > 0
    warned = method_of(case).summary(case, 1).warnings
    assert not [text for text in warned if "average over the start" in text]


@pytest.fixture(scope="session")
def workplace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("documents")


@pytest.mark.long
@pytest.mark.parametrize("page", [page for page in PAGES if page != "docs/own.md"])
def test_commands_and_scripts_run_in_order(
    page: str, workplace: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # tests/study has studies in processes of their own, whose start is most of their time here
    monkeypatch.setattr(
        "mesokit.study.study.Processes", lambda jobs, threads, parts, device: Here(threads, device)
    )
    if page == "docs/studies.md":  # other pages have the figures of a run
        monkeypatch.setattr("mesokit.report.save_all", lambda *given, **more: [])
    if not (workplace / "poiseuille.toml").exists():
        run("mesokit new poiseuille", workplace)
    if not (workplace / "poiseuille").exists():  # which all pages go on from
        run("mesokit run poiseuille.toml", workplace)
    for command in commands(page):
        if command.startswith("mesokit run"):
            folder = re.search(r"--output (\S+)", command)
            if (workplace / (folder[1] if folder else "poiseuille")).exists():
                command = f"{command} --overwrite"
        if command.startswith("mesokit") and not (
            command == "mesokit new poiseuille" and (workplace / "poiseuille.toml").exists()
        ):
            run(command, workplace)
    with contextlib.chdir(workplace), contextlib.redirect_stdout(io.StringIO()):
        for script in blocks(page, "python"):
            exec(compile(script, script.splitlines()[0], "exec"), {"__name__": "__main__"})


@pytest.mark.long
def test_parts_of_a_page_in_a_process_of_their_own(tmp_path: Path) -> None:
    """They would be known to all other tests."""
    run("mesokit new poiseuille", tmp_path)
    run("mesokit run poiseuille.toml", tmp_path)
    for command in commands("docs/own.md"):
        run(command, tmp_path)
    done = subprocess.run(
        [sys.executable, "-c", ONE_AFTER_THE_OTHER],
        cwd=tmp_path, input=json.dumps(blocks("docs/own.md", "python")), capture_output=True,
        text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr


# scripts of a page, each with names of its own, in one process: most of the time is its start
ONE_AFTER_THE_OTHER = """
import json, sys
sys.path.insert(0, "")
for script in json.load(sys.stdin):
    exec(compile(script, script.splitlines()[0], "exec"), {"__name__": "__main__"})
"""


def test_films_of_the_front_page_are_made_from_examples() -> None:
    """By one command, and small enough for a repository."""
    spec = importlib.util.spec_from_file_location("films", ROOT / "docs" / "generate" / "films.py")
    assert spec is not None and spec.loader is not None
    films = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(films)
    shown = re.findall(r"images/film-(\w+)\.gif", (ROOT / "README.md").read_text())
    assert sorted(shown) == sorted(films.FILMS)
    for name, film in films.FILMS.items():
        Case.from_toml(ROOT / "examples" / f"{film.example}.toml", film.settings)
        assert (ROOT / "docs" / "images" / f"film-{name}.gif").stat().st_size < films.LARGEST


def test_make_targets_exist() -> None:
    makefile = (ROOT / "Makefile").read_text()
    for page in PAGES:
        for command in commands(page):
            if command.startswith("make "):
                assert f"\n{command.split()[1]}:" in makefile


def test_links_lead_somewhere() -> None:
    files = [p for name in (".", "inside") for p in (ROOT / "docs" / name).glob("*.md")]
    for page in {*PAGES, *(p.relative_to(ROOT).as_posix() for p in files)}:
        for link in re.findall(r"\]\(([^)#]+)\)", (ROOT / page).read_text()):
            if "://" not in link:
                assert ((ROOT / page).parent / link).exists(), f"{page}: {link}"


def run(command: str, folder: Path) -> None:
    """In this process: starting one for each command would take most of the time."""
    words = shlex.split(command)[1:]
    if words[0] == "run" or (words[0] == "study" and words[1].endswith(".toml")):
        words += SHORT
    said = io.StringIO()
    with (
        contextlib.chdir(folder),
        contextlib.redirect_stdout(said),
        contextlib.redirect_stderr(said),
        pytest.raises(SystemExit) as end,
    ):
        main(words)
    assert not end.value.code, f"{command}: {said.getvalue()}"
