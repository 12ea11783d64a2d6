"""Checks of a case that all methods share: observables, log and trajectory."""

import dataclasses
import math
import re
from collections.abc import Iterator, Sequence
from typing import Any, get_args

from mesokit.case.box import AXES
from mesokit.case.component import is_component, name_of, nearest, one_of, show
from mesokit.case.registry import family_of
from mesokit.case.trajectory import SUSPENDED, Group, Quantity, written
from mesokit.errors import CaseError

MOST_BINS = 2**24  # of one observable: some gigabytes


def check(case: Any, method: Any) -> None:
    """Raise CaseError for the first observable that cannot be measured, and for a trajectory of
    particles or fields that the method does not have."""
    for problem in (
        *offered(case, method.name, method.observables),
        *names(case),
        *bins(case),
        *lattices(case.run.method, case.box.size, case.groups),
        *trajectory(case, case.groups),
    ):
        raise CaseError(problem)
    for i, observable in enumerate(case.observe):
        try:
            observable.check(case)
        except CaseError as error:
            reason = str(error).removeprefix(f"{observable.label}: ")
            joint = "." if re.match(r"\w+ = ", reason) else f" ({observable.label}): "
            raise CaseError(f"observe[#{i + 1}]{joint}{reason}") from None


def is_offered(part: Any, method: str, observables: tuple[type, ...]) -> bool:
    """True if a method offers an observable, or the observable names the method."""
    usual = issubclass(part, observables) and not getattr(part, "of_methods_alone", False)
    return usual or method in part.methods


def offered(case: Any, method: str, observables: tuple[type, ...]) -> Iterator[str]:
    """Errors: observables that the method does not offer, and that do not name the method."""
    for i, observable in enumerate(case.observe):
        if not is_offered(type(observable), method, observables):
            known = sorted(
                name
                for name, part in family_of(observable).parts.items()
                if is_offered(part, method, observables)
            )
            choice = f"offer it; expected {one_of(known)}" if known else "offer any"
            yield (
                f"observe[#{i + 1}].quantity = {show(name_of(observable))}: method {show(method)} "
                f"does not {choice}"
            )


def names(case: Any) -> Iterator[str]:
    """Results are kept by name."""
    seen: dict[str, int] = {}
    for i, observable in enumerate(case.observe):
        label = observable.label
        if label in seen:
            yield (
                f"observe[#{i + 1}].name: {show(label)} is also the name of "
                f"observe[#{seen[label]}]; give one of them a name"
            )
        seen[label] = i + 1
        if not label.replace("-", "").replace("_", "").isalnum():
            yield (
                f"observe[#{i + 1}].name = {show(label)}: expected letters, digits, '-' and '_' "
                "(it names a file)"
            )


def bins(case: Any) -> Iterator[str]:
    """No more than fit into the memory."""
    for i, observable in enumerate(case.observe):
        per_cell = getattr(observable, "bins_per_cell", None)
        if per_cell is None:
            continue
        axes = getattr(observable, "axes", None) or (getattr(observable, "axis", "x"),)
        lengths: dict[str, int] = dict(zip(AXES, case.box.size, strict=False))
        number = math.prod(lengths.get(axis, 1) * per_cell for axis in axes)
        if number > MOST_BINS:
            yield (
                f"observe[#{i + 1}].bins_per_cell = {per_cell}: {number} bins in this box; "
                f"expected at most {MOST_BINS}"
            )


def log(case: Any, known: Sequence[str]) -> None:
    """Raise CaseError for a column that is neither one of these nor of an observable."""
    labels, columns = [observable.label for observable in case.observe], case.log.columns
    for i, column in enumerate(columns):
        if columns.index(column) < i:
            raise CaseError(f"log.columns = {show(columns)}: expected each column once")
        label, _, name = column.partition(".")
        if column not in known and not (label in labels and name):
            near = nearest(label, labels) if name else nearest(column, known)
            also = f", or {show(f'{labels[0]}.<what it compares>')}" if labels else ""
            choice = one_of(known) if known else "no column: the method has none"
            raise CaseError(
                f"log.columns[#{i + 1}] = {show(column)}: expected {choice}{also}{near}"
            )


