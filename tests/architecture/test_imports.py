"""Who may import whom, so that physics, execution, files and theory stay apart."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[2] / "src" / "mesokit"
FILES = sorted(SOURCE.rglob("*.py"))

# folder: the only modules of mesokit that it may import
ONLY = {
    "theory": ("mesokit.theory",),
    "statistics": ("mesokit.statistics",),
}
# folder: modules that it must not import
PHYSICS_AVOIDS = (
    "mesokit.io",
    "mesokit.execute",
    "mesokit.domain",
    "mesokit.report",
    "mesokit.observe",
    "mesokit.simulation",
    "mesokit.cli",
    "h5py",
    "matplotlib",
    "numba.cuda",
    "mpi4py",
)
NOT = {
    "mpcd": PHYSICS_AVOIDS,
    "geometry": PHYSICS_AVOIDS,
    "potential": PHYSICS_AVOIDS,
    "observe": ("mesokit.execute", "mesokit.domain", "h5py", "mpi4py"),
    "execute": ("mesokit.io", "mesokit.report", "mesokit.observe", "mesokit.cli", "h5py"),
}
# module: the only places in the package that import it, at most one once a backend exists
HOMES = {
    "h5py": ("io/",),
    "gsd": ("io/",),
    "MDAnalysis": ("io/",),
    "mpi4py": (),
    "numba.cuda": (),
}


def imports(path: Path) -> Iterator[str]:
    """Every module that a file imports at run time, also inside functions."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for_types = {
        id(inner)
        for node in ast.walk(tree)
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test)
        for inner in ast.walk(node)
    }
    package = ["mesokit", *path.relative_to(SOURCE).with_suffix("").parts]
    for node in ast.walk(tree):
        if id(node) in for_types:
            continue
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            start = package[: -node.level] if node.level else []
            module = ".".join([*start, *([node.module] if node.module else [])])
            yield module
            yield from (f"{module}.{alias.name}" for alias in node.names)
        elif isinstance(node, ast.Attribute) and ast.unparse(node) == "numba.cuda":
            yield "numba.cuda"


def within(name: str, modules: tuple[str, ...]) -> bool:
    """Whether a module is one of the modules or inside one."""
    return any(name == m or name.startswith(f"{m}.") for m in modules)


def folder(path: Path) -> str:
    return path.relative_to(SOURCE).parts[0]


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(SOURCE)))
def test_a_file_imports_only_what_it_may(path: Path) -> None:
    found = set(imports(path))
    where = path.relative_to(SOURCE).as_posix()
    forbidden = {n for n in found if within(n, NOT.get(folder(path), ()))}
    if folder(path) in ONLY:
        own = {n for n in found if within(n, ("mesokit",))} - {"mesokit"}
        forbidden |= {n for n in own if not within(n, ONLY[folder(path)])}
    for module, homes in HOMES.items():
        if not where.startswith(homes):
            forbidden |= {n for n in found if within(n, (module,))}
    assert not forbidden


def test_the_rules_see_what_they_should() -> None:
    assert len(FILES) > 50
    assert "numpy" in set(imports(SOURCE / "theory" / "couette.py"))
    everything = {name for path in FILES for name in imports(path)}
    assert "h5py" in everything


@pytest.mark.parametrize(
    "arguments", [["--help"], ["new", "--help"], ["theory"], ["check", "case.toml"]]
)
def test_quick_commands_load_nothing_heavy(arguments: list[str], tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text("[run]\nsteps = 10\n[box]\nsize = [10, 10]\n")
    program = (
        "import sys; from mesokit.cli import main\n"
        f"try: main({arguments!r})\n"
        "except SystemExit as end: assert not end.code, end.code\n"
        "print(*sys.modules, file=sys.stderr)"
    )
    done = subprocess.run(
        [sys.executable, "-c", program],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": str(SOURCE.parent)},
        capture_output=True,
        text=True,
        check=True,
    )
    loaded = set(done.stderr.split())
    assert not loaded & {"h5py", "matplotlib", "mesokit.simulation", "MDAnalysis"}


def test_all_public_names_exist() -> None:
    import mesokit

    for name in mesokit.__all__:
        assert getattr(mesokit, name) is not None
    assert set(mesokit.__all__) == set(mesokit._HOME) | {"theory"}
