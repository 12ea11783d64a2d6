"""Kinds of cases: those of one kind run the same compiled kernels.

The kind is the text of a case without its numbers, but for zeros, which may switch something off.
"""

import hashlib
import re

from mesokit.case.case import Case
from mesokit.kernels.kept import kept, versions
from mesokit.kernels.kernel import needs_of_all, processor
from mesokit.kernels.store import Entry

NUMBER = re.compile(r"-?\d+(\.\d+)?(e[-+]?\d+)?")
FILE = re.compile(r'file = "[^"]*"')
NOT_COMPILED = ("[trajectory]", "[log]", "[units]", "[run]", "title")


def has_run(case: Case) -> bool:
    """True if a case of this kind has run here with these kernels; else they must be compiled."""
    return kept().find(_key(case)) is not None


def note_run(case: Case) -> None:
    """Note that the kernels for this kind of case are kept, as long as their contents stay."""
    needs = needs_of_all()
    if needs is not None:
        entry = Entry(f"kind {case.run.method}", needs, b"", "")
        kept().keep(_key(case), lambda store: (entry, []))


def _key(case: Case) -> str:
    return f"kind {kind_of(case)} {processor()} {versions()}"


def kind_of(case: Case) -> str:
    """A name for the kind of a case."""
    tables = re.split(r"^(?=\[)", case.to_toml(), flags=re.MULTILINE)
    text = "".join(table.strip() for table in tables if not table.startswith(NOT_COMPILED))
    text = FILE.sub("file", text)
    kind = case.run.method + NUMBER.sub(lambda n: "0" if float(n[0]) == 0 else "#", text)
    return hashlib.sha256(kind.encode(errors="surrogatepass")).hexdigest()[:16]
