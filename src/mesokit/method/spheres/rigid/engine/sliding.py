"""Boxes whose images slide (Lees and Edwards 1972), as the loops of rigid grains see them."""

from typing import Any, NamedTuple

from mesokit.case.shear.protocol import slid
from mesokit.method.spheres.common.contacts.groups import Box, SlidBox
from mesokit.scalar.elementary import rint
from mesokit.scalar.intrinsics import floor
from mesokit.scalar.jit import generic


class AtRest(NamedTuple):
    """Images at rest; `none` is there since a group has fields."""

    none: float = 0.0


class Sliding(NamedTuple):
    """Images that slide by the history of a shear, made for the height of the box."""

    history: Any


@generic
def box_in_step(shear, box, time, step):
    """The box at the start of a step, and the mean speed of its images in that step."""


box_in_step.register(AtRest)(lambda shear, box, time, step: box)


@box_in_step.register(Sliding)
def _(shear, box, time, step):
    before, after = slid(shear.history, time), slid(shear.history, time + step)
    folded = before - floor(before * box.inverse[0]) * box.size[0]
    return SlidBox(box.size, box.inverse, folded, (after - before) / step)


@generic
def slip(box, shear, time, since):
    """How far images may have slid since a time, for lists made then."""


slip.register(Box)(lambda box, shear, time, since: 0.0)


@slip.register(SlidBox)
def _(box, shear, time, since):
    # a pair across the boundary slides once; a grain that crossed it seems to have slid as well
    return 3.0 * abs(slid(shear.history, time) - slid(shear.history, since))


@generic
def image_speed(box, separation):
    """Speed along x of the image of a grain against the grain, for the separation between them."""


image_speed.register(Box)(lambda box, separation: 0.0)
image_speed.register(SlidBox)(
    lambda box, separation: rint(separation[1] * box.inverse[1]) * box.speed
)


@generic
def across(box, boxes, step):
    """Change of x and of its velocity of a grain that has crossed the box upwards `boxes` times in
    a step."""


across.register(Box)(lambda box, boxes, step: (0.0, 0.0))


@across.register(SlidBox)
def _(box, boxes, step):
    return -boxes * (box.offset + box.speed * step), -boxes * box.speed
