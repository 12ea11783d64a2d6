"""Captions: comparisons in words and formulas, below a figure."""

import re
import textwrap
from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Any

from mesokit.case.describe.digits import two_digits
from mesokit.seam.in_units import shown
from mesokit.seam.result import Comparison, with_error
from mesokit.seam.units import CELLS

MOST = 8  # comparisons below a figure; the table of the run has all
LETTERS = 16.0  # in an inch
LINE = 0.17  # inches
SHORT = 30  # letters of a note that may be said on every line
SIZE, LEFT = 8, 0.02  # points; of the width, at the left

_SYMBOLS = {
    "a": "a", "tau": r"\tau", "m": "m", "1/a": "a^{-1}", "1/tau": r"\tau^{-1}", "a^2": "a^2",
    "a/tau": r"a/\tau", "a^2/tau": r"a^2/\tau", "a^2/tau^2": r"a^2/\tau^2",
    "a/time": r"a/\tau", "a^2/time": r"a^2/\tau", "a/tau^2": r"a/\tau^2",
    "1/a^2": "a^{-2}", "1/a^3": "a^{-3}",
    "m a^2/tau^2": r"m\,a^2/\tau^2", "m a/tau": r"m\,a/\tau", "m a/tau^2": r"m\,a/\tau^2",
    "m/tau^2": r"m/\tau^2", "a^3/tau": r"a^3/\tau", "m/(a tau^2)": r"m/(a\,\tau^2)",
    "a^2/sums": "a^2", "kT": "k_BT", "kT/a": "k_BT/a", "kT/a^2": "k_BT/a^2", "kT/a^3": r"k_BT/a^3",
    "N kT": r"N\,k_BT",
    "N m kT": r"N\,m\,k_BT", "N sqrt(m kT)": r"N\sqrt{m\,k_BT}", "m/a^2": "m/a^2", "m/a^3": "m/a^3",
}  # fmt: skip
_WORD = re.compile(r"\b(length|time|mass)\b( ?)")  # as `seam.units` names units
_NAMED = re.compile(r"(?=.*[a-z])(?:\b(?:length|time|mass)\b|[\d ()/^-])+")
_FORMULAS = (
    (r"\bexp\(-t/tau_p\)", r"$e^{-t/\\tau_p}$"),
    (r"\bexp\(-nu k\^2 t\)", r"$e^{-\\nu k^2 t}$"),
    (r"\bN sqrt\(m kT\)", r"$N\\sqrt{m\\,k_BT}$"),
    (r"\bL_r/D\b", r"$L_r/D$"),
    (r"\btau_p\b", r"$\\tau_p$"),
    (r"\bpsi_6\b", r"$\\psi_6$"),
    (r"\bk_B T\b", r"$k_BT$"),
    (r"\b([vFTR])_([xyzrgp])\b", r"$\1_\2$"),
    (r"\b([gS])\(([rq])\)", r"$\1(\2)$"),
    (r"\b([qr])(?= [<=] \d)", r"$\1$"),
    (r"(?<=\d)/a\b", r" $a^{-1}$"),
    (r"(?<=[\d)]) a\^2/tau\b", r" $a^2/\\tau$"),
    (r"(?<=[\d)]) a/tau\b", r" $a/\\tau$"),
    (r"(?<=[\d)]) a\b(?![/^])", r" $a$"),
    (r"\bU = K r\^2", r"$U=K\,r^2$"),
    (r"\bkT\b", r"$k_BT$"),
)


def symbols(unit: str) -> str:
    """A unit as Matplotlib writes it, without the brackets; texts stay texts.

    >>> symbols("a^2/tau"), symbols("% of the flow"), symbols("length^2")
    ('$a^2/\\\\tau$', '% of the flow', '$\\\\mathrm{length}^2$')
    """
    unit = shown().of(unit)
    if unit in _SYMBOLS:
        return f"${_SYMBOLS[unit]}$"
    if _NAMED.fullmatch(unit):
        upright = _WORD.sub(lambda w: rf"\mathrm{{{w[1]}}}" + r"\," * bool(w[2]), unit)
        return f"${upright}$"
    return mathematics(unit)


