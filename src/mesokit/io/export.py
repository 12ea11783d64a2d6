"""The trajectory of a run as a file for other programs."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import nearest, one_of, show
from mesokit.case.trajectory import Group, masses_and_kinds, names_and_diameters, written
from mesokit.errors import CaseError, RunError
from mesokit.io import contact_files, site_files
from mesokit.io.atomic import replacing
from mesokit.io.contact_records import FIELD
from mesokit.io.moments import Moment, Particles
from mesokit.io.run_directory import RunDirectory
from mesokit.io.site_files import Frames, SiteFrame, SiteWriter
from mesokit.io.trajectory import TrajectoryWriter
from mesokit.io.trajectory_reader import TrajectoryReader
from mesokit.seam.method import method_of

Array = NDArray[Any]


Reader = Callable[[], "TrajectoryReader | None"]
Writer = Callable[[Path, Particles, Iterator[Any]], None]
NO_IMAGES: Mapping[str, SiteWriter] = MappingProxyType({})


def export(
    directory: RunDirectory,
    case: Case,
    trajectory: Reader,
    path: str | Path,
    states: Sequence[str] | None = None,
    images: Mapping[str, SiteWriter] = NO_IMAGES,
) -> Path:
    """Write all frames of a run to a file in the format of its ending; an old file is replaced.

    Contacts of grains go to `.csv` or `.local`. Of sites, those in some `states` may be written
    alone; `images` are writers of pictures of them by ending. Returns the file; of a series the one
    that lists it, or the first. Of a run that has not ended, frames are those up to its last
    checkpoint. Raises CaseError for another ending, RunError without frames of places.
    """
    path, group = Path(path), _lattice(case)
    if group is not None:
        known = {".xyz": site_files.xyz, ".vti": site_files.vti, **images}
        write_sites = known[_known_ending(path, known)]
        sites = site_files.sites_of(group, states)
        return write_sites(path, sites, site_frames(directory, case, trajectory))
    if states is not None:
        raise CaseError(f"states = {show(list(states))}: only of sites of a lattice; leave it out")
    write = _writer_for(path, case)
    what: Iterator[Any]
    if path.suffix in contact_files.WRITERS:
        _require(directory, case, FIELD)
        particles, what = _contents(directory, case, trajectory)
    else:
        particles, what = contents(directory, case, trajectory)
    with replacing(path) as temporary:
        temporary.touch()  # with the usual permissions; gsd would give fewer
        write(temporary, particles, what)
    return path


def _lattice(case: Case) -> Group | None:
    """The group of sites, if there is one."""
    return next((group for group in case.groups if group.lattice is not None), None)


def site_frames(directory: RunDirectory, case: Case, trajectory: Reader) -> Frames:
    """A function that goes over all frames of sites. Raises RunError where there are none."""
    _require(directory, case, "site")
    next(iter(_contents(directory, case, trajectory)[1]))

    def frames() -> Iterator[SiteFrame]:
        for frame in _contents(directory, case, trajectory)[1]:
            yield SiteFrame(int(frame["step"]), float(frame["time"]), np.asarray(frame["site"]))

    return frames


def contents(
    directory: RunDirectory, case: Case, trajectory: Reader
) -> tuple[Particles, Iterator[Moment]]:
    """The particles of a run and all its frames. Raises RunError where there are none."""
    if _lattice(case) is not None:
        raise RunError(
            f"{directory.path}: it has sites, and no particles; export writes them as '.xyz'"
        )
    _require(directory, case, "position")
    particles, frames = _contents(directory, case, trajectory)
    return particles, (_moment(case, frame) for frame in frames)


def _require(directory: RunDirectory, case: Case, field: str) -> None:
    """Raise RunError unless a run keeps a trajectory with a field."""
    if case.trajectory is None:
        also = f' and fields = ["{field}"]' * (field != "position")
        raise RunError(
            f"{directory.path}: it keeps no trajectory; run it with a section [trajectory]{also}"
        )
    if field not in case.trajectory.fields:
        key = f"trajectory.fields = {show(case.trajectory.fields)}"
        raise RunError(f"{directory.path}: {key}: exports need {show(field)}")


def _known_ending(path: Path, known: Mapping[str, Any]) -> str:
    """The ending of a file. Raises CaseError for another one."""
    if path.suffix not in known:
        raise CaseError(
            f"{path}: ending {show(path.suffix)}: expected {one_of(list(known))}"
            f"{nearest(path.suffix, known)}"
        )
    return path.suffix


def _writer_for(path: Path, case: Case) -> Writer:
    from mesokit.io import gsd_file, h5md_file, mdanalysis, text_frames

    known: dict[str, Writer] = {
        ".gsd": gsd_file.write,
        ".lammpstrj": text_frames.dump,
        ".xyz": text_frames.xyz,
        ".h5md": h5md_file.write,
        **dict.fromkeys(mdanalysis.FRAMES, mdanalysis.write_frames),
        ".data": _write_data,
        **(contact_files.WRITERS if case.particles_have(FIELD) else {}),
    }
    _known_ending(path, known)
    if path.suffix == ".gsd":
        gsd_file.require()
    elif path.suffix in mdanalysis.FRAMES:
        mdanalysis.require()
    return known[path.suffix]


def _write_data(path: Path, particles: Particles, moments: Iterator[Moment]) -> None:
    """A data file of LAMMPS: a mass for each sphere, or for each kind of other particles."""
    from mesokit.io import mdanalysis, text_frames

    write = text_frames.data_of_spheres if particles.spheres else mdanalysis.write_last
    write(path, particles, moments)


def _contents(
    directory: RunDirectory, case: Case, trajectory: Reader
) -> tuple[Particles, Iterator[dict[str, Array]]]:
    """Particles and frames, of the data file or, while the run goes on, of its segments."""
    assert case.trajectory is not None
    if not directory.data_file.exists():
        folder = directory.trajectory_folder
        here = written(case.trajectory, case.groups)
        writer = TrajectoryWriter(case.trajectory, folder, *here, case.particles_have("diameter"))
        if writer.segments():
            mass, kind = masses_and_kinds(case.groups)
            kind, own = kind[writer.ids], writer.own
            particles = _particles(
                case, writer.ids, kind, own.get("mass", mass[kind]), own.get("diameter")
            )
            return particles, writer.frames()
    reader = trajectory()  # says what is missing where a run has not come so far
    if reader is None or not len(reader):
        raise RunError(
            f"{directory.path}: its trajectory has no frame; the run ended before the first"
        )
    frames = (reader[index] for index in range(len(reader)))
    return _particles(case, reader.id, reader.species, reader.mass, reader.diameter), frames


def _particles(
    case: Case, number: Array, kind: Array, mass: Array, diameter: Array | None
) -> Particles:
    """Constant properties; `diameter` (n,) of spheres, None for particles that have no size."""
    bonds = method_of(case).bonds(case) - (number[0] if len(number) else 0)
    bonds = bonds[((bonds >= 0) & (bonds < len(number))).all(axis=1)]
    size = np.ones(3)
    size[: case.box.dimension] = case.box.size
    closed = method_of(case).enclosure.closed_axes(case) | {*range(case.box.dimension, 3)}
    names, drawn = names_and_diameters(case.groups)
    kinds = [one for group in case.groups for one in group.kinds]
    return Particles(
        number=number,
        kind=kind,
        mass=mass,
        names=names,
        diameter=drawn[kind] if diameter is None else diameter,
        molecule=_molecules(len(number), bonds),
        bonds=bonds,
        dimension=case.box.dimension,
        size=size,
        closed=(0 in closed, 1 in closed, 2 in closed),
        spheres=diameter is not None,
        shapes={k: one.shape for k, one in enumerate(kinds) if one.shape is not None},
        inertia={k: one.inertia for k, one in enumerate(kinds) if one.inertia is not None},
    )


def _molecules(n: int, bonds: Array) -> NDArray[np.int64]:
    """The molecule of each particle, in the order of their first ones; -1 without bonds."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    molecule = np.full(n, -1)
    if len(bonds):
        linked = np.unique(bonds)
        rows = np.searchsorted(linked, bonds)
        links = coo_array((np.ones(len(rows)), rows.T), shape=(len(linked),) * 2)
        molecule[linked] = connected_components(links, directed=False)[1]
    return molecule


