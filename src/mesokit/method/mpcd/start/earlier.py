"""The last state of an earlier run, from which another one may start."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.io import checkpoint
from mesokit.io.arrays_file import LARGE
from mesokit.io.run_directory import RunDirectory

if TYPE_CHECKING:
    from mesokit.method.mpcd.engine.cpu.numbers import Numbers


def last_of_run(
    case: Case, path: str, same: Callable[[Case], tuple[str, Any]]
) -> tuple[Numbers, dict[str, Any]]:
    """An earlier run and its last state, if its box and `same` are those of the case."""
    from mesokit.method.mpcd.engine.cpu.numbers import Numbers

    directory = RunDirectory.existing(path)
    earlier = Case.from_toml(directory.case_file)
    if earlier.run.method != case.run.method:
        raise CaseError(f"that is a run of method {show(earlier.run.method)}")
    (what, there), (_, here) = same(earlier), same(case)
    for name, one, other in (
        ("a box of", list(earlier.box.size), list(case.box.size)),
        (what, there, here),
    ):
        if one != other:
            raise CaseError(f"that run has {name} {show(one)}, this case {show(other)}")
    arrays, _ = checkpoint.read(directory.checkpoint_file, large=LARGE)
    return Numbers(earlier), checkpoint.part(arrays, "engine/")
