"""Packages that only some files need."""

import importlib
import warnings
from types import ModuleType

from mesokit.errors import CaseError


def package(module: str, what: str, extra: str = "files") -> ModuleType:
    """A module of a package that may not be there.

    Raises CaseError that says how to install it; `what` names what needs it, `extra` the
    group of packages of mesokit that has it.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of what these packages import themselves
            return importlib.import_module(module)
    except ImportError:
        name = module.split(".")[0]
        raise CaseError(f"{what} need the package {name}: pip install 'mesokit[{extra}]'") from None
