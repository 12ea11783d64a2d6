"""Runs that go on for longer than their case said."""

from __future__ import annotations

import dataclasses
import numbers
from typing import TYPE_CHECKING, Any

from mesokit.case.component import show
from mesokit.errors import CaseError

if TYPE_CHECKING:
    from mesokit.case.case import Case


def longer(case: Case, steps: int, done: int) -> Case:
    """The case with so many steps after its warm-up.

    Raises CaseError if the run has done more, the warm-up included in `done`.
    """
    passed = max(done - case.run.warmup, 0)
    if require_steps(steps) < passed:
        raise CaseError(f"run.steps = {steps}: the run has done {passed} already")
    return dataclasses.replace(case, run=dataclasses.replace(case.run, steps=int(steps)))


def require_steps(steps: Any) -> int:
    """The number of steps. Raises CaseError for anything but a whole number from 0."""
    whole = isinstance(steps, numbers.Integral) and not isinstance(steps, bool)
    if not whole or steps < 0:
        raise CaseError(f"steps = {show(steps)}: expected a whole number of at least 0")
    return int(steps)
