"""What a simulation shows of itself: in words, in a notebook, as pictures and films."""

from __future__ import annotations

from abc import abstractmethod
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mesokit.case import toml
from mesokit.case.component import require_known, show
from mesokit.case.describe.shown import Shown
from mesokit.seam.method import method_of

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.io.run_directory import RunDirectory
    from mesokit.report.flow import Film
    from mesokit.seam.result import Result


class Seen(Shown):
    """A case, how far it has come and what it has measured, to look at."""

    case: Case
    directory: RunDirectory | None
    engine: Any

    @property
    @abstractmethod
    def step(self) -> int:
        """Steps done, the warm-up included."""

    @property
    @abstractmethod
    def last_step(self) -> int:
        """The step at which the run ends, the warm-up included."""

    @property
    @abstractmethod
    def results(self) -> dict[str, Result]:
        """What all observables say so far, by name."""

    def __repr__(self) -> str:
        where = f", {self.directory.path}" if self.directory is not None else ""
        title = f" {show(self.case.title)}" if self.case.title else ""
        return f"<Simulation{title}: step {self.step} of {self.last_step}{where}>"

    def _card(self) -> dict[str, Any]:
        rows = [(key, text, "") for key, text in toml.given(self.case, method_of(self.case).keys)]
        return {
            "title": self.case.title or "simulation",
            "words": f"step {self.step} of {self.last_step}",
            "rows": rows,
            "results": self.results.values() if self.step > self.case.run.warmup else (),
        }

    def flow(self, kind: str | None = None, **choices: Any) -> Any:
        """A picture of the flow so far; `mesokit.report.flow.picture` says what may be chosen.

        `simulation.flow("particles")` works before the first step, too: it shows the solids, the
        molecules and where the particles are.
        """
        from mesokit.report.finish.origin import origin_of
        from mesokit.report.flow import CHOICES, State, picture

        require_known(choices, CHOICES)
        now = State(self.case, self.engine)
        figure = picture(self.case, self.results, now, kind, **choices)
        figure.origin = origin_of(self.case, self._name)
        return figure

    @property
    def _name(self) -> str:
        """What pictures call it: the folder, if there is one."""
        return "" if self.directory is None else self.directory.path.resolve().name

    def animate(self, path: str | Path, kind: str | None = None, **choices: Any) -> Film:
        """Write a film of the flow so far (MP4 or GIF by its ending)."""
        from mesokit.report.flow import CHOICES, animate

        require_known(choices, [*CHOICES, "fps", "progress"])
        return animate(self.case, self.results, None, path, kind, run=self._name, **choices)
