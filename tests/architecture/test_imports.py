"""Which file may import which, so that physics, execution, files and theory stay apart."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[2] / "src" / "mesokit"
ROOT = "mesokit"
FILES = [path.relative_to(SOURCE).as_posix() for path in sorted(SOURCE.rglob("*.py"))]
MODULES = {
    f"{ROOT}.{name.removesuffix('.py').replace('/', '.')}".removesuffix(".__init__"): name
    for name in FILES
}

# Files or folders, the longest name that fits decides: which modules of mesokit they may import, at
# run time, inside functions or for type hints. "=" before a name: that module, not what is in it.
MPCD = (
    "case", "devices", "errors", "geometry", "kernels", "method.mpcd", "potential",
    "processes.cores", "scalar", "seam", "statistics", "theory",
)  # fmt: skip
# type hints only, as the test of what is loaded shows
START = (*MPCD, "processes.world")
ENGINE = (
    "case", "devices", "errors", "geometry", "loops", "method.mpcd", "potential", "scalar", "seam",
    "statistics",
)  # fmt: skip
SPHERES = (
    "case", "errors", "geometry", "loops", "method.spheres", "observe", "potential",
    "processes.cores", "scalar", "seam", "statistics", "theory",
)  # fmt: skip
ROWS = {
    "__init__.py": ("stub",),
    "__main__.py": ("cli",),
    "errors.py": (),
    "stub.py": (),
    "scalar/": ("scalar",),
    "kernels/": ("kernels",),
    "theory/": ("theory",),
    "theory/__init__.py": ("stub",),
    "statistics/": ("statistics",),
    "case/methods.py": ("errors",),
    "case/": ("case", "errors", "scalar", "theory"),
    "geometry/": ("case", "errors", "geometry", "scalar"),
    "potential/": ("case", "errors", "potential", "scalar", "theory"),
    "seam/": (
        "case", "devices.device", "errors", "geometry.region", "geometry.solids",
        "processes.cores", "seam", "statistics",
    ),
    "loops/": ("loops", "scalar"),
    "devices/": ("case.amounts", "case.component", "devices", "errors", "kernels", "stub"),
    "devices/names.py": (),
    "devices/records.py": ("devices.device", "scalar"),
    "processes/": ("errors", "processes"),
    "processes/cores.py": (),
    "processes/signals.py": (),
    "method/__init__.py": (),
    "method/mpcd/": MPCD,
    "method/mpcd/start/": START,
    "method/mpcd/start/earlier.py": (*START, "io"),
    "method/mpcd/start/known_bodies.py": (*START, "io"),
    "method/mpcd/start/first_state.py": (*MPCD, "io", "processes"),
    "method/mpcd/method.py": (*MPCD, "io", "observe", "processes"),
    "method/mpcd/engine/": ENGINE,
    "method/mpcd/engine/domains/messages/mpi.py": (*ENGINE, "processes.cores"),
    "method/mpcd/observe/": (*MPCD, "observe"),
    "method/spheres/": SPHERES,
    "method/spheres/hard/engine/system.py": (*SPHERES, "processes.signals"),
    "method/spheres/common/start/from_file.py": (
        *SPHERES, "io.earlier_spheres", "io.snapshot_file",
    ),
    "method/flock/": (
        "case", "errors", "geometry", "io", "loops", "method.flock", "observe", "processes.cores",
        "scalar", "seam", "statistics", "theory",
    ),
    "method/kinetic_monte_carlo/": (
        "case", "errors", "io", "kernels.kernel", "kernels.packing", "loops.threads",
        "method.kinetic_monte_carlo", "observe", "processes.signals", "scalar", "seam",
        "statistics", "theory",
    ),
    "method/brownian/": (
        "case", "errors", "method.brownian", "observe", "processes.cores", "scalar", "seam",
        "statistics",
    ),
    "observe/": ("case", "errors", "geometry", "observe", "seam", "statistics", "theory"),
    "io/": ("case", "errors", "geometry", "io", "seam"),
    "report/": ("case", "errors", "geometry", "io", "observe", "report", "seam"),
    "report/flow/state.py": ("case", "io.contact_records", "seam"),
    "report/flow/shaded.py": ("report", "kernels.kernel"),
    "report/flow/shaded_parts.py": ("geometry", "report", "kernels.kernel"),
    "run/": (
        "case", "devices", "errors", "io", "observe.shared", "processes", "report", "run", "seam",
    ),
    "run/loop.py": ("case", "kernels.kept", "processes", "report", "run", "seam"),
    "run/warm.py": ("case", "devices.names", "kernels", "run"),
    "study/": (
        "case", "devices.named", "devices.names", "errors", "io", "observe.shared", "processes",
        "report", "run", "seam", "statistics", "study",
    ),
    "cli/": (
        "case", "cli", "devices.named", "devices.names", "errors", "io", "processes", "report",
        "run", "seam", "study",
    ),
    "cli/compiled.py": (
        "case", "cli", "devices.names", "errors", "kernels", "processes", "run.warm",
    ),
    "cli/theory.py": ("case", "cli", "errors", "method.mpcd", "theory"),
}  # fmt: skip
for _place, _row in ROWS.items():  # what is written as scalar functions is compiled
    if "scalar" in _row and "kernels" not in _row:
        ROWS[_place] = (*_row, "kernels")
# what loads modules by names that are data: public names, methods, parts, figures, options
BY_NAME = {
    "__init__.py", "theory/__init__.py", "case/methods.py", "case/registry.py", "case/outside.py",
    "case/describe/shown.py", "seam/result.py", "io/optional.py", "study/work.py",
    "geometry/shape/mesh.py", "cli/commands.py", "kernels/made_of.py",
}  # fmt: skip
MOST_FILES = 16  # in a folder of machinery; of laws, shapes, quantities and pictures more
LONG = ("theory", "observe", "method/mpcd/observe", "report/flow", "io", "geometry/shape")
LONG += ("method/kinetic_monte_carlo/model", "method/kinetic_monte_carlo/observe")
LONG += ("method/spheres/common/observe",)
# module: the only places in the package that import it, at most one once a backend exists
HOMES = {
    "h5py": ("io/",),
    "gsd": ("io/",),
    "MDAnalysis": ("io/",),
    "mpi4py": ("processes/", "method/mpcd/engine/domains/"),
    "numba.cuda": ("devices/compile.py",),
    "cuda.bindings": ("devices/",),
}


def imports(name: str, nodes: Iterable[ast.AST]) -> Iterator[str]:
    """Every module that a file imports, also inside functions and for type hints."""
    package = [ROOT, *name.removesuffix(".py").split("/")]
    for node in nodes:
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            start = package[: -node.level] if node.level else []
            module = ".".join([*start, *([node.module] if node.module else [])])
            yield module
            yield from (f"{module}.{alias.name}" for alias in node.names)
        elif isinstance(node, ast.Attribute) and node.attr == "cuda":
            yield f"{ast.unparse(node.value)}.cuda"


@pytest.fixture(scope="module")
def imported(nodes: dict[str, list[ast.AST]]) -> dict[str, set[str]]:
    """What each file imports."""
    return {name: set(imports(name, of_file)) for name, of_file in nodes.items()}


def needs(found: set[str]) -> set[str]:
    """The modules of mesokit among imports: those of which names are taken, not their packages."""
    found = found & MODULES.keys()
    return {m for m in found if not any(other.startswith(f"{m}.") for other in found)} - {ROOT}


def within(name: str, modules: tuple[str, ...]) -> bool:
    """Whether a module is one of the modules or inside one."""
    return any(name == m or name.startswith(f"{m}.") for m in modules)


def row(name: str) -> tuple[str, ...]:
    """The rule for a file."""
    return ROWS[max((key for key in ROWS if name.startswith(key)), key=len)]


def forbidden(name: str, found: set[str]) -> set[str]:
    """What a file imports and may not."""
    allowed = row(name)
    inside = tuple(f"{ROOT}.{module}" for module in allowed if not module.startswith("="))
    exactly = {f"{ROOT}.{module[1:]}" for module in allowed if module.startswith("=")}
    bad = {module for module in needs(found) if not within(module, inside)} - exactly
    for module, homes in HOMES.items():
        if not name.startswith(homes):
            bad |= {used for used in found if within(used, (module,))}
    return bad


def test_files_import_only_what_they_may(imported: dict[str, set[str]]) -> None:
    found = {name: forbidden(name, modules) for name, modules in imported.items()}
    assert not {name: bad for name, bad in found.items() if bad}


def test_imports_that_are_forbidden_are_seen() -> None:
    text = "def f():\n    from ..run import opened\n    import h5py\nx = numba.cuda.grid"
    found = set(imports("theory/couette.py", ast.walk(ast.parse(text))))
    assert forbidden("theory/couette.py", found) == {"mesokit.run.opened", "h5py", "numba.cuda"}


def test_every_rule_is_about_a_file() -> None:
    for key in ROWS:
        assert (SOURCE / key).exists(), key


def test_the_types_of_numba_stay_the_same_module(nodes: dict[str, list[ast.AST]]) -> None:
    """`import numba.types` gives that name another module: kernels would not be known again."""
    for name, of_file in nodes.items():
        for node in of_file:
            named = [node.module] if isinstance(node, ast.ImportFrom) else []
            named += [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            assert "numba.types" not in named, name


def test_no_circle_of_imports(imported: dict[str, set[str]]) -> None:
    left = {module: needs(imported[name]) - {module} for module, name in MODULES.items()}
    while ends := [module for module, others in left.items() if not others & left.keys()]:
        for module in ends:
            del left[module]
    assert not left


def test_modules_are_loaded_by_name_in_few_places(texts: dict[str, str]) -> None:
    assert {name for name, text in texts.items() if "import_module(" in text} == BY_NAME


def test_folders_are_small() -> None:
    assert len(list(SOURCE.glob("[a-z]*.py"))) <= 5
    paths = [Path(name) for name in FILES]
    folders = Counter(path.parent.as_posix() for path in paths if path.name[0] != "_")
    few = {folder: n for folder, n in folders.items() if not folder.startswith(LONG)}
    assert not {folder: n for folder, n in few.items() if n > MOST_FILES}


def test_physics_loads_no_execution() -> None:
    physics = [
        module
        for module, name in MODULES.items()
        if name.startswith("method/mpcd/") and row(name) in (MPCD, START)
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


def test_the_rules_see_what_they_should(imported: dict[str, set[str]]) -> None:
    assert len(imported) > 50
    assert "numpy" in imported["theory/couette.py"]
    assert "h5py" in set().union(*imported.values())


def test_quick_commands_load_nothing_heavy(tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text("[run]\nsteps = 10\n[box]\nsize = [10, 10]\n")
    commands = [["--help"], ["new", "--help"], ["theory"], ["check", "case.toml"]]
    heavy = {"h5py", "matplotlib", "mesokit.run.simulation", "MDAnalysis"}
    program = (
        "import sys; from mesokit.cli import main\n"
        f"for command in {commands!r}:\n"
        "    try: main(command)\n"
        "    except SystemExit as end: assert not end.code, (command, end.code)\n"
        f"    print(*command, 'loads', *{heavy!r} & set(sys.modules), file=sys.stderr)"
    )
    done = subprocess.run(
        [sys.executable, "-c", program],
        cwd=tmp_path,
        # with a store of its own: to judge what is kept, a command imports what it was made of
        env=os.environ | {"PYTHONPATH": str(SOURCE.parent), "NUMBA_CACHE_DIR": str(tmp_path)},
        capture_output=True,
        text=True,
        check=True,
    )
    loaded = [line for line in done.stderr.splitlines() if " loads" in line]
    assert loaded == [" ".join(command) + " loads" for command in commands]


def test_all_public_names_exist() -> None:
    import mesokit

    for name in mesokit.__all__:
        assert getattr(mesokit, name) is not None
