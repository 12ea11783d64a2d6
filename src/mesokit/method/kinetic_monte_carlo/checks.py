"""Combinations of values that are fine alone and make no lattice together."""

from __future__ import annotations

from collections.abc import Iterator

from mesokit.case.amounts import count_text
from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.method.kinetic_monte_carlo.engine.classes import MOST, by_factors_of_two
from mesokit.method.kinetic_monte_carlo.engine.select import selected
from mesokit.method.kinetic_monte_carlo.lattice.grid import BITS
from mesokit.method.kinetic_monte_carlo.start import sites_of

MOST_SITES = 2**40


def check(case: Case) -> None:
    """Raise CaseError, with the key first."""
    for message in _box(case):
        raise CaseError(message)
    case.lattice.model.check(case)
    table = case.lattice.model.kernel(case.lattice.lattice, bool(case.lattice.ends))
    if not table.rates.max(initial=0.0) > 0:
        raise CaseError("lattice.model: all rates are 0; expected something that may happen")
    select = selected(case.lattice.select, table.rates)
    if select in ("classes", "groups"):
        bounds = table.rates if select == "classes" else by_factors_of_two(table.rates)
        different = len(set(bounds[bounds > 0].tolist()))
        if different >= MOST:
            raise CaseError(
                f"lattice.model: {different} different rates of a site"
                f"{'' if select == 'classes' else ', by factors of two'}; expected at most "
                f"{MOST - 1} with lattice.select = {show(select)}; "
                f"{show('groups' if select == 'classes' else 'tree')} takes more"
            )
    for message in _sublattices(case):
        raise CaseError(message)


def _sublattices(case: Case) -> Iterator[str]:
    given = case.lattice.sublattices
    if given is None:
        return
    size, select = case.box.size, case.lattice.select
    block = given.of(len(size))
    side = 2 * max(1 << bits for bits in BITS[len(size)])
    if block % side:
        yield f"lattice.sublattices.block = {block}: expected a multiple of {side}"
    if any(length % block for length in size):
        yield (
            f"box.size = {show(list(size))}: expected multiples of "
            f"lattice.sublattices.block = {block}"
        )
    if select not in ("auto", "classes", "groups"):
        yield (
            f"lattice.select = {show(select)}: expected 'auto', 'classes' or 'groups' with "
            "lattice.sublattices"
        )


def _box(case: Case) -> Iterator[str]:
    given, size = case.lattice, case.box.size
    kind = given.lattice
    if len(size) != kind.dimension:
        number = {1: "one number", 2: "two numbers", 3: "three numbers"}[kind.dimension]
        yield (
            f"box.size = {show(list(size))}: expected {number} of sites, for "
            f"lattice.kind = {show(given.kind)}"
        )
        return
    if any(length != int(length) or length < 2 for length in size):
        yield f"box.size = {show(list(size))}: expected whole numbers of sites, at least 2"
    for axis in given.ends:
        if axis not in case.box.axes:
            yield f"lattice.ends = {show(list(given.ends))}: expected some of {show(case.box.axes)}"
    for axis, length, counts in zip(case.box.axes, size, kind.parity, strict=True):
        if counts and length % 2 and axis not in given.ends:
            yield (
                f"box.size = {show(list(size))}: expected an even number along {axis}, for "
                f"lattice.kind = {show(given.kind)}"
            )
    if sites_of(case) > MOST_SITES:
        yield (
            f"box.size = {show(list(size))}: {count_text(sites_of(case))} sites; expected at most "
            f"{MOST_SITES}"
        )