def _moment(case: Case, frame: dict[str, Array]) -> Moment:
    """A frame in the box of this moment, which is tilted under shear.

    Under shear mesokit takes x from 0 to L_x at any y. Here particles are moved by multiples of
    L_x into the tilted box, and images are counted along its edges. The tilt is the smallest one.
    """
    time, width = float(frame["time"]), float(case.box.size[0])
    position, velocity, image = (_with_z(frame.get(k)) for k in ("position", "velocity", "image"))
    assert position is not None
    tilt = 0.0
    if case.box.sheared:
        slid = case.box.displacement(time)
        tilt = slid - width * np.round(slid / width)
        position = position.astype(float)
        over = np.floor((position[:, 0] - tilt * position[:, 1] / case.box.size[1]) / width)
        position[:, 0] -= over * width
        if image is not None:
            image = image.copy()
            image[:, 0] += over.astype(int) + image[:, 1] * (tilt < 0)
    spin = frame.get("spin")
    if spin is not None and spin.ndim == 1:  # disks spin about z
        spin = np.pad(spin[:, None], ((0, 0), (2, 0)))
    return Moment(
        int(frame["step"]),
        time,
        float(tilt),
        position,
        velocity,
        image,
        spin,
        frame.get("orientation"),
    )


def _with_z(values: Array | None) -> Array | None:
    """Vectors (n, d) with three columns (n, 3); None stays None."""
    return None if values is None else np.pad(values, ((0, 0), (0, 3 - values.shape[1])))