def rounded(value: float, digits: int = 4) -> str:
    """A number to so many digits, as it stands in a formula.

    >>> rounded(41000.0), rounded(0.12345), rounded(2.5e7)
    ('41000', '0.1235', '2.5\\\\times 10^{7}')
    """
    mantissa, _, exponent = f"{value:.{digits}g}".partition("e")
    if not exponent:
        return mantissa
    if 0 < int(exponent) < 6:
        return f"{float(f'{value:.{digits}g}'):.0f}"
    return rf"{mantissa}\times 10^{{{int(exponent)}}}"


def at(time: float, digits: int = 4, name: str = "t = ") -> str:
    """A time in a formula, with its unit where that has a symbol.

    >>> at(7.0), at(7.0, 4, "")
    ('$t = 7\\\\,\\\\tau$', '$7\\\\,\\\\tau$')
    """
    unit = r"\,\tau" * (shown() == CELLS)
    return f"${name}{rounded(time, digits)}{unit}$"


def in_cells() -> str:
    """The unit of a length in a formula: the side of a cell, or nothing without cells."""
    return r"\,a" * (shown() == CELLS)


def mathematics(text: str) -> str:
    """Plain words with the formulas in them set as such.

    >>> print(mathematics("velocity v_x at U = 0.2 a/tau"))
    velocity $v_x$ at U = 0.2 $a/\\tau$
    >>> print(mathematics("Rouse, exp(-t/tau_p)"))
    Rouse, $e^{-t/\\tau_p}$
    """
    for formula, sign in _FORMULAS:
        parts = re.split(r"(\$[^$]*\$)", text)  # formulas that are set already stay
        text = "".join(p if p.startswith("$") else re.sub(formula, sign, p) for p in parts)
    return text


def unbroken(text: str) -> str:
    """The same without spaces in formulas, so that no line of a note ends in one.

    >>> print(unbroken(r"solutes at $t = 7\\,\\tau$ of the run"))
    solutes at $t=7\\,\\tau$ of the run
    """
    return re.sub(r"\$[^$]*\$", lambda found: found[0].replace(" ", ""), text)


def compared(comparisons: Iterable[Comparison], width: float) -> str:
    """Lines that fit into so many inches: measured with error, theory, deviation, and cautions.

    A long caution of several lines is written once, below them.
    """
    found = list(comparisons)
    notes = Counter(filter(None, map(_caution, found[:MOST])))
    shared = [note for note, number in notes.items() if number > 1 and len(note) > SHORT]
    lines = [line for c in found[:MOST] for line in _wrapped(_line(c, shared), width)]
    lines += [line for note in shared for line in _wrapped(note, width)]
    if len(found) > MOST:
        lines.append(f"and {len(found) - MOST} more, which mesokit info shows")
    return "\n".join(map(mathematics, lines))


def _wrapped(text: str, width: float) -> list[str]:
    letters = max(30, int(width * (1 - 2 * LEFT) * LETTERS))
    return textwrap.wrap(text, letters, subsequent_indent="    ", break_long_words=False)


def _caution(c: Comparison) -> str:
    """The note of a comparison that qualifies its deviation, or explains why there is none."""
    unknown = c.measured != c.measured or c.expected != c.expected
    if unknown or c.approximate or not c.steady or c.lower_bound:
        return c.note
    return ""


def _line(c: Comparison, shared: Sequence[str]) -> str:
    unit = "" if c.measured != c.measured else unbroken(symbols(c.unit))
    text, note = f"{c.what}: {with_error(c.measured, c.error)} {unit}".rstrip(), _caution(c)
    note = "" if note in shared and not c.approximate else note
    note = "approximate" if note in shared else note
    said = []
    if c.expected == c.expected and (c.expected or c.error > 0):
        said.append(f"theory {c.expected:.4g}")
        if c.approximate and c.percent == c.percent:
            said[0] += f", {two_digits(c.percent, sign='+')} %"
        elif c.deviation == c.deviation:
            said[0] += f", {c.in_errors('s.e.')}"
    said += [note] if note else []
    return f"{text} ({'; '.join(said)})" if said else text


def below(figure: Any, text: str) -> None:
    """Write a caption under the axes, where it hides no data."""
    if text:
        figure.supxlabel(text, fontsize=SIZE, ha="left", x=LEFT, linespacing=1.5)
