"""No solid: the whole box is fluid."""

from typing import NamedTuple

from mesokit.geometry.protocol import exposed, touches


class Nothing(NamedTuple):
    """No solid."""


@exposed.register(Nothing)
def _(solid):
    return False


@touches.register(Nothing)
def _(solid, clear, r, v, a, time):
    return False
