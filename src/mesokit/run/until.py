"""Length of a run: more steps than its case says, or until a standard error is small enough."""

from __future__ import annotations

import dataclasses
import math
import numbers
from typing import Any, NamedTuple

from mesokit.case.case import Case
from mesokit.case.component import nearest, one_of, show
from mesokit.errors import CaseError
from mesokit.seam.named import find
from mesokit.seam.result import Comparison, Result

MOST = 100  # times as long as the case says, unless a limit is given
SHORTEST, LONGEST = 1.05, 2.0  # factors by which a run is made longer at a time
FORM = "expected OBSERVABLE.NUMBER=ERROR, such as velocity-profile.viscosity=1% or =0.005"


class Goal(NamedTuple):
    """The wanted standard error of a compared number of an observable.

    `error` is a share of the number if `relative`, else in its unit.
    """

    observable: str
    number: str
    error: float
    relative: bool

    @classmethod
    def parse(cls, text: str, case: Case) -> Goal:
        """From 'velocity-profile.viscosity=1%'. Raises CaseError for another form or observable."""
        path, equals, amount = text.rpartition("=")
        labels = [observable.label for observable in case.observe]
        fits = [label for label in labels if path.strip().startswith(f"{label}.")]
        try:
            error = float(amount.strip().removesuffix("%"))
        except ValueError:
            error = math.nan
        if not equals or not 0 < error < math.inf:
            raise CaseError(f"until {show(text)}: {FORM}")
        if not fits:
            name = path.strip().partition(".")[0]
            known = f"; there is {one_of(labels)}" if labels else "; the case has none"
            hint = nearest(name, labels) or known
            raise CaseError(f"until {show(text)}: no observable {show(name)}{hint}")
        relative = amount.strip().endswith("%")
        number = path.strip()[len(fits[0]) + 1 :]
        return cls(fits[0], number, error / 100 if relative else error, relative)

    def found(self, result: Result) -> Comparison:
        """The present number. Raises CaseError if the observable has none of that name."""
        try:
            return find(result.comparisons, self.number)
        except KeyError as error:
            raise CaseError(f"until {self.observable}: {error.args[0]}") from None

    def excess(self, result: Result) -> float:
        """The present standard error over the wanted one; infinite if it is not known."""
        number = self.found(result)
        allowed = self.error * abs(number.measured) if self.relative else self.error
        known = number.error > 0 and math.isfinite(number.error) and allowed > 0
        return number.error / allowed if known else math.inf

    def said(self, result: Result) -> str:
        """The present standard error in words."""
        number = self.found(result)
        name = f"{self.observable}: {number.what}"
        if math.isnan(number.measured):
            return f"{name} is undetermined ({number.note})"
        if self.relative and number.measured:
            return f"{name} is known to {100 * number.error / abs(number.measured):.3g} %"
        return f"{name} is known to {number.error:.3g} {number.unit}"


def next_length(excess: float, done: int, every: int, limit: int) -> int:
    """New number of steps after the warm-up, of which `done` are done.

    Errors fall with the root of the time, so the factor is the excess squared, and 5 % more.

    >>> next_length(1.2, done=1000, every=10, limit=10**6), next_length(9.0, 1000, 10, 1500)
    (1520, 1500)
    """
    factor = min(max(SHORTEST * min(excess, LONGEST) ** 2, SHORTEST), LONGEST)
    wanted = max(math.ceil(done * factor), done + every)
    return min(-(-wanted // every) * every, limit)


def limit_of(case: Case, most: Any) -> int:
    """The largest number of steps after the warm-up: as given, or a multiple of the case's."""
    return int(most) if most is not None else MOST * max(case.run.steps, 1)


def longer(case: Case, steps: int, done: int) -> Case:
    """The case with so many steps after its warm-up.

    Raises CaseError if the run has done more; `done` counts its warm-up too.
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
