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
ROOT = "mesokit"
PARTS = {path: [ROOT, *path.relative_to(SOURCE).with_suffix("").parts] for path in FILES}
MODULES = {".".join(parts).removesuffix(".__init__"): path for path, parts in PARTS.items()}

# Files or folders, the longest name that fits decides: which modules of mesokit they may import, at
# run time, inside functions or for type hints. "=" before a name: that module, not what is in it.
MPCD = (
    "case", "errors", "geometry", "method.mpcd", "potential", "running.cores", "scalar",
    "statistics", "theory",
)  # fmt: skip
# type hints only, as the test of what is loaded shows
START = (*MPCD, "execute.cpu.numbers", "ranks.world")
ROWS = {
    "__init__.py": (),
    "__main__.py": ("cli",),
    "errors.py": (),
    "engine.py": (),
    "simulation.py": (
        "case", "errors", "io", "=method", "method.protocol", "observe.shared", "ranks", "report",
        "running",
    ),
    "ranks/": ("errors", "ranks"),
    "ranks/mpiexec.py": ("errors", "ranks", "running.signals"),
    "running/cores.py": (),
    "running/signals.py": (),
    "running/": (
        "case", "errors", "io", "=method", "method.protocol", "observe.shared", "ranks", "report",
        "running",
    ),
    "scalar/": ("scalar",),
    "theory/": ("theory",),
    "statistics/": ("statistics",),
    "case/": ("case", "errors", "=method", "scalar", "theory"),
    "geometry/": ("case", "errors", "geometry", "scalar"),
    "potential/": ("case", "errors", "potential", "scalar", "theory"),
    "spheres/": ("case", "errors", "geometry", "scalar", "spheres"),
    "spheres/cost.py": ("case", "spheres", "theory"),
    "spheres/velocity_memory.py": ("case", "engine", "errors", "spheres"),
    "spheres/expected/": ("case", "errors", "geometry", "spheres", "theory"),
    "spheres/start/random.py": ("case", "method.event_driven.grow", "spheres"),
    "spheres/start/poured.py": ("case", "errors", "method.soft_spheres.settle", "spheres"),
    "spheres/start/from_file.py": ("case", "errors", "io.snapshot_file", "spheres"),
    "spheres/start/from_run.py": ("case", "errors", "io.earlier_spheres", "spheres"),
    "method/__init__.py": (),
    "method/protocol.py": ("case", "engine", "=method", "running.cores"),
    "method/mpcd/": MPCD,
    "method/mpcd/columns.py": (*MPCD, "method.protocol"),
    "method/mpcd/summary.py": (*MPCD, "method.protocol"),
    "method/mpcd/start/": START,
    "method/mpcd/start/first_state.py": (*MPCD, "execute", "io", "ranks"),
    "method/mpcd/method.py": (
        *MPCD, "engine", "execute", "io", "method.protocol", "observe", "ranks",
    ),
    "method/event_driven/": (
        "case", "engine", "errors", "geometry", "method.event_driven", "method.protocol",
        "observe", "scalar", "spheres", "statistics", "theory",
    ),
    "method/flock/": (
        "case", "engine", "errors", "execute.cpu.threads", "geometry", "io", "method.flock",
        "method.protocol", "observe", "running.cores", "scalar", "statistics", "theory",
    ),
    "method/soft_spheres/": (
        "case", "engine", "errors", "execute.cells", "execute.cpu.strips.layout",
        "execute.cpu.threads", "geometry", "method.protocol", "method.soft_spheres", "observe",
        "potential", "running.cores", "scalar", "spheres", "statistics", "theory",
    ),
    "method/brownian/": (
        "case", "engine", "errors", "method.brownian", "method.protocol", "observe",
        "running.cores", "scalar", "statistics",
    ),
    "execute/": ("case", "errors", "execute", "geometry", "method.mpcd", "potential", "scalar"),
    "observe/": (
        "case", "engine", "errors", "geometry", "method.mpcd", "method.protocol", "observe",
        "statistics", "theory",
    ),
    "io/": (
        "case", "errors", "geometry", "io", "method.protocol", "observe.shared.named",
        "observe.shared.pooled", "observe.shared.result",
    ),
    "io/open.py": (
        "case", "errors", "io", "method.protocol", "observe.shared.named", "observe.shared.result",
        "report",
    ),
    "report/": ("case", "errors", "geometry", "io", "method.protocol", "observe", "report"),
    "report/flow/state.py": ("case", "method.protocol"),
    "report/flow/moving_plates.py": ("case", "report", "spheres.wall"),
    "report/flow/shaded.py": ("report", "kernels.kernel"),
    "study/": (
        "case", "errors", "io", "method.protocol", "observe.shared", "ranks", "report", "running",
        "simulation", "statistics", "study",
    ),
    "cli/": (
        "case", "cli", "errors", "io", "=method", "method.protocol", "ranks", "report", "running",
        "simulation", "study",
    ),
    "cli/theory.py": ("case", "cli", "errors", "method.mpcd.fluid", "report", "theory"),
    "cli/chains.py": ("case", "errors", "theory"),
    "cli/chain_figures.py": ("cli", "errors", "report", "theory"),
}  # fmt: skip
ROWS["kernels/"] = ("kernels",)
for _place, _row in ROWS.items():  # what is written as scalar functions is compiled
    ROWS[_place] = (*_row, "kernels") if {"scalar", "method.mpcd"} & set(_row) else _row
