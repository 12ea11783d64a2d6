"""What a process imports before it does anything: counted in modules, as time is the machine's."""

from __future__ import annotations

import os
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

from mesokit.case.registry import FAMILIES
from mesokit.cli.commands import COMMANDS, MODULES, cli

SOURCE = Path(__file__).parents[2] / "src"
BULK = SOURCE / "mesokit/method/mpcd/templates/bulk.toml"
LIBRARIES = {
    "numpy", "numba", "llvmlite", "scipy", "h5py", "matplotlib", "pydantic", "rich", "jinja2",
    "PIL", "MDAnalysis", "mpi4py",
}  # fmt: skip
RUN = """
import sys
from mesokit.cli import main
try:
    main()
except SystemExit as end:
    assert not end.code, end.code
"""


def started(program: str, *arguments: str, **environment: str) -> tuple[list[str], list[str]]:
    """The lines that a program prints in a new process, and the modules that this then has."""
    done = subprocess.run(
        [sys.executable, "-c", f"{program}\nprint('LOADED', *sys.modules)", *arguments],
        env=os.environ | {"PYTHONPATH": str(SOURCE)} | environment,
        capture_output=True,
        text=True,
        check=True,
    )
    printed, _, modules = done.stdout.rpartition("LOADED ")
    return printed.splitlines(), modules.split()


def loaded(program: str, *arguments: str) -> list[str]:
    """The modules of a new process after a program."""
    return started(program, *arguments)[1]


def of(package: str, modules: list[str]) -> set[str]:
    """The modules in a package, without its name."""
    return {name.removeprefix(f"{package}.") for name in modules if name.startswith(f"{package}.")}


def completing(line: str) -> dict[str, str]:
    """What a shell sets for the completion of the last word of a line."""
    number = str(len(line.split(" ")) - 1)
    return {"_MESOKIT_COMPLETE": "bash_complete", "COMP_WORDS": line, "COMP_CWORD": number}


def require_light(modules: list[str]) -> None:
    """No library of numbers, no part of a case, no method and no observable."""
    assert not LIBRARIES & set(modules)
    mine = of("mesokit", modules)
    mine.discard("method.spheres")  # a folder of methods: its templates are found by their places
    assert not [name for name in mine if name.startswith(("method.", "observe", "theory"))]
    assert not [name for name in mine if name.startswith(("scalar", "geometry", "loops"))]


def test_the_package_alone_loads_nothing() -> None:
    modules = loaded("import sys, mesokit")
    require_light(modules)
    assert of("mesokit", modules) == {"stub"}


@pytest.mark.parametrize(
    "arguments", [["--version"], ["--help"], *([c, "--help"] for c in COMMANDS)]
)
def test_help_loads_no_method(arguments: list[str]) -> None:
    modules = loaded(RUN, *arguments)
    require_light(modules)
    commands = of("mesokit.cli", modules) & MODULES.keys()
    every = {"--version": set(), "--help": {*MODULES}}
    assert commands == every.get(arguments[0], {COMMANDS.get(arguments[0])})


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_the_line_for_the_shell_loads_no_method(shell: str) -> None:
    printed, modules = started(RUN, _MESOKIT_COMPLETE=f"{shell}_source")
    assert any("_MESOKIT_COMPLETE" in line for line in printed)
    require_light(modules)


@pytest.mark.parametrize(
    ("line", "answer"),
    [
        ("mesokit r", "plain,resume"),
        ("mesokit run ", "file,"),
        ("mesokit run --th", "plain,--threads"),
        ("mesokit new bul", "plain,bulk"),
    ],
)
def test_completion_loads_no_method(line: str, answer: str) -> None:
    offered, modules = started(RUN, **completing(line))
    assert answer in offered
    require_light(modules)


def require_no_compiler(modules: list[str]) -> None:
    """No library beyond those of cases, and nothing of compiled code but the place for it."""
    assert LIBRARIES & set(modules) == {"numpy", "pydantic"}
    assert of("mesokit.kernels", modules) == {"later"}
    assert not of("mesokit.method.mpcd.engine", modules)


@pytest.mark.parametrize(
    "file",
    [
        "src/mesokit/method/mpcd/templates/couette.toml",
        "examples/chains_in_dimers.toml",
        "examples/phase_separation.toml",
        "examples/colloid.toml",
    ],
)
def test_no_case_of_a_fluid_needs_a_compiler_to_be_read(file: str) -> None:
    place = SOURCE.parent / file
    require_no_compiler(loaded(f"import sys, mesokit; mesokit.Case.from_toml({str(place)!r})"))


def test_completion_of_a_key_reads_the_case_and_no_more() -> None:
    offered, modules = started(RUN, **completing(f"mesokit run {BULK} --set fluid.den"))
    assert "plain,fluid.density=" in offered
    require_no_compiler(modules)


def test_a_case_loads_what_it_names() -> None:
    modules = loaded(f"import sys, mesokit; mesokit.Case.from_toml({str(BULK)!r})")
    require_no_compiler(modules)
    assert "click" not in modules
    mine = of("mesokit", modules)
    assert not [name for name in mine if name.startswith(("io", "report", "cli"))]
    assert {name.partition(".")[0] for name in of("mesokit.method", modules)} == {"mpcd"}
    of_several, of_fluids = (
        of("mesokit.observe", modules),
        of("mesokit.method.mpcd.observe", modules),
    )
    observables = {name for name in of_several | of_fluids if "shared" not in name}
    assert observables == {"conservation", "transverse_modes", "mean_square_displacement"}
    for folder, parts in (
        ("collision", {"protocol", "srd", "rotation"}),
        ("thermostat", {"protocol", "none"}),
        ("field", {"protocol", "none"}),
    ):
        assert of(f"mesokit.method.mpcd.{folder}", modules) == parts
    assert not of("mesokit.potential", modules) - {"protocol", "thermal", "several"}


def test_every_command_is_in_the_module_that_the_table_says() -> None:
    for module, commands in MODULES.items():
        import_module(f"mesokit.cli.{module}")
        for command in commands:
            callback = cli.commands[command].callback
            assert callback is not None and callback.__module__ == f"mesokit.cli.{module}"
    assert cli.commands.keys() == COMMANDS.keys()


@pytest.mark.parametrize(
    ("base", "name"),
    [
        ("mesokit.potential.Bond", "fene"),
        ("mesokit.potential.Bond", "spring"),  # in a file with another
        ("mesokit.method.spheres.common.start.SphereStart", "file"),  # in a file of another name
        ("mesokit.method.spheres.common.observe.Observable", "contact-clusters"),
        ("mesokit.geometry.shape.Wall", "half-space"),
    ],
)
def test_a_part_is_found_before_all_are_loaded(base: str, name: str) -> None:
    program = (
        f"import sys, {base.rpartition('.')[0]}\n"
        "from mesokit.case.registry import FAMILIES\n"
        f"assert FAMILIES[{base}].find({name!r}).__name__"
    )
    assert loaded(program)


def test_parts_are_listed_by_name_whatever_came_first() -> None:
    for family in list(FAMILIES.values()):
        parts = family.parts.items()
        for package in family.packages:
            names = [name for name, part in parts if part.__module__.startswith(f"{package}.")]
            assert names == sorted(names)
