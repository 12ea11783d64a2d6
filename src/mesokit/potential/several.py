"""Potentials that differ from link to link: which one acts, compiled code reads from tables.

Potentials of one class differ in numbers only: those lie in a table, a row for each, and code is
compiled once for the class however many there are. Several classes are tried one after the other.
"""

import hashlib
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import CaseError
from mesokit.scalar.jit import by_type
from mesokit.scalar.pointer import address, real, word

TABLES: dict[str, NDArray[Any]] = {}  # for good: kernels have their addresses
NONE = -1  # the row of a potential of another class


class Several(NamedTuple):
    """The potentials of one class, and those of the others.

    example: one of them, for its class; numbers: address of a row of parameters for each, of eight
    bytes each; rows: address of the row of each kind of link, NONE for those of other classes;
    others: (Several,), or () where there are none.
    """

    example: Any
    numbers: int
    rows: int
    others: tuple[Any, ...]


def several(potentials: Sequence[Any]) -> Several:
    """The kernels of potentials for compiled code, by the number of a kind of link; None: no force.

    At least one is a potential. Raises CaseError for one whose parameters are not plain numbers.

    >>> from mesokit.potential.harmonic import AboutLength, Square
    >>> found = several([Square(1.0), AboutLength(2.0, 1.0), Square(3.0)])
    >>> found.example, found.others[0].example
    (Square(K=1.0), AboutLength(k=2.0, length=1.0))
    """
    classes = list(dict.fromkeys(type(one) for one in potentials if one is not None))
    made: tuple[Any, ...] = ()
    for kind in reversed(classes):
        mine = list(dict.fromkeys(one for one in potentials if type(one) is kind))
        rows = [mine.index(one) if type(one) is kind else NONE for one in potentials]
        table = np.concatenate([_words(one, pattern=mine[0]) for one in mine])
        made = (Several(mine[0], _kept(table), _kept(np.array(rows, np.int64)), made),)
    (found,) = made
    return found


def _words(potential: Any, pattern: Any) -> NDArray[np.int64]:
    """Its parameters, eight bytes each, of the types of those of another."""
    whole = [isinstance(value, int | np.integer) for value in potential]
    numbers = all(isinstance(value, int | float | np.integer) for value in potential)
    if not numbers or whole != [isinstance(value, int | np.integer) for value in pattern]:
        raise CaseError(
            f"{type(potential).__name__}: parameters that are no plain numbers; a potential of "
            "that kind cannot differ between kinds of solutes"
        )
    return np.concatenate(
        [
            np.array([value], np.int64 if is_whole else np.float64).view(np.int64)
            for value, is_whole in zip(potential, whole, strict=True)
        ]
    )


def _kept(table: NDArray[np.int64]) -> int:
    return address(TABLES.setdefault(hashlib.sha256(table.tobytes()).hexdigest(), table))


@by_type
def row_of(group, number):
    """The row of a kind of link among the potentials of this class, NONE for another."""
    return lambda group, number: word(group.rows, number)


@by_type
def potential_at(group, row):
    """The potential of a row."""
    from numba import types

    fields = group.types[group.fields.index("example")]
    reads = [
        f"{'word' if isinstance(kind, types.Integer) else 'real'}"
        f"(group.numbers, row * {len(fields.types)} + {k})"
        for k, kind in enumerate(fields.types)
    ]
    space = {"made": fields.instance_class, "word": word, "real": real}
    exec(f"def found(group, row): return made({', '.join(reads)})", space)
    return space["found"]
