"""No solid: the whole box is fluid."""

from typing import NamedTuple

from mesokit.geometry.protocol import closes, confine, exposed, first_hit, reflect, side, touches


class Nothing(NamedTuple):
    """No solid."""


@touches.register(Nothing)
def _(solid, r, v, a, time):
    return False


@first_hit.register(Nothing)
def _(solid, r, v, a, time):
    return 2.0 * time, 0


@reflect.register(Nothing)
def _(solid, surface, v):
    return v


@confine.register(Nothing)
def _(solid, r):
    return r


@exposed.register(Nothing)
def _(solid):
    return False


@closes.register(Nothing)
def _(solid, place, shift, lower_rate, upper_rate):
    return place, place


@side.register(Nothing)
def _(solid, r):
    return 2
