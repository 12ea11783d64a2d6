"""Laws that the simulated fluids should obey: one subject a file, pure NumPy and SciPy.

Nothing here uses the rest of mesokit, so that it can judge it. Lengths are in cell sides a = 1.
The laws are listed in `__init__.pyi`. All are imported at once: many have the name of their file,
and the file would take the place of a law that is imported later.
"""

import importlib

from mesokit.stub import homes

_HOME = homes(__file__)
__all__ = sorted(_HOME)

for _law, (_module, _name) in _HOME.items():
    globals()[_law] = getattr(importlib.import_module(_module), _name)


def __dir__() -> list[str]:
    return __all__
