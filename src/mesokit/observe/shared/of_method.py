"""Observables whose theory is that of the method of a case."""

from typing import Any, ClassVar

from mesokit.case.case import Case
from mesokit.case.component import component, name_of
from mesokit.seam.method import method_of
from mesokit.seam.observable import Observable


@component
class OfMethod(Observable):
    """An observable of several methods, each of which has a theory of it (`Method.expected`)."""

    methods: ClassVar[tuple[str, ...]] = ("event-driven", "soft-spheres", "contact-dynamics")

    def theory(self, case: Case) -> Any:
        """Theory by the method of a case. Raises CaseError without anything to measure."""
        return method_of(case).expected[name_of(self)](case, self)

    def check(self, case: Case) -> None:
        """Raise CaseError without anything to measure."""
        self.theory(case)
