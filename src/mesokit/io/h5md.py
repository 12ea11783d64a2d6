"""The data file of a run: H5MD 1.1 (de Buyl, Colberg and Hofling, CPC 185, 1546 (2014)).

/h5md        version, author, creator
/parameters  case (TOML) and provenance (JSON); units: what a reduced unit is in SI, if known
/connectivity  bonds (bonds, 2): places, in the rows of particles, of those that are linked; and
             contacts of each frame, whose forces are under /contacts (see `h5md_contacts`)
/particles   one group, such as fluid: box, position, velocity, spin (angular velocity), image with
             step, time and value; id, mass, species, and radius of spheres; of a lattice the
             state of each site (frames, sites), in the order of the axes of the box
/observables time series, one row for each frame of the trajectory if there is one
/results     what each observable measured: value, error, expected, fit, x, comparisons

What readers want decides three things. Coordinates on disk always have three columns, in 2D with
z = 0 in a box one cell high (`dimension` of the group says 2); disks spin about z. Lengths and
times are in units that have no SI name; their attribute is `reduced_unit`, as readers refuse a
`unit` that they do not know (MDAnalysis: convert_units=False). Readers take row i of an observable
to belong to frame i, so that profiles and correlations are kept under /results, and /observables
leaves out what was not sampled at every frame.

Under Lees-Edwards shear the box is written as a triclinic one, whose second edge leans by how far
the images have slid: that of the nearest image, between -L/2 and L/2.
"""

import json
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import name_of
from mesokit.case.trajectory import Trajectory, kinds_of, names_and_diameters
from mesokit.io.atomic import replacing
from mesokit.io.contact_records import FIELD
from mesokit.io.h5md_contacts import REST, ContactSets, contacts_of, has_contacts
from mesokit.io.h5md_contacts import UNITS as UNITS_OF_CONTACTS
from mesokit.io.hdf5 import made, opened
from mesokit.io.trajectory import TrajectoryWriter
from mesokit.seam.in_units import units_of
from mesokit.seam.method import method_of
from mesokit.seam.result import Comparison, Result

UNITS = {"position": "a", "velocity": "a/tau", "spin": "1/tau", "time": "tau", "radius": "a"}
FIELDS = ("position", "velocity", "spin", "orientation", "image", "site")
WIDTHS: dict[str, tuple[int, ...]] = {"site": (), "orientation": (4,)}  # of the others (3,)
DTYPES = {"image": np.int32, "site": np.int16}  # of the others by the precision of the trajectory
CHUNK = 65536  # particles
LARGE = 2**20  # numbers of one result, beyond which it is compressed
_TABLE = ("what", "measured", "error", "expected", "unit", "note", "inverse")


def write(
    path: str | Path,
    case: Case,
    provenance: Mapping[str, Any],
    results: Iterable[Result],
    trajectory: TrajectoryWriter | None = None,
) -> None:
    """Write the data file whole, or leave the old one. Frames are copied one by one.

    Raises RunError if it cannot be written.
    """
    with replacing(path) as temporary, made(temporary) as (file, check):
        _header(file, case, provenance)
        steps = None
        if trajectory is not None:
            steps = trajectory.steps()
            if len(steps) or not _kept(file, path):
                _particles(file, case, trajectory, steps, check)
            else:
                steps = particles_of(file)["box/edges/step"][()]
        measured = file.create_group("results")
        for result in results:
            _result(measured, result)
            _time_series(file, result, steps)


def read_results(path: str | Path) -> dict[str, Result]:
    """Results by name, equal to what was written. Raises RunError for a damaged file."""
    with opened(path) as file:
        return {name: _read_result(group) for name, group in file["results"].items()}


def frame_steps(path: str | Path) -> NDArray[np.int64]:
    """Steps of the frames in a data file. Raises RunError for a damaged file."""
    with opened(path) as file:
        group = particles_of(file)
        steps = [] if group is None else group["box/edges/step"][()]
        return np.asarray(steps, np.int64)