def lattices(method: str, size: Sequence[float], groups: Sequence[Group]) -> Iterator[str]:
    """Errors of a method: a lattice of other sites than those of its group, or of other axes than
    the box has.

    >>> from mesokit.case.sites import SiteLattice
    >>> from mesokit.case.trajectory import Group, Kind
    >>> squares = Group("sites", (Kind(1.0, 12),), lattice=SiteLattice((4, 4)))
    >>> next(lattices("mine", (4, 4), [squares]))
    "method 'mine': group 'sites' has 12 sites; expected 16, as its lattice has (4, 4)"
    """
    for group in groups:
        lattice, of = group.lattice, f"method {show(method)}: group {show(group.name)} has"
        if lattice is None:
            continue
        if group.number != lattice.number:
            expected = f"expected {lattice.number}, as its lattice has {lattice.size}"
            yield f"{of} {group.number} sites; {expected}"
        elif lattice.dimension != len(size):
            yield f"{of} a lattice {lattice.size}; expected one of {len(size)} axes, as the box"


def trajectory(case: Any, groups: Sequence[Group]) -> Iterator[str]:
    """Particles that exist, each field once, and fields that they have."""
    given = case.trajectory
    if given is None:
        return
    known = ["all", *(group.name for group in groups), *([SUSPENDED] if len(groups) > 2 else [])]
    number, _ = written(given, groups)
    noun = groups[0].noun if groups else "particle"
    if given.of not in known:
        lacking = (
            f"; {show(given.of)} needs [[{given.of}]]"
            if getattr(case, given.of, None) == ()
            else ""
        )
        yield f"trajectory.of = {show(given.of)}: expected {one_of(known)}{lacking}"
    elif number == 0:
        yield f"trajectory.of = {show(given.of)}: there is no such {noun}"
    elif given.subset is not None and given.subset > number:
        yield f"trajectory.subset = {given.subset}: there are only {number} {noun}s"
    elif given.subset is not None and noun == "site":
        yield f"trajectory.subset = {given.subset}: a lattice is written whole; leave it out"
    if len(set(given.fields)) < len(given.fields):
        yield f"trajectory.fields = {show(given.fields)}: expected each field once"
    # all that is suspended has what bodies have: beads have the orientation of the box and no spin
    last = groups[-1].name if given.of == SUSPENDED and groups else given.of
    for group in groups:
        for field in given.fields if last in ("all", group.name) else ():
            if field not in group.has:
                have = [name for name in get_args(Quantity) if name in group.has]
                yield (
                    f"trajectory.fields = {show(given.fields)}: {group.name} of method "
                    f"{show(case.run.method)} have no {show(field)}; expected some of "
                    f"{', '.join(map(show, have))}"
                )


def box_keys(box: Any, method: Any) -> None:
    """Raise CaseError for a key of the box that the method does not take, and for a chain."""
    if box.dimension not in method.dimensions:
        raise CaseError(
            f"box.size = {show(list(box.size))}: expected two lengths (2D) or three (3D)"
        )
    usual = type(box)(box.size)
    for key in (field.name for field in dataclasses.fields(box)):
        value = getattr(box, key)
        if key == "size" or key in method.box or value == getattr(usual, key):
            continue
        tagged = f".rule = {show(name_of(value))}" if is_component(type(value)) else ""
        said = tagged or f" = {show(list(value) if isinstance(value, tuple) else value)}"
        raise CaseError(f"box.{key}{said}: not with method {show(method.name)}")


def whole_cells(box: Any) -> None:
    """Raise CaseError for a length that is no whole number, or too few cells, of a method that has
    cells."""
    if min(box.size) < 2:
        raise CaseError(
            f"box.size = {show(list(box.size))}: expected at least 2 cells along each axis"
        )
    for i, length in enumerate(box.size):
        if length != int(length):
            raise CaseError(f"box.size[#{i + 1}] = {show(length)}: expected a whole number")
