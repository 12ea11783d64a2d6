"""What the project says of itself agrees: versions, folders, links."""

import re
import tomllib
from pathlib import Path

import mesokit

ROOT = Path(__file__).resolve().parents[2]
PAGES = ["CONTRIBUTING.md", "CODE_OF_CONDUCT.md", "docs/releasing.md"]


def text(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


def test_versions_agree() -> None:
    project = tomllib.loads(text("pyproject.toml"))["project"]
    assert project["dynamic"] == ["version"]  # written in the package alone
    assert f"\nversion: {mesokit.__version__}\n" in text("CITATION.cff")
    assert f"\nlicense: {project['license']}\n" in text("CITATION.cff")


def test_oldest_python_is_tested() -> None:
    oldest = tomllib.loads(text("pyproject.toml"))["project"]["requires-python"].removeprefix(">=")
    assert f'python: ["{oldest}", ' in text(".github/workflows/ci.yml")


def test_every_python_gets_wheels_with_its_parts() -> None:
    project = tomllib.loads(text("pyproject.toml"))["project"]
    pythons = re.findall(r"Python :: (3\.\d+)", " ".join(project["classifiers"]))
    assert f"python: {pythons}".replace("'", '"') in text(".github/workflows/release.yml")


def test_every_folder_of_tests_is_described() -> None:
    described = set(re.findall(r"`tests/(\w+)`", text("CONTRIBUTING.md").split("## Tests")[1]))
    there = {folder.name for folder in (ROOT / "tests").iterdir() if any(folder.glob("*.py"))}
    assert described == there


def test_files_and_commands_that_are_named_exist() -> None:
    for page in PAGES:
        for name in re.findall(r"`((?:src|tests|docs|\.github)/[\w./-]*)`", text(page)):
            assert (ROOT / name).exists(), f"{page}: {name}"
        for link in re.findall(r"\]\(([^)#]+)\)", text(page)):
            assert "://" in link or (ROOT / page).parent.joinpath(link).exists(), f"{page}: {link}"
        for target in re.findall(r"`?make ([a-z-]+)[ `]", text(page)):
            assert f"\n{target}:" in text("Makefile"), f"{page}: make {target}"


def test_files_that_pages_for_developers_name_exist() -> None:
    """Below the package, below the repository, or somewhere in the package by the name alone."""
    there = [path.relative_to(ROOT).as_posix() for path in ROOT.glob("src/**/*.py")]
    there += [path.relative_to(ROOT).as_posix() for path in ROOT.glob("tests/**/*.py")]
    inside = sorted(f"docs/inside/{path.name}" for path in (ROOT / "docs" / "inside").glob("*.md"))
    for page in ["docs/architecture.md", *inside]:
        for name in re.findall(r"`([\w/]+\.py)`", text(page)):
            assert any(f"/{file}".endswith(f"/{name}") for file in there), f"{page}: {name}"


def test_architecture_is_a_short_page() -> None:
    assert len(text("docs/architecture.md").splitlines()) <= 150


def test_every_document_is_on_the_site() -> None:
    pages = text("mkdocs.yml")
    for folder in (".", "guide", "inside"):
        for path in (ROOT / "docs" / folder).glob("*.md"):
            page = path.relative_to(ROOT / "docs").as_posix()
            assert f": {page}\n" in pages or f"- {page}\n" in pages, page


def test_the_guide_lists_its_pages_in_the_order_of_the_site() -> None:
    listed = re.findall(r"^- \[(.*)\]\((.*)\)$", text("docs/guide/index.md"), re.MULTILINE)
    on_site = re.findall(r"- \"?([^\n\"]*)\"?: guide/(.*)$", text("mkdocs.yml"), re.MULTILINE)
    assert listed == on_site
    assert {page for _, page in listed} == {
        path.name for path in (ROOT / "docs" / "guide").glob("*.md") if path.stem != "index"
    }
