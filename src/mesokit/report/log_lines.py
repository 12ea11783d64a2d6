"""The log of a run on the screen: aligned lines under a header."""

from collections.abc import Sequence

from mesokit.seam.result import with_error

ERROR = " error"  # ends the name of a number that is the standard error of the one before
AGAIN = 20  # lines after which the header comes again
NARROWEST = 10  # characters of a column


class LogLines:
    """Lines of numbers under names, which are repeated now and then.

    A number and its standard error share a column, the error as last digits in brackets.

    >>> lines = LogLines(["step", "temperature", "viscosity", "viscosity error"])
    >>> print("\\n".join(lines.next((100, 0.987654321, 0.8705, 0.0123))))
          step  temperature   viscosity
           100     0.987654   0.871(12)
    """

    def __init__(self, names: Sequence[str]) -> None:
        self.names = [name for name in names if not name.endswith(ERROR)]
        self.uncertain = [f"{name}{ERROR}" in names for name in self.names]
        self.widths = [max(len(name), NARROWEST) for name in self.names]
        self.shown = 0

    def next(self, row: Sequence[float]) -> list[str]:
        """The line of these numbers, after a header where that is due."""
        numbers, texts = iter(row), []
        for uncertain in self.uncertain:
            number = next(numbers)
            texts.append(with_error(number, next(numbers)) if uncertain else f"{number:.6g}")
        rows = [self.names, texts] if self.shown % AGAIN == 0 else [texts]
        self.shown += 1
        return ["  ".join(map(str.rjust, words, self.widths)) for words in rows]
