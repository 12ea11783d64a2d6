"""Kinds of cases: those of one kind run the same compiled kernels.

The kind is the text of a case without its numbers, but for zeros, which may switch something off.
"""

from __future__ import annotations

import hashlib
import re
from pathlib import Path
from typing import TYPE_CHECKING

from mesokit.scalar.cache import folder

if TYPE_CHECKING:
    from mesokit.case.case import Case

NUMBER = re.compile(r"-?\d+(\.\d+)?(e[-+]?\d+)?")
FILE = re.compile(r'file = "[^"]*"')
NOT_COMPILED = ("[[observe]]", "[trajectory]", "[log]", "[units]", "[run]", "title")


def has_run(case: Case) -> bool:
    """Whether a case of this kind has run here with these kernels; if not, they are to compile."""
    return _mark(case).exists()


def note_run(case: Case) -> None:
    """Remember that the kernels for this kind of case are kept. Raises OSError."""
    mark = _mark(case)
    mark.parent.mkdir(parents=True, exist_ok=True)
    mark.touch()


def _mark(case: Case) -> Path:
    return Path(folder()) / "kinds" / kind_of(case)


def kind_of(case: Case) -> str:
    """A name for the kind of a case."""
    tables = re.split(r"^(?=\[)", case.to_toml(), flags=re.MULTILINE)
    text = "".join(table.strip() for table in tables if not table.startswith(NOT_COMPILED))
    text = FILE.sub("file", text)
    kind = case.run.method + NUMBER.sub(lambda n: "0" if float(n[0]) == 0 else "#", text)
    return hashlib.sha256(kind.encode(errors="surrogatepass")).hexdigest()[:16]