# what loads modules by names that are data: public names, methods, parts, figures, options
BY_NAME = {
    "__init__.py", "method/__init__.py", "case/registry.py", "case/outside.py",
    "case/describe/shown.py", "observe/shared/result.py", "io/optional.py", "study/work.py",
    "geometry/shape/mesh.py", "cli/commands.py",
}  # fmt: skip
MOST_FILES = 16  # in a folder of machinery; of laws, quantities and pictures there may be more
LONG = ("theory", "observe", "report/flow", "io")
# module: the only places in the package that import it, at most one once a backend exists
HOMES = {
    "h5py": ("io/",),
    "gsd": ("io/",),
    "MDAnalysis": ("io/",),
    "mpi4py": ("ranks/", "execute/ranks/"),
    "numba.cuda": (),
}


def imports(path: Path) -> Iterator[str]:
    """Every module that a file imports, also inside functions and for type hints."""
    package = ["mesokit", *path.relative_to(SOURCE).with_suffix("").parts]
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            start = package[: -node.level] if node.level else []
            module = ".".join([*start, *([node.module] if node.module else [])])
            yield module
            yield from (f"{module}.{alias.name}" for alias in node.names)
        elif isinstance(node, ast.Attribute) and ast.unparse(node) == "numba.cuda":
            yield "numba.cuda"


def needs(path: Path) -> set[str]:
    """The modules of mesokit that a file imports: those it takes names of, not their packages."""
    found = set(imports(path)) & MODULES.keys()
    return {m for m in found if not any(other.startswith(f"{m}.") for other in found)} - {ROOT}


def within(name: str, modules: tuple[str, ...]) -> bool:
    """Whether a module is one of the modules or inside one."""
    return any(name == m or name.startswith(f"{m}.") for m in modules)


def where(path: Path) -> str:
    return path.relative_to(SOURCE).as_posix()


def row(path: Path) -> tuple[str, ...]:
    """The rule for a file."""
    return ROWS[max((key for key in ROWS if where(path).startswith(key)), key=len)]


@pytest.mark.parametrize("path", FILES, ids=where)
def test_a_file_imports_only_what_it_may(path: Path) -> None:
    allowed = row(path)
    inside = tuple(f"{ROOT}.{name}" for name in allowed if not name.startswith("="))
    exactly = {f"{ROOT}.{name[1:]}" for name in allowed if name.startswith("=")}
    found = set(imports(path))
    forbidden = {name for name in needs(path) if not within(name, inside)} - exactly
    for module, homes in HOMES.items():
        if not where(path).startswith(homes):
            forbidden |= {name for name in found if within(name, (module,))}
    assert not forbidden


def test_every_rule_is_about_a_file() -> None:
    for key in ROWS:
        assert (SOURCE / key).exists(), key


def test_no_circle_of_imports() -> None:
    left = {name: needs(path) - {name} for name, path in MODULES.items()}
    while ends := [name for name, others in left.items() if not others & left.keys()]:
        for name in ends:
            del left[name]
    assert not left


def test_modules_are_loaded_by_name_in_few_places() -> None:
    calls = {where(path) for path in FILES if "import_module(" in path.read_text("utf-8")}
    assert calls == BY_NAME


def test_folders_are_small() -> None:
    assert len(list(SOURCE.glob("[a-z]*.py"))) <= 5
    for folder in {path.parent for path in FILES}:
        if not where(folder).startswith(LONG):
            assert len(list(folder.glob("[a-z]*.py"))) <= MOST_FILES, folder


def test_physics_loads_no_execution() -> None:
    physics = [
        module
        for module, path in MODULES.items()
        if where(path).startswith("method/mpcd/") and row(path) in (MPCD, START)
    ]
    program = f"import sys, {', '.join(physics)}; print(*sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", program],
        env=os.environ | {"PYTHONPATH": str(SOURCE.parent)},
        capture_output=True,
        text=True,
        check=True,
    )
    heavy = ("execute", "io", "report", "observe", "simulation", "cli", "engine")
    loaded = done.stdout.split()
    assert len(physics) > 40
    assert not [m for m in loaded if within(m, tuple(f"{ROOT}.{name}" for name in heavy))]
    assert not set(loaded) & {"h5py", "matplotlib"}


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
