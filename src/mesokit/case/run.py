"""How long a run is, how often it is made safe, and its log."""

from pydantic import field_validator

from mesokit.case import methods
from mesokit.case.component import component, nearest, one_of, param


@component
class Run:
    """Length of a run, its random numbers and its checkpoints."""

    steps: int = param(doc="steps to run after the warm-up", ge=0)
    warmup: int = param(0, doc="steps before them that no observable sees", ge=0)
    seed: int = param(1, doc="the same seed gives the same bits", ge=0, lt=2**56)
    replicas: int = param(
        1,
        doc="independent copies that run side by side, each from the next seed; results are those "
        "of all of them, frames and the log of the first",
        ge=1,
        le=4096,
    )
    method: str = param(methods.DEFAULT, doc="how the particles move")
    checkpoint_minutes: float = param(
        10.0, doc="write a checkpoint this often", unit="minutes", gt=0
    )
    checkpoint_every: int | None = param(
        None, doc="write a checkpoint every so many steps as well", ge=1
    )

    imbalance: float = param(
        0.05,
        doc="borders between ranks move where the work on both sides differs by more than this "
        "part of it; 1: never",
        ge=0,
        le=1,
    )

    @property
    def seeds(self) -> range:
        """Those of the replicas."""
        return range(self.seed, self.seed + self.replicas)

    @field_validator("method")
    @classmethod
    def _one_that_there_is(cls, name: str) -> str:
        if name not in methods.METHODS and name not in methods.modules():
            known = sorted(methods.modules())
            hint = nearest(name, known)
            raise ValueError(f"expected {one_of(known)}, or what an installed package brings{hint}")
        return name


@component
class Log:
    """Numbers in time: a line on the screen and in the file `log.csv` of the run's folder.

    Beside those of the method, such as `temperature` and `velocity x`, a column may be what an
    observable has found so far, as `velocity-profile.viscosity`; its error is a column of its own.
    """

    every: int = param(doc="steps between two lines, from step 0 of the warm-up on", ge=1)
    columns: tuple[str, ...] = param(
        (), doc="what is written with step and time (the usual columns of the method unless said)"
    )
