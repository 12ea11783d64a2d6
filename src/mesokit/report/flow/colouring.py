"""Meanings of the colours of disks and spheres. A new one is a function and a row of `COLOURS`."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import nearest, one_of, show
from mesokit.errors import CaseError, RunError
from mesokit.io.trajectory_reader import TrajectoryReader
from mesokit.observe.hexatic_order import psi_6
from mesokit.report import style
from mesokit.report.caption import rounded, symbols
from mesokit.report.flow.data import Array
from mesokit.report.flow.scale import Scale
from mesokit.report.flow.state import State
from mesokit.report.style import labelled
from mesokit.seam.method import method_of

REACH = 1.2  # times the sum of their radii: how far neighbours are apart at most
MUCH = 3.0  # times, by which speeds change
DECADES = 3  # that a logarithmic scale of speeds shows
MOST = 12  # neighbours with a colour of their own


class Frame(NamedTuple):
    """Spheres of a case at one time: by name what the trajectory holds, diameters, and kinds."""

    case: Case
    fields: dict[str, Any]
    diameters: Array
    kinds: NDArray[np.int64]


class Colouring(NamedTuple):
    """Number of each sphere, the scale of numbers up to a largest, and the fields it needs.

    `all`: whether all spheres must be in the trajectory. `counted`: whether numbers are whole.
    `remark`: words for what the numbers of a frame do not show.
    """

    numbers: Callable[[Frame], Array]
    scale: Callable[[Case, float], Scale]
    needs: tuple[str, ...] = ()
    all: bool = False
    counted: bool = False
    remark: Callable[[Frame], str] = lambda now: ""


def speed(now: Frame) -> Array:
    """Of the centre, in all directions."""
    return np.asarray(np.linalg.norm(now.fields["velocity"], axis=1))


def relative(now: Frame) -> Array:
    """Over the root mean square of the frame."""
    found, usual = speed(now), _usual(now)
    return found / usual if usual > 0 else found


def _usual(now: Frame) -> float:
    return float(np.sqrt((speed(now) ** 2).mean()))


def _remark(now: Frame) -> str:
    """The unit of relative speeds, in words."""
    return f"rms speed ${rounded(_usual(now), 2)}$ {symbols('a/tau')}"


def spin(now: Frame) -> Array:
    """Angular velocity of disks, which has a sign; how fast spheres turn."""
    found = np.asarray(now.fields["spin"])
    return found if found.ndim == 1 else np.asarray(np.linalg.norm(found, axis=1))


def neighbours(now: Frame) -> Array:
    """How many others are nearer than REACH times the sum of the radii."""
    from scipy.spatial import cKDTree

    case, radii = now.case, 0.5 * now.diameters
    if case.box.sheared:
        raise CaseError("colour = 'neighbours': not under shear, where images slide")
    size, closed = np.array(case.box.size, float), method_of(case).enclosure.closed_axes(case)
    periods = np.where([k in closed for k in range(len(size))], 0.0, size)
    places = np.asarray(now.fields["position"], float)
    tree = cKDTree(places, boxsize=periods)
    pairs = tree.query_pairs(2 * REACH * float(radii.max()), output_type="ndarray")
    separation = places[pairs[:, 0]] - places[pairs[:, 1]]
    separation -= periods * np.rint(separation / np.where(periods > 0, periods, 1.0))
    near = np.linalg.norm(separation, axis=1) < REACH * radii[pairs].sum(axis=1)
    return np.bincount(pairs[near].ravel(), minlength=len(places)).astype(float)


def hexatic(now: Frame) -> Array:
    """Size of psi_6, by Voronoi neighbours: 1 in a triangular lattice."""
    size, closed = np.array(now.case.box.size, float), method_of(now.case).enclosure.closed_axes
    if len(size) != 2 or now.case.box.sheared or closed(now.case):
        raise CaseError("colour = 'psi6': expected disks in a periodic 2D box without shear")
    return np.abs(psi_6(np.asarray(now.fields["position"], float), size))


def _speeds(case: Case, reach: float) -> Scale:
    return Scale(0.0, reach, "viridis", labelled("speed", "a/tau"))


def _decades(case: Case, reach: float) -> Scale:
    label = labelled("speed", "a/tau")
    return Scale(10.0**-DECADES * reach, reach, "viridis", label, logarithmic=True)


def _spins(case: Case, reach: float) -> Scale:
    if case.box.dimension == 3:
        return Scale(0.0, reach, "viridis", labelled("angular speed", "1/tau"))
    label = r"angular velocity ($\cdot$ > 0, $\times$ < 0)"
    return Scale(-reach, reach, "RdBu_r", labelled(label, "1/tau"))


def _counts(case: Case, reach: float) -> Scale:
    most = min(MOST, max(1, round(reach)))
    label = f"neighbours within {REACH} times the sum of radii"
    names = [f"{n}" for n in range(most + 1)]
    return _steps("viridis", [*names[:-1], names[-1] + "+" * (most == MOST)], label)


def _kinds(case: Case, reach: float) -> Scale:
    from matplotlib.colors import ListedColormap

    kinds = (each for group in case.groups for each in enumerate(group.kinds, start=1))
    names = [kind.name or f"kind {number}" for number, kind in kinds]
    chosen = [style.COLOURS[k % len(style.COLOURS)] for k in range(len(names))]
    return _steps(ListedColormap(chosen), names, "")


def _steps(colours: Any, names: list[str], label: str) -> Scale:
    """A colour for each whole number from 0."""
    import matplotlib as mpl
    from matplotlib.colors import ListedColormap

    spread = np.linspace(0, 1, len(names))
    table = ListedColormap(mpl.colormaps[colours](spread)) if isinstance(colours, str) else colours
    return Scale(-0.5, len(names) - 0.5, table, label, tuple(names))


COLOURS: dict[str, Colouring] = {
    "speed": Colouring(speed, _speeds, ("velocity",)),
    "log-speed": Colouring(speed, _decades, ("velocity",)),
    "relative-speed": Colouring(
        relative,
        lambda case, reach: Scale(0.0, reach, "viridis", "speed / rms speed of the frame"),
        ("velocity",),
        remark=_remark,
    ),
    "spin": Colouring(spin, _spins, ("spin",)),
    "neighbours": Colouring(neighbours, _counts, all=True, counted=True),
    "psi6": Colouring(
        hexatic, lambda case, reach: Scale(0.0, 1.0, "viridis", r"$|\psi_6|$"), all=True
    ),
    "kind": Colouring(lambda now: now.kinds.astype(float), _kinds, counted=True),
}


def in_film(reader: TrajectoryReader | None, colour: str | None) -> str | None:
    """The colour of a film, whose scale is the same in all frames: unless said logarithmic where
    speeds change by more than MUCH from the first frame to the last."""
    if colour or reader is None or reader.diameter is None or "velocity" not in reader.fields:
        return colour
    ends = [np.asarray(reader[k]["velocity"], float) for k in (0, len(reader) - 1)]
    first, last = (float((v**2).sum(axis=1).mean()) for v in ends)
    changes = not MUCH**-2 < last / first < MUCH**2 if first > 0 else last > 0
    return "log-speed" if changes else None


def chosen(case: Case, reader: TrajectoryReader | State, colour: str | None) -> Colouring | None:
    """The colouring of that name; unless said speeds, else kinds, else none.

    Raises CaseError for an unknown one, RunError where the trajectory lacks what it needs.
    """
    if colour is None:
        if "velocity" in reader.fields:
            return COLOURS["speed"]
        return COLOURS["kind"] if len(np.unique(reader.species)) > 1 else None
    if colour not in COLOURS:
        near = nearest(str(colour), list(COLOURS))
        raise CaseError(f"colour = {show(colour)}: expected {one_of(list(COLOURS))}{near}")
    found = COLOURS[colour]
    for field in found.needs:
        if field not in reader.fields:
            raise RunError(
                f"colour = {show(colour)}: the trajectory holds no {show(field)}; "
                f"add it to trajectory.fields and run the case again"
            )
    if found.all and len(reader.id) < case.particles:
        raise RunError(
            f"colour = {show(colour)}: the trajectory holds {len(reader.id)} of {case.particles} "
            "particles; leave out trajectory.subset and run the case again"
        )
    return found