def frames(path: str | Path) -> Iterator[dict[str, NDArray[Any]]]:
    """The frames in a data file, one by one, as they were recorded. Raises RunError."""
    with opened(path) as file:
        group = particles_of(file)
        if group is None:
            return
        clock, d = group["box/edges"], int(group.attrs["dimension"])
        fields = [name for name in FIELDS if name in group]
        for index in range(len(clock["step"])):
            frame = {name: in_frames(group[name]["value"], index, name, d) for name in fields}
            if has_contacts(file):
                frame[FIELD] = contacts_of(file, index, d)
            yield {"step": clock["step"][index], "time": clock["time"][index], **frame}


def own(path: str | Path) -> dict[str, NDArray[Any]]:
    """Masses and diameters (n,) of spheres in a data file, {} for others. Raises RunError."""
    with opened(path) as file:
        group = particles_of(file)
        if group is None or "radius" not in group:
            return {}
        return {"mass": group["mass"][()], "diameter": 2 * group["radius"][()]}


def in_frames(data: Any, frames: Any, field: str, dimension: int) -> NDArray[Any]:
    """A field in some frames, with the columns that the dimension leaves out taken away."""
    found = np.asarray(data[frames])
    return found if field in WIDTHS else found[..., columns(field, dimension)]


def columns(field: str, dimension: int) -> Any:
    """The columns, of three, that a field uses; disks spin about z."""
    return 2 if field == "spin" and dimension == 2 else slice(dimension)


def particles_of(file: Any) -> Any:
    """The group of the particles in a data file, None without a trajectory."""
    return next(iter(file["particles"].values())) if "particles" in file else None


def standard_header(file: Any, version: str, author: str = "unknown") -> None:
    """The group that H5MD requires."""
    head = file.create_group("h5md")
    head.attrs["version"] = np.array([1, 1], np.int32)
    head.create_group("author").attrs["name"] = author
    head.create_group("creator").attrs.update({"name": "mesokit", "version": version})


def standard_box(group: Any, closed: Sequence[bool]) -> Any:
    """The box of a group of particles, with its boundaries along three axes."""
    box = group.create_group("box")
    boundary = ["none" if shut else "periodic" for shut in closed]
    box.attrs["dimension"] = 3
    box.attrs["boundary"] = np.array(boundary, dtype=h5py.string_dtype("ascii"))
    return box


def _header(file: Any, case: Case, provenance: Mapping[str, Any]) -> None:
    version = str(provenance.get("versions", {}).get("mesokit", "unknown"))
    standard_header(file, version, str(provenance.get("author", "unknown")))
    parameters = file.create_group("parameters")
    parameters["case"] = case.to_toml()
    parameters["provenance"] = json.dumps(provenance)
    if provenance.get("units"):
        scales = {k: v for k, v in provenance["units"].items() if k != "numbers"}
        parameters.create_group("units").attrs.update(scales)


def _kept(file: Any, path: str | Path) -> bool:
    """Copy the frames from the old data file of a run that had ended; false without one."""
    if not Path(path).exists():
        return False
    with opened(path) as old:
        for name in ("particles", "connectivity", REST):
            if name in old:
                old.copy(name, file, expand_refs=False)
        for linked in file.get("connectivity", {}).values():
            linked.attrs["particles_group"] = particles_of(file).ref
        return "particles" in old


# --- particles ----------------------------------------------------------------------------------


