"""A kernel of a step with its arguments, of which a few words change from step to step."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.devices.device import Device, words_of
from mesokit.method.mpcd.engine.cpu.physics import Physics
from mesokit.method.mpcd.engine.cuda.plan import Plan


class StepKernel:
    """A body `(i, physics, now, *more)`; the field of `physics` and `now` are those of the step."""

    def __init__(
        self, device: Device, body: Callable, physics: Physics, plan: Plan, *more: Any
    ) -> None:
        self._device = device
        given = physics, plan.now, *more
        self._kernel = device.kernel(body, given)
        self._words = words_of(0, *given)
        before = len(words_of(0, *physics[: physics._fields.index("field")]))
        has_field = physics.field != ()
        self._field = slice(before, before + (plan.field_words if has_field else 0))
        start = len(words_of(0, physics))
        self._now = slice(start, start + plan.now_words)
        self._apart = plan.now_words

    def take(self, fluid: Any) -> None:
        """Take another fluid of the same type, the first of `more`."""
        words = words_of(0, fluid)[1:]
        self._words[self._now.stop : self._now.stop + len(words)] = words

    def __call__(self, threads: int, row: NDArray[np.uint64], *last: int) -> None:
        """Launch so many threads with the words of a step (see `Plan`), and other last numbers."""
        if threads == 0:
            return
        self._words[0] = threads
        self._words[len(self._words) - len(last) :] = last
        self._words[self._now] = row[: self._apart]
        self._words[self._field] = row[self._apart :][: self._field.stop - self._field.start]
        self._device.launch(self._kernel, self._words)
