"""What rank 0 decides for all."""

from collections.abc import Callable
from typing import NamedTuple


class Order(NamedTuple):
    """Go on to a step, and write a checkpoint there if `save`; or stop here, by a signal of this
    number if that is not 0."""

    target: int
    save: bool
    stop: int


Coming = Callable[[], Order]  # waits for an order