def _particles(
    file: Any,
    case: Case,
    trajectory: TrajectoryWriter,
    steps: NDArray[np.int64],
    check: Callable[[], None],
) -> None:
    group = file.create_group(f"particles/{case.groups[0].name}")
    n, frames, kept = trajectory.number, len(steps), trajectory.trajectory
    units = {name: units_of(case).of(unit) for name, unit in UNITS.items()}
    group.attrs["dimension"] = case.box.dimension
    own = trajectory.own
    _identities(group, case, trajectory, own)
    if "diameter" in own:
        group["radius"] = 0.5 * own["diameter"]
        group["radius"].attrs["reduced_unit"] = units["radius"]
    group["species"].attrs["names"] = names_and_diameters(case.groups)[0]
    bonds = method_of(case).bonds(case)
    if len(bonds):  # rows of the trajectory whose particles are linked
        rows = bonds - trajectory.first
        rows = rows[((rows >= 0) & (rows < n)).all(axis=1)]
        links = file.require_group("connectivity")
        links = links.create_dataset("bonds", data=rows, compression=4)
        links.attrs["particles_group"] = group.ref
    group["step"] = steps
    group.create_dataset("time", (frames,), float).attrs["reduced_unit"] = units["time"]
    sets = {}
    for name in [name for name in kept.fields if name not in ("id", FIELD)]:
        deep = WIDTHS.get(name, (3,))
        packed: dict[str, Any] = {}
        if frames and n:
            packed = {"chunks": (1, min(n, CHUNK), *deep), "shuffle": bool(kept.compression)}
            packed["compression"] = kept.compression or None
        dtype = DTYPES.get(name, kept.precision)
        element = _element(group, name, group)
        sets[name] = element.create_dataset("value", (frames, n, *deep), dtype, **packed)
        if name in UNITS:
            sets[name].attrs["reduced_unit"] = units[name]
    contacts = _contacts(file, case, group, kept)
    edges = _box(group, case, frames)
    # Frame by frame and in chunks of particles, so memory does not grow with the run. H5MD has
    # three components, so in 2D the missing one is 0.
    for index, frame in enumerate(trajectory.frames()):
        check()
        group["time"][index] = frame["time"]
        edges[index] = _edges(case, float(frame["time"]), edges.shape[1:])
        if contacts is not None:
            contacts.add(index, frame[FIELD])
        for name, data in sets.items():
            for start in range(0, n, CHUNK):
                part = frame[name][start : start + CHUNK]
                if name not in WIDTHS:
                    wide = np.zeros((len(part), 3), data.dtype)
                    wide[:, columns(name, case.box.dimension)] = part
                    part = wide
                data[index, start : start + len(part)] = part
    del group["step"], group["time"]  # the elements have linked them


def _contacts(file: Any, case: Case, group: Any, kept: Trajectory) -> ContactSets | None:
    """Datasets for the contacts of all frames, None where the trajectory has none."""
    if FIELD not in kept.fields:
        return None
    units = {name: units_of(case).of(unit) for name, unit in UNITS_OF_CONTACTS.items()}
    packed = {"compression": kept.compression or None, "shuffle": bool(kept.compression)}
    return ContactSets(file, group, packed, kept.precision, units)


def _identities(
    group: Any, case: Case, trajectory: TrajectoryWriter, own: Mapping[str, Any]
) -> None:
    """Id, mass and kind of each particle, in chunks."""
    n = trajectory.number
    masses = np.array([kind.mass for one in case.groups for kind in one.kinds], float)
    sets = {
        name: group.create_dataset(name, (n,), kind)
        for name, kind in (("id", np.int64), ("mass", float), ("species", np.int64))
    }
    for start in range(0, n, CHUNK):
        rows = slice(start, min(start + CHUNK, n))
        ids = trajectory.first + np.arange(rows.start, rows.stop)
        kinds = kinds_of(case.groups, ids)
        sets["id"][rows], sets["species"][rows] = ids, kinds
        sets["mass"][rows] = own["mass"][rows] if own else masses[kinds]


def _element(parent: Any, name: str, clock: Any) -> Any:
    """A group whose step and time are links to those of all other groups."""
    element = parent.create_group(name)
    element["step"], element["time"] = clock["step"], clock["time"]
    return element


def _box(group: Any, case: Case, frames: int) -> Any:
    closed = method_of(case).enclosure.closed_axes(case)
    box = standard_box(group, [axis in closed for axis in range(3)])
    shape = (frames, 3, 3) if case.box.sheared else (frames, 3)
    if case.box.sheared:
        steady, oscillation = case.box.steady_rate, case.box.oscillation
        if steady:
            box.attrs["lees_edwards_shear_rate"] = steady
        elif oscillation:
            box.attrs["lees_edwards_shear_rate"] = oscillation.rate
            box.attrs["lees_edwards_shear_frequency"] = oscillation.frequency
        else:
            box.attrs["lees_edwards_shear"] = name_of(case.box.history)
    edges = _element(box, "edges", group).create_dataset("value", shape, float)
    edges.attrs["reduced_unit"] = units_of(case).length
    return edges


