"""Warnings of all methods: runs that leave nothing, or more than the machine can hold."""

import dataclasses
import os
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from mesokit.case.amounts import size_text
from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import CaseError


def run_warnings(case: Case, memory: int, trajectory: int) -> Iterator[str]:
    """Warnings before a run that takes so many bytes of memory and of disk."""
    run = case.run
    if not case.observe and case.trajectory is None:
        yield "no [[observe]] and no [trajectory]: the run will leave nothing but its last state"
    for i, observable in enumerate(case.observe):
        if observable.every > run.steps:
            samples = "no sample" if observable.measures else "one sample, of the start"
            yield (
                f"observe[#{i + 1}].every = {observable.every}: more than run.steps = {run.steps}; "
                f"{observable.label} takes {samples}"
            )
        else:
            longest = getattr(observable, "max_lag", None)
            defaults = {field.name: field.default for field in dataclasses.fields(observable)}
            usual = getattr(defaults.get("max_lag"), "default", defaults.get("max_lag"))
            if longest is not None and longest != usual and longest > run.steps:
                yield (
                    f"observe[#{i + 1}].max_lag = {longest}: more than run.steps = {run.steps}, "
                    "beyond which there are no lags"
                )
            yield from (f"observe[#{i + 1}].{text}" for text in observable.warnings(case))
    if case.log is not None and case.log.every > run.warmup + run.steps:
        yield f"log.every = {case.log.every}: more than the steps of the run; one line, of step 0"
    if case.trajectory is not None:
        if case.trajectory.every > run.steps:
            yield f"trajectory.every = {case.trajectory.every}: more than run.steps = {run.steps}"
        free = shutil.disk_usage(Path.cwd()).free
        if trajectory > min(20e9, 0.8 * free):
            yield (
                f"the trajectory takes about {size_text(trajectory)} "
                f"({size_text(free)} are free here); raise trajectory.every or set "
                f"trajectory.{'per_decade' if case.noun == 'site' else 'subset'}"
            )
    if not has_memory(memory):
        yield memory_warning(memory)


def memory_warning(needed: float) -> str:
    """What is said of a run that takes more memory than this machine has."""
    has = size_text(_machine_memory() or 0)
    return f"the run needs {size_text(needed)} of memory, this machine has {has}"


def has_memory(needed: float) -> bool:
    """True if this machine, and the limit of this process, have so many bytes."""
    available = _machine_memory()
    return not available or needed <= 0.9 * available


def require_memory(key: str, given: Any, needed: float) -> None:
    """Raise CaseError, which names the key and what it says, for more bytes than there are here."""
    available = _machine_memory()
    if available and needed > available:
        raise CaseError(
            f"{key} = {show(given)}: needs {size_text(needed)} of memory, this machine has "
            f"{size_text(available)}; expected less"
        )


def _machine_memory() -> int | None:
    try:
        import resource  # where there is none, nothing of the following is

        there = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
        granted, _ = resource.getrlimit(resource.RLIMIT_AS)
    except (ImportError, AttributeError, ValueError, OSError):
        return None
    return there if granted == resource.RLIM_INFINITY else min(there, granted)
