"""Numbers by short names: `viscosity`, where only one of several begins so."""

import difflib
import itertools
import re
from collections.abc import Iterable
from typing import Protocol, TypeVar


class Named(Protocol):
    """Something with a name in words."""

    @property
    def what(self) -> str:
        """Words for it, such as "viscosity from curvature"."""
        ...


T = TypeVar("T", bound=Named)
NEAR = 3  # names that an error proposes at most


def key_of(what: str) -> str:
    """Words as one name: small letters and digits, with hyphens between them.

    >>> key_of("viscosity from curvature"), key_of("L_r/D"), key_of("share left after 0.5 tau")
    ('viscosity-from-curvature', 'l-r-d', 'share-left-after-0-5-tau')
    """
    return re.sub(r"[\W_]+", "-", what.lower()).strip("-")


def keyed(comparisons: Iterable[T]) -> dict[str, T]:
    """Comparisons by their keys, in their order; of equal ones the second is `...-2`, and so on.

    >>> from mesokit.seam.result import Comparison
    >>> list(keyed([Comparison("slip", 1, 1), Comparison("slip", 2, 1)]))
    ['slip', 'slip-2']
    """
    found: dict[str, T] = {}
    for comparison in comparisons:
        plain = key_of(comparison.what)
        others = (f"{plain}-{number}" for number in itertools.count(2))
        key = next(key for key in itertools.chain([plain], others) if key not in found)
        found[key] = comparison
    return found


def find(comparisons: Iterable[T], name: str) -> T:
    """The comparison of that name, or the only one whose name begins with it.

    The name may be the words or the key of `keyed`; large letters and signs between the words do
    not matter. Raises KeyError with the names that are there or near.

    >>> from mesokit.seam.result import Comparison
    >>> measured = [Comparison("viscosity from curvature", 0.9, 0.1), Comparison("slip", 0, 1)]
    >>> find(measured, "viscosity").measured, find(measured, "Viscosity from curvature").measured
    (0.9, 0.9)
    >>> find(measured, "drag")
    Traceback (most recent call last):
        ...
    KeyError: "no comparison 'drag'; there are viscosity-from-curvature, slip"
    """
    known = keyed(comparisons)
    wanted = key_of(name) if isinstance(name, str) else ""
    if wanted in known:
        return known[wanted]
    begin = [key for key in known if wanted and key.startswith(wanted)]
    if len(begin) == 1:
        return known[begin[0]]
    if begin:
        raise KeyError(f"comparison {name!r} may be {' or '.join(begin)}")
    near = difflib.get_close_matches(wanted, known, NEAR, 0.5)
    hint = f"did you mean {' or '.join(near)}?" if near else f"there are {', '.join(known)}"
    raise KeyError(f"no comparison {name!r}; {hint if known else 'there are none'}")
