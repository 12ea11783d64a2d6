"""Arguments of a simulation: a case or its parts, arrays to start from, threads, ranks."""

import hashlib
import numbers
import os
import platform
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case import methods
from mesokit.case.case import Case, method_named
from mesokit.case.component import nearest, show
from mesokit.devices.device import Device
from mesokit.devices.named import opened, require_name
from mesokit.devices.names import CPU
from mesokit.errors import CaseError
from mesokit.processes.cores import usable_cores, which_cores
from mesokit.processes.world import World
from mesokit.run.callbacks import Callbacks
from mesokit.seam.method import method_of, on_devices

MOST_THREADS = 1024
PIECE = 2**18  # rows


def case_and_arrays(given: Any, parts: dict[str, Any]) -> tuple[Case, dict[str, Any]]:
    """The case, made of its parts if none is given, and arrays of its first state."""
    if isinstance(given, str | os.PathLike):
        given = Case.from_toml(Path(given))
    if given is not None and not isinstance(given, Case):
        text = f"Simulation: case = {show(given)}: expected a case, or the path of its file"
        raise CaseError(text)
    name = method_named(parts.get("run")) if given is None else given.run.method
    known = methods.load(name).initial.arrays
    arrays = {name: parts.pop(name) for name in known if name in parts}
    if (given is None) == (not parts):
        key = next(iter(parts), None)
        hint = f", not {key}{nearest(key, known)}" if key else ""
        raise CaseError(f"Simulation: expected a case, or its parts by name{hint}")
    return given or Case(**parts), {k: array for k, array in arrays.items() if array is not None}


def threads_of(given: Any, here: World, case: Case) -> int:
    """The given number, or one for each core that makes the case faster; ranks on the same cores
    share them."""
    if given is None:
        own = platform.node(), which_cores()
        cores = max(1, usable_cores() // here.gathered(own).count(own))
        most = method_of(case).most_threads
        return cores if most is None else min(cores, most(case))
    whole = isinstance(given, numbers.Integral) and not isinstance(given, bool)
    if whole and 1 <= int(given) <= MOST_THREADS:
        return int(given)
    raise CaseError(f"threads = {show(given)}: expected a whole number from 1 to {MOST_THREADS}")


def device_of(given: Any, case: Case, ranks: int) -> Device | None:
    """The device of a name, None for the threads of a processor.

    Raises CaseError where the case cannot run on it, RunError where there is none.
    """
    if require_name(given) == CPU:
        return None
    on_devices(case, given, ranks)
    return opened(given)


def require_ranks(case: Case, ranks: int) -> None:
    """Raise CaseError for a case that so many ranks cannot run."""
    if ranks == 1:
        return
    if case.run.replicas > 1:
        raise CaseError(f"run.replicas = {case.run.replicas}: not on {ranks} ranks; expected 1")
    check = method_of(case).check_ranks
    if check is None:
        raise CaseError(f"run.method = {show(case.run.method)}: not on {ranks} ranks; expected one")
    check(case, ranks)


def given_facts(case: Case, callbacks: Callbacks, arrays: Mapping[str, Any]) -> dict[str, str]:
    """The arguments as texts, which must be the same on all ranks."""
    calls = ", ".join(str(each.steps) for each in callbacks.given)
    return {"case": case.to_toml(), "steps of callbacks": f"[{calls}]"} | {
        name: _digest(np.asarray(array)) for name, array in arrays.items()
    }


def _digest(array: NDArray[Any]) -> str:
    """A fingerprint, computed in pieces because memory may not have room for a copy."""
    found, rows = hashlib.sha256(), np.atleast_1d(array)
    for first in range(0, len(rows), PIECE):
        found.update(rows[first : first + PIECE].tobytes())
    return found.hexdigest()
