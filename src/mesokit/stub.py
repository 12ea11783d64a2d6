"""The names of a package, from the stub that stands beside its `__init__.py`."""

import ast
from pathlib import Path


def homes(init: str) -> dict[str, tuple[str, str]]:
    """Each name that the `.pyi` of an `__init__.py` lists: its module, and its name there.

    >>> import mesokit.theory
    >>> homes(mesokit.theory.__file__)["couette_velocity"]
    ('mesokit.theory.couette', 'couette_velocity')
    """
    stub = ast.parse(Path(init).with_suffix(".pyi").read_text(encoding="utf-8"))
    return {
        alias.asname or alias.name: (line.module or "", alias.name)
        for line in stub.body
        if isinstance(line, ast.ImportFrom)
        for alias in line.names
    }
