"""Functions of the user that a run calls every so many steps."""

import numbers
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from mesokit.case.component import show
from mesokit.errors import CaseError, MesokitError, RunError

Function = Callable[[Any], Any]  # of a Simulation, which imports this file


class StopRun(Exception):
    """Raised by a callback to end the run after this step, with a reason if there is one.

    >>> raise StopRun("the polymer has passed")
    Traceback (most recent call last):
    mesokit.run.callbacks.StopRun: the polymer has passed
    """


@dataclass(frozen=True)
class Callback:
    """A function that is called every so many steps; `every` makes one."""

    steps: int
    call: Function


def every(steps: int, call: Function) -> Callback:
    """Call a function at step 0 and after every so many steps of a run.

    Parameters
    ----------
    steps : int
        Steps between two calls, counted from the first step of the warm-up on.
    call : function of a Simulation
        May read `simulation.step`, `time`, `results`, `engine.positions()` and all other readings
        of observables. It may raise `StopRun`; any other exception ends the run as a RunError from
        it. All ranks call it, and must take the same readings.

    Raises
    ------
    CaseError
        If `steps` is no whole number of at least 1, or `call` cannot be called.

    Examples
    --------
    >>> from mesokit import Box, Run, Simulation, every
    >>> def look(simulation):
    ...     print(simulation.step, len(simulation.engine.positions()))
    >>> Simulation(run=Run(steps=20), box=Box([8, 8]), callbacks=[every(10, look)]).run()
    0 640
    10 640
    20 640
    """
    whole = isinstance(steps, numbers.Integral) and not isinstance(steps, bool)
    if not whole or steps < 1:
        raise CaseError(f"every: steps = {show(steps)}: expected a whole number of at least 1")
    if not callable(call):
        raise CaseError(f"every: call = {show(call)}: expected a function of a simulation")
    return Callback(int(steps), call)


class Callbacks:
    """The callbacks of a run, each called once at each of its steps."""

    def __init__(self, given: Sequence[Callback] = ()) -> None:
        if not isinstance(given, Sequence):
            raise CaseError(f"callbacks = {show(given)}: expected a list of every(n, function)")
        for i, callback in enumerate(given):
            if not isinstance(callback, Callback):
                form = "expected every(n, function), such as every(100, function)"
                raise CaseError(f"callbacks[#{i + 1}] = {show(callback)}: {form}")
        self.given = list(given)
        self.called = -1  # the last step at which they were called
        self.stopped: str | None = None  # the reason why one of them has ended the run

    def resume(self, step: int) -> None:
        """Go on from a checkpoint, before which they were called at its step."""
        self.called = step if step > 0 else -1

    def next_stops(self, step: int) -> list[int]:
        """The next step after this one at which each is due."""
        return [step + each.steps - step % each.steps for each in self.given]

    def due(self, step: int) -> bool:
        """True if one of them is to be called at this step, and has not been yet."""
        return step != self.called and any(step % each.steps == 0 for each in self.given)

    def call(self, simulation: Any) -> str | None:
        """Call those that are due at this step; the reason of one that ends the run, or None.

        Raises RunError if one of them fails.
        """
        self.called = step = simulation.step
        for function in [each.call for each in self.given if step % each.steps == 0]:
            name = str(getattr(function, "__name__", type(function).__name__))
            try:
                function(simulation)
            except StopRun as stop:
                self.stopped = str(stop) or name
            except MesokitError:
                raise
            except Exception as error:
                text = " ".join(f"{type(error).__name__}: {error}".split())
                raise RunError(f"callback {name} at step {step}: {text}") from error
        return self.stopped
