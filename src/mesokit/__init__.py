"""Mesoscale particle simulation: fluids by multi-particle collision dynamics.

The public names, a line for each in `__init__.pyi`, are imported when they are first used, so that
`import mesokit` is instant.
"""

import importlib
from typing import Any

from mesokit.stub import homes

__version__ = "0.2.0"

_HOME = homes(__file__)
__all__ = sorted(_HOME.keys() - {"open"})  # `import *` must not take Python's `open` away


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'mesokit' has no attribute {name!r}")
    module, inside = _HOME[name]
    if module == __name__:
        return importlib.import_module(f"{module}.{inside}")
    value = getattr(importlib.import_module(module), inside)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*_HOME, "__version__"])
