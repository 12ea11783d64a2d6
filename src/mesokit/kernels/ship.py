"""A file of parts that comes with the package, for a first run without compiling most of it."""

from pathlib import Path

from mesokit.kernels.kept import kept, version_line
from mesokit.kernels.made_of import still_holds
from mesokit.kernels.store import Code, Store


def export(file: Path) -> int:
    """Write all valid parts of the user's store to a file; how many there are.

    Machine code of kernels is left out: it is for one processor. Code is not compressed, as a
    wheel compresses like parts together, to a third. Raises OSError, sqlite3.Error.
    """
    own = kept().own
    if own is None:
        raise OSError(f"there is no store of compiled code: {kept().trouble}")
    if file.exists() and file.samefile(own.file):
        raise OSError(f"{file} is the store itself; expected another file")
    file.parent.mkdir(parents=True, exist_ok=True)
    whole, file = file, file.with_name(f"{file.name}.part")
    file.unlink(missing_ok=True)
    version = version_line()
    made, number = Store(file, level=0), 0
    for key, entry in own.parts():
        codes = _with_called(own, entry.code)
        if codes and version in entry.needs and all(map(still_holds, entry.needs)):
            made.keep(key, entry, [code for code in codes if not made.has_code(code.hash)])
            number += 1
    made.finish()
    file.replace(whole)
    return number


def _with_called(store: Store, hash: str) -> list[Code]:
    """Code and all that it calls; nothing if any is missing."""
    found: dict[str, Code] = {}
    open_ = [hash]
    while open_:
        if (one := open_.pop()) not in found:
            if (code := store.code(one)) is None:
                return []
            found[one] = code
            open_ += code.called
    return list(found.values())
