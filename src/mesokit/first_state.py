"""The state that a case starts from; `check` and `run` refuse the same here."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from mesokit.component import show
from mesokit.errors import CaseError
from mesokit.io import checkpoint
from mesokit.io.run_directory import RunDirectory
from mesokit.io.snapshot_file import read_snapshot
from mesokit.mpcd.initial import read_arrays
from mesokit.mpcd.snapshot import fitted

if TYPE_CHECKING:
    from mesokit.case import Case


def first_state(case: Case, positions: Any = None, velocities: Any = None) -> tuple[Any, Any]:
    """Positions and velocities (n, d) to start from: given, or those that the case names.

    None stands for what is to be drawn. Raises CaseError for arrays that do not fit the case, and
    for files and runs that cannot be read.
    """
    return read_arrays(case, positions, velocities, run=_last_state, file=_from_file)


def _from_file(case: Case, path: str) -> tuple[Any, Any]:
    """Positions and velocities, by particle id, of a file that another program has written."""
    return fitted(case, read_snapshot(path))


def _last_state(case: Case, path: str) -> tuple[Any, Any]:
    """Positions and velocities, by particle id, of the last checkpoint of an earlier run.

    Raises CaseError unless that run has the box and the species of the case.
    """
    from mesokit.case import Case
    from mesokit.execute.cpu import CPU

    directory = RunDirectory.existing(path)
    earlier = Case.from_toml(directory.case_file)
    for what, there, here in (
        ("a box of", list(earlier.box.size), list(case.box.size)),
        ("particles of (mass, number)", _kinds(earlier), _kinds(case)),
    ):
        if there != here:
            raise CaseError(f"that run has {what} {show(there)}, this case {show(here)}")
    arrays, _ = checkpoint.read(directory.checkpoint_file)
    fluid = CPU(earlier)
    fluid.restore(part(arrays, "fluid/"))
    return fluid.whole_positions(), fluid.velocities()


def _kinds(case: Case) -> list[tuple[float, int]]:
    """Mass and number of each kind of particles."""
    fluid = case.fluid
    return [(kind.mass, round(kind.density * case.box.volume)) for kind in fluid.species] or [
        (fluid.mass, case.particles)
    ]


def part(arrays: dict[str, Any], start: str) -> dict[str, Any]:
    """The arrays whose names start so, without it."""
    return {key[len(start) :]: v for key, v in arrays.items() if key.startswith(start)}
