"""What a user's own parts register for compiled code: looked at before anything is compiled."""

from collections.abc import Callable, Iterator
from typing import Any

from mesokit.case.case import Case
from mesokit.case.outside import is_outside
from mesokit.case.registry import address
from mesokit.method.mpcd.collision.protocol import coefficients, collide, contribute, freedom
from mesokit.method.mpcd.field.protocol import acceleration
from mesokit.method.mpcd.thermostat.protocol import target


def kernels(case: Case) -> Iterator[str]:
    """Every function that a rule, thermostat or force has to bring."""
    fluid, d, size = case.fluid, case.box.dimension, case.box.size
    rule, bath, force = fluid.collision, fluid.thermostat, fluid.force
    for_rule = contribute, freedom, coefficients, collide
    yield from _lacking("fluid.collision", rule, lambda: rule.kernel(d, fluid.kT), for_rule)
    yield from _lacking("fluid.thermostat", bath, lambda: bath.kernel(fluid.kT, 0.0), (target,))
    yield from _lacking("fluid.force", force, lambda: force.kernel(size), (acceleration,))


def _lacking(
    key: str, part: Any, kernel: Callable[[], Any], functions: tuple[Any, ...]
) -> Iterator[str]:
    if not is_outside(part):
        return
    place = address(type(part))
    try:
        kind = type(kernel())
    except Exception as error:
        reason = " ".join(f"{type(error).__name__}: {error}".split())
        yield f"{key}: {place} has no parameters for its kernel: {reason}"
        return
    for function in functions:
        if kind not in function.implementations and not function.others:
            yield f"{key}: {place} registers no {function.__name__} for {kind.__name__}"
