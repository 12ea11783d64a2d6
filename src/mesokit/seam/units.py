"""Units of length, time and mass: cells of MPCD, or whatever a case means by 1."""

import re
from typing import NamedTuple

_SYMBOL = re.compile(r"\b(a|tau|m)\b")
_UNIT = re.compile(
    r"(?:\b(?:a|tau|m|length|time|mass|kT|N|d|sqrt)\b|[\d\s()/^-])+"
)  # and no other words


class Units(NamedTuple):
    """Names of the units of length, time and mass.

    Observables write units with the symbols `a`, `tau` and `m`, whatever the method.

    >>> Units().of("m a^2/tau^2"), Units().of("% of a flow"), CELLS.of("1/a^2")
    ('mass length^2/time^2', '% of a flow', '1/a^2')
    """

    length: str = "length"
    time: str = "time"
    mass: str = "mass"

    def of(self, unit: str) -> str:
        """A unit with these names in place of the symbols; other words stay as they are."""
        if not _UNIT.fullmatch(unit):
            return unit
        names = {"a": self.length, "tau": self.time, "m": self.mass}
        return _SYMBOL.sub(lambda found: names[found[0]], unit)


CELLS = Units("a", "tau", "m")
