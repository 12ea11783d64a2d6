"""Formulas as MathML, which browsers typeset by themselves: no script, no font, no network."""

from __future__ import annotations

import html
import re
from typing import Any

from latex2mathml.converter import convert

FORMULA = re.compile(r'<(span|div) class="arithmatex">\\([(\[])(.*?)\\[)\]]</\1>', re.DOTALL)

FUNCTION = re.compile(
    r"(?<!<msu[bp]>)(<mi>(?:cos|sin|exp|ln)</mi>)(?=<m[ino]>[^(&])"
)  # of what has no brackets


def on_page_content(content: str, **_: Any) -> str:
    """Formulas of a page."""
    return FORMULA.sub(_typeset, content)


def _typeset(found: re.Match[str]) -> str:
    block = found[2] == "["
    made = convert(html.unescape(found[3]), display="block" if block else "inline")
    made = FUNCTION.sub(r'\1<mspace width="0.17em" />', made)
    return f'<div class="formula">{made}</div>' if block else made
