"""What changes from step to step, found for many steps at once before a device does them."""

from typing import Any

import numpy as np
from numba import typeof
from numpy.typing import NDArray

from mesokit.kernels.group import put_value, words_in
from mesokit.kernels.kernel import kernel
from mesokit.method.mpcd.engine.cpu.groups import Course, Now
from mesokit.method.mpcd.engine.cpu.physics import Physics
from mesokit.method.mpcd.engine.cpu.step import last_collision, next_step
from mesokit.method.mpcd.field.protocol import field_at
from mesokit.scalar.random import Counter

BYTES = 8  # of a word


class Plan:
    """The words of `Now`, and of the field in the middle of the step, for each of some steps.

    `now` and `field` are examples of both. `physics_there` has addresses of a device's tables.
    """

    def __init__(self, physics: Physics, physics_there: Physics, course: Course) -> None:
        counter = Counter(course.seed, course.done)  # type: ignore[arg-type]
        self.now = Now(counter, course.box, course.grid, course.grid, 0)
        self.field: Any = field_at(physics.field, 0.0)
        self._physics = physics
        here, there = (_words_of(one.field) for one in (physics, physics_there))
        self._tables = {k: there[k] for k in range(len(here)) if here[k] != there[k]}
        self.now_words, self.field_words = (words_in(typeof(x)) for x in (self.now, self.field))

    def rows(self, course: Course) -> NDArray[np.uint64]:
        """A row for each step (steps + 1, words), and one for the collision after the last."""
        width = self.now_words + self.field_words
        rows = np.zeros((course.steps + 1, width), np.uint64)
        fill_rows(course, self._physics, rows.ctypes.data, width * BYTES)
        for place, address in self._tables.items():
            rows[:, self.now_words + place] = address
        return rows


def _words_of(value: Any) -> list[Any]:
    if isinstance(value, tuple):
        return [word for part in value for word in _words_of(part)]
    return [value]


@kernel
def fill_rows(course, physics, place, width):
    """Write the words of each step, which are the same as on the threads of a processor."""
    now = Now(Counter(course.seed, course.done), course.box, course.grid, course.grid, 0)
    for n in range(course.steps):
        now = next_step(course, now, physics, n)
        middle = (course.done + n + 0.5) * physics.timestep
        put_value(place + n * width, (now, field_at(physics.field, middle)))
    end = course.done * physics.timestep
    now = last_collision(course, now)
    put_value(place + course.steps * width, (now, field_at(physics.field, end)))