def _edges(case: Case, time: float, shape: tuple[int, ...]) -> NDArray[np.float64]:
    size = np.ones(3)
    size[: case.box.dimension] = case.box.size
    if len(shape) == 1:
        return size
    edges = np.diag(size)
    slid = case.box.displacement(time)
    edges[1, 0] = slid - size[0] * np.round(slid / size[0])
    return edges


# --- observables and results --------------------------------------------------------------------


def _time_series(file: Any, result: Result, steps: NDArray[np.int64] | None) -> None:
    """Rows of a time series under /observables, those of the frames if there are any."""
    if list(result.x) != ["time", "component"] or "step" not in result.extra:
        return
    own = np.asarray(result.extra["step"]).astype(np.int64)
    rows = np.arange(len(own))
    if steps is not None:
        if not np.isin(steps, own).all():
            return
        rows = np.searchsorted(own, steps)
    for column, name in enumerate(result.x["component"]):
        element = file.create_group(f"observables/{result.name}/{name}")
        element["step"], element["time"] = own[rows], result.x["time"][rows]
        element["value"] = result.value[rows, column]
        element["value"].attrs["reduced_unit"] = result.units.get(str(name), "")


def _result(parent: Any, result: Result) -> None:
    group = parent.create_group(result.name)
    group.attrs["quantity"], group.attrs["label"] = result.quantity, result.label
    group.attrs["drawing"] = result.drawing
    group.attrs["theory"], group.attrs["samples"] = result.theory, result.samples
    group.attrs["units"] = json.dumps(dict(result.units))
    group.attrs["axes"] = json.dumps(list(result.x))
    group.create_group("x")
    for name, axis in result.x.items():
        _store(group["x"], name, axis)
    for name in ("value", "error", "expected", "fit"):
        if (array := getattr(result, name)) is not None:
            packed = {"compression": 4, "shuffle": True} if array.size > LARGE else {}
            group.create_dataset(name, data=array, **packed)
    table = group.create_group("comparisons")
    for name in _TABLE:
        _store(table, name, np.array([getattr(c, name) for c in result.comparisons]))
    extra = group.create_group("extra", track_order=True)
    for name, entry in result.extra.items():
        if isinstance(entry, np.ndarray):
            _store(extra, name, entry)
        else:
            extra.create_dataset(name, data=entry)


def _store(group: Any, name: str, array: NDArray[Any]) -> None:
    if array.dtype.kind == "U":
        group.create_dataset(name, data=array.astype(object), dtype=h5py.string_dtype())
    else:
        group[name] = array


def _load(data: Any) -> Any:
    if h5py.check_string_dtype(data.dtype):
        text = data.asstr()[()]
        return text if isinstance(text, str) else np.array(list(text), dtype=str)
    entry = data[()]
    return entry if isinstance(entry, np.ndarray) else entry.item()


def _read_result(group: Any) -> Result:
    attrs = group.attrs
    return Result(
        quantity=str(attrs["quantity"]),
        drawing=str(attrs["drawing"]),
        name=group.name.split("/")[-1],
        x={name: _load(group["x"][name]) for name in json.loads(attrs["axes"])},
        value=group["value"][()],
        error=group["error"][()],
        label=str(attrs["label"]),
        units=json.loads(attrs["units"]),
        expected=group["expected"][()] if "expected" in group else None,
        fit=group["fit"][()] if "fit" in group else None,
        theory=str(attrs["theory"]),
        comparisons=tuple(_comparisons(group["comparisons"])),
        samples=int(attrs["samples"]),
        extra={name: _load(group["extra"][name]) for name in group["extra"]},
    )


def _comparisons(table: Any) -> Iterator[Comparison]:
    columns = [_load(table[name]) for name in _TABLE if name in table]
    for what, measured, error, expected, unit, note, *inverse in zip(*columns, strict=True):
        numbers = float(measured), float(error), float(expected)
        # files of 0.2.0 and before have no last column
        yield Comparison(str(what), *numbers, str(unit), str(note), any(inverse))
