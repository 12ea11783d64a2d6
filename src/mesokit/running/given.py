"""What a simulation is given: a case or its parts, arrays to start from, threads."""

from __future__ import annotations

import numbers
import os
from pathlib import Path
from typing import Any

from mesokit import method as methods
from mesokit.case.case import Case, method_named
from mesokit.case.component import nearest, show
from mesokit.errors import CaseError
from mesokit.running.cores import usable_cores

CALL_SECONDS = 0.2  # of compiled code at a time, so that Ctrl-C and the progress bar are prompt
MOST_THREADS = 1024


def case_and_arrays(given: Any, parts: dict[str, Any]) -> tuple[Case, dict[str, Any]]:
    """The case, made of its parts if none is given, and the arrays among these to start from."""
    if isinstance(given, str | os.PathLike):
        given = Case.from_toml(Path(given))
    if given is not None and not isinstance(given, Case):
        raise CaseError(
            f"Simulation: case = {show(given)}: expected a case, or the path of its file"
        )
    name = method_named(parts.get("run")) if given is None else given.run.method
    known = methods.load(name).arrays
    arrays = {name: parts.pop(name) for name in known if name in parts}
    if (given is None) == (not parts):
        key = next(iter(parts), None)
        hint = f", not {key}{nearest(key, known)}" if key else ""
        raise CaseError(f"Simulation: expected a case, or its parts by name{hint}")
    arrays = {name: array for name, array in arrays.items() if array is not None}
    return given or Case(**parts), arrays


def threads_of(given: Any) -> int:
    """So many as said, or one for each core."""
    if given is None:
        return usable_cores()
    whole = isinstance(given, numbers.Integral) and not isinstance(given, bool)
    if whole and 1 <= int(given) <= MOST_THREADS:
        return int(given)
    raise CaseError(f"threads = {show(given)}: expected a whole number from 1 to {MOST_THREADS}")


def next_chunk(steps: int, seconds: float) -> int:
    """So many steps that the next call takes CALL_SECONDS, growing at most fourfold at a time."""
    return max(1, min(4 * steps, int(steps * CALL_SECONDS / max(seconds, 1e-9))))
