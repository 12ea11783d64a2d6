"""Compiled functions, made when first used: to read a case takes no compiler."""

import functools
import sys
import threading
from collections.abc import Callable
from typing import Any

_making = threading.RLock()


class Later:
    """A function as it is written, until compiled code or Python uses it.

    From then on it is, to numba and to all that looks at its class or its attributes, what `make`
    gave: a compiled function, an intrinsic, or a function with an overload.
    """

    def __init__(
        self, function: Callable, make: Callable[[], Any], chooser: Callable | None = None
    ) -> None:
        functools.update_wrapper(self, function)
        self._make, self._made = make, None
        self.chooser = chooser  # of the code, by the types of arguments

    @property
    def made(self) -> Any:
        """The function compiled by numba; made once, also for two threads at a time."""
        if self._made is None:
            with _making:
                self._made = self._made or self._make()
        return self._made

    @functools.cached_property
    def _numba_type_(self) -> Any:
        """The type of this name in compiled code."""
        from numba.core.registry import cpu_target

        made = self.made
        cpu_target.typing_context.refresh()  # it may have been made just now
        return cpu_target.typing_context.resolve_value_type(made)

    @property  # type: ignore[misc]
    def __class__(self) -> Any:
        """The class of what was made, for `isinstance`."""
        return type(self.made)

    def __call__(self, *arguments: Any) -> Any:
        return self.made(*arguments)

    def __reduce_ex__(self, protocol: Any) -> Any:
        """By its place, as functions are pickled; what has none, as what was made."""
        found: Any = sys.modules.get(self.__module__)
        for part in self.__qualname__.split("."):
            found = getattr(found, part, None)
        return self.__qualname__ if found is self else (_itself, (self.made,))

    def __getattr__(self, name: str) -> Any:
        return getattr(self.made, name)


def _itself(made: Any) -> Any:
    return made


def intrinsic(function: Callable) -> Any:
    """`numba.extending.intrinsic`, made when it is first used."""

    def make() -> Any:
        from numba.extending import intrinsic

        return intrinsic(function)

    return Later(function, make)


def kernel(function: Callable) -> Any:
    """`mesokit.kernels.kernel.kernel`, made when it is first used."""

    def make() -> Any:
        from mesokit.kernels.kernel import kernel

        return kernel(function)

    return Later(function, make)
