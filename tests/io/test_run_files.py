"""What a run writes can be read back: by us, equal, and by MDAnalysis, the same particles."""

from __future__ import annotations

import subprocess
import sys
import warnings

import h5py
import numpy as np
import pytest

import mesokit
from mesokit import Conservation, Plates, Stress, TransverseModes, VelocityField, VelocityProfile
from mesokit.case.trajectory import Trajectory
from mesokit.errors import RunError
from mesokit.io import h5md
from mesokit.io.provenance import provenance
from mesokit.io.run_directory import RunDirectory
from mesokit.io.trajectory import TrajectoryWriter
from tests.helpers.fake_fluid import FakeFluid

OBSERVABLES = (
    Conservation(every=5), VelocityProfile(), VelocityField(), Stress(every=10), TransverseModes(),
)  # fmt: skip
EVERYTHING = ("position", "velocity", "image", "id")


def finished(tmp_path, make_case, size, trajectory=None, observe=OBSERVABLES, steps=50, **rest):
    """A run directory as a whole run leaves it, and the frames as they were."""
    case = make_case(size, observe=observe, trajectory=trajectory, **rest)
    run = RunDirectory.create(tmp_path / "run", case)
    fluid, frames = FakeFluid(case), []
    accumulators = [observable.accumulator(case) for observable in case.observe]
    writer = None
    if trajectory:
        writer = TrajectoryWriter(trajectory, run.trajectory_folder, case.particles)
    while fluid.step < steps:
        fluid.advance(5)
        d = fluid.dimension
        fluid.stress = {"kinetic": np.eye(d), "collisional": fluid.rng.normal(size=(d, d))}
        for observable, accumulator in zip(case.observe, accumulators, strict=True):
            if fluid.step % observable.every == 0:
                accumulator.observe(fluid)
        if writer and fluid.step % trajectory.every == 0:
            writer.record(fluid)
            frames.append((fluid.step, fluid.positions(), fluid.velocities(), fluid.images()))
            if fluid.step == 20:
                writer.flush()
    results = [accumulator.result() for accumulator in accumulators]
    record = provenance(case, threads=1)
    h5md.write(run.data_file, case, record, results, writer)
    run.write_provenance(record)
    if writer:
        writer.remove()
    return run, results, frames


@pytest.mark.parametrize("size", [(6, 6, 6), (6, 8)])
def test_everything_comes_back_equal(tmp_path, make_case, size):
    trajectory = Trajectory(every=10, fields=EVERYTHING, precision="float64")
    run, results, frames = finished(tmp_path, make_case, size, trajectory)
    files = mesokit.open(run.path)
    assert list(files.results.values()) == sorted(results, key=lambda r: r.name)
    assert files["velocity-profile"].comparisons == results[1].comparisons
    assert files.case == make_case(size, observe=OBSERVABLES, trajectory=trajectory)
    assert files.provenance["seed"] == 1 and "numpy" in files.provenance["versions"]
    with pytest.raises(KeyError, match="there are conservation"):
        files["velocity"]
    assert len(files.trajectory) == len(frames) == 5
    for i, (step, position, velocity, image) in enumerate(frames):
        frame = files.trajectory[i]
        assert frame["step"] == step
        np.testing.assert_array_equal(frame["position"], position)
        np.testing.assert_array_equal(frame["velocity"], velocity)
        np.testing.assert_array_equal(frame["image"], image)
    assert "5 frames of" in repr(files)
    assert sorted(p.name for p in run.path.iterdir()) == ["case.toml", "provenance.json", "run.h5"]


@pytest.mark.parametrize("size", [(6, 6, 6), (6, 8)])
def test_mdanalysis_reads_the_trajectory(tmp_path, make_case, size):
    trajectory = Trajectory(every=10, fields=("position", "velocity"))
    walls = [Plates(axis="y")] if len(size) == 2 else []
    observe = [o for o in OBSERVABLES if o.quantity not in ("stress", "transverse-modes")]
    run, _, frames = finished(tmp_path, make_case, size, trajectory, observe, walls=walls)
    universe, n, d = universe_of(run), len(frames[0][1]), len(size)
    assert universe.trajectory.n_frames == 5
    for seen, (step, position, velocity, _) in zip(universe.trajectory, frames, strict=True):
        assert seen.data["step"] == step and seen.time == pytest.approx(0.1 * step)
        np.testing.assert_allclose(seen.positions[:, :d], position, atol=1e-5)
        np.testing.assert_allclose(seen.velocities[:, :d], velocity, atol=1e-6)
        assert (seen.positions[:, d:] == 0).all() and seen.n_atoms == n
        assert seen.dimensions == pytest.approx([*size, *[1] * (3 - d), 90, 90, 90])
        energy = 0.5 * (velocity**2).sum()
        assert seen.data["conservation/kinetic_energy"] == pytest.approx(energy)


def test_mdanalysis_reads_sheared_boxes(tmp_path, make_case):
    trajectory = Trajectory(every=10)
    run, _, frames = finished(
        tmp_path, make_case, (6, 6, 6), trajectory, OBSERVABLES[:2], shear_rate=0.1
    )
    for seen, (step, *_) in zip(universe_of(run).trajectory, frames, strict=True):
        slid = 0.1 * 6 * 0.1 * step
        edges = seen.triclinic_dimensions
        assert edges[0] == pytest.approx([6, 0, 0], abs=1e-5)
        assert edges[1] == pytest.approx([(slid + 3) % 6 - 3, 6, 0], abs=1e-4)


def universe_of(run):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of its own dependencies
        import MDAnalysis

        with h5py.File(run.data_file) as file:
            n = len(file["particles/fluid/id"])
        universe = MDAnalysis.Universe.empty(n, trajectory=False)
        universe.load_new(str(run.data_file), format="H5MD", convert_units=False)
    return universe


def test_the_file_is_h5md(tmp_path, make_case):
    trajectory = Trajectory(every=10, fields=EVERYTHING, subset=20)
    run, *_ = finished(tmp_path, make_case, (6, 8), trajectory, observe=OBSERVABLES[:2])
    with h5py.File(run.data_file) as file:
        assert list(file["h5md"].attrs["version"]) == [1, 1]
        assert {"name", "version"} <= set(file["h5md/creator"].attrs)
        assert "name" in file["h5md/author"].attrs
        fluid = file["particles/fluid"]
        assert fluid["box"].attrs["dimension"] == 3 and fluid.attrs["dimension"] == 2
        assert list(fluid["box"].attrs["boundary"]) == ["periodic"] * 3
        for name in ("position", "velocity", "image", "box/edges"):
            element = fluid[name]
            assert set(element) == {"step", "time", "value"}
            assert len(element["step"]) == len(element["time"]) == len(element["value"]) == 5
        assert fluid["position/value"].shape == (5, 20, 3)
        assert fluid["position/value"].dtype == np.float32
        assert fluid["id"][:].tolist() == list(range(20))
        assert fluid["mass"].shape == fluid["species"].shape == (20,)
        energy = file["observables/conservation/kinetic_energy"]
        assert energy["step"][:].tolist() == fluid["position/step"][:].tolist()


def test_ending_twice_keeps_the_trajectory(tmp_path, make_case):
    """A finished run that is resumed has no segments any more, only its data file."""
    trajectory = Trajectory(every=10)
    run, results, frames = finished(tmp_path, make_case, (6, 6), trajectory, OBSERVABLES[:2])
    case = mesokit.open(run.path).case
    writer = TrajectoryWriter(trajectory, run.trajectory_folder, case.particles)
    writer.resume(50)
    h5md.write(run.data_file, case, {}, results, writer)
    files = mesokit.open(run.path)
    assert len(files.trajectory) == 5
    np.testing.assert_allclose(files.trajectory[4]["position"], frames[4][1], atol=1e-5)
    with h5py.File(run.data_file) as file:
        assert len(file["observables/conservation/temperature/value"]) == 5


def test_time_series_that_miss_a_frame_are_no_observables(tmp_path, make_case):
    """Readers would take row i for frame i."""
    observe = (Conservation(every=25),)
    run, results, _ = finished(tmp_path, make_case, (6, 6), Trajectory(every=10), observe)
    with h5py.File(run.data_file) as file:
        assert "observables" not in file
    assert mesokit.open(run.path)["conservation"] == results[0]


def test_no_trajectory(tmp_path, make_case):
    run, *_ = finished(tmp_path, make_case, (6, 6), None, OBSERVABLES[:2])
    assert mesokit.open(run.path).trajectory is None


def test_resume_drops_what_came_after_the_checkpoint(tmp_path, make_case):
    case = make_case((4, 4), trajectory=Trajectory(every=1))
    fluid = FakeFluid(case)
    writer = TrajectoryWriter(case.trajectory, tmp_path / "trajectory", case.particles)
    written = {}
    for stop in (5, 10, 15):
        while fluid.step < stop:
            fluid.advance()
            writer.record(fluid)
            written[fluid.step] = fluid.positions()
        writer.flush()
    again = TrajectoryWriter(case.trajectory, tmp_path / "trajectory", case.particles)
    again.resume(12)  # within a segment
    assert again.steps().tolist() == list(range(1, 13))
    again.resume(10)
    assert again.steps().tolist() == list(range(1, 11))
    again.resume(0)
    assert again.segments() == []


def test_many_frames_do_not_stay_in_memory(tmp_path, make_case, monkeypatch):
    from mesokit.io import trajectory

    monkeypatch.setattr(trajectory, "LARGEST", 2000)
    case = make_case((4, 4), trajectory=Trajectory(every=1))
    writer = TrajectoryWriter(case.trajectory, tmp_path / "trajectory", case.particles)
    fluid = FakeFluid(case)
    for _ in range(40):
        fluid.advance()
        writer.record(fluid)
        assert writer._bytes < 2000
    assert len(writer.segments()) > 3
    assert writer.steps().tolist() == list(range(1, 41))
    assert [int(f["step"]) for f in writer.frames()] == list(range(1, 41))


def test_particles_stay_below_the_upper_face_in_single_precision(tmp_path, make_case):
    case = make_case((4, 4), trajectory=Trajectory(every=1))
    fluid = FakeFluid(case)
    fluid.unwrapped[0] = 4 - 1e-12
    writer = TrajectoryWriter(case.trajectory, tmp_path, case.particles)
    writer.record(fluid)
    assert (next(writer.frames())["position"] < 4).all()


def test_damaged_files_are_one_line(tmp_path, make_case):
    run, *_ = finished(tmp_path, make_case, (6, 6), Trajectory(every=10), OBSERVABLES[:2])
    whole = run.data_file.read_bytes()
    run.data_file.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(RunError, match=r"^[^\n]*run.h5: damaged[^\n]*$"):
        _ = mesokit.open(run.path).results
    run.data_file.unlink()
    with pytest.raises(RunError, match="has not ended"):
        _ = mesokit.open(run.path).results
    assert "not ended" in repr(mesokit.open(run.path))
    writer = TrajectoryWriter(Trajectory(every=1), tmp_path / "t", 4)
    (tmp_path / "t").mkdir()
    (tmp_path / "t" / "segment-000000000000001.npz").write_bytes(b"half")
    with pytest.raises(RunError, match="damaged"):
        list(writer.frames())


def test_full_disk_at_the_end_keeps_the_segments(tmp_path, make_case, monkeypatch):
    def full(*args, **kwargs):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    case = make_case((4, 4))
    with pytest.raises(RunError, match="no space left"):
        h5md.write(tmp_path / "run.h5", case, {}, [])
    assert list(tmp_path.iterdir()) == []


def test_folders_that_are_refused(tmp_path, make_case):
    case = make_case((4, 4))
    RunDirectory.create(tmp_path / "a", case)
    with pytest.raises(RunError, match="not empty; resume that run or choose another"):
        RunDirectory.create(tmp_path / "a", case)
    (tmp_path / "file").write_text("")
    with pytest.raises(RunError, match="cannot make the folder"):
        RunDirectory.create(tmp_path / "file", case)
    with pytest.raises(RunError, match="cannot make the folder"):
        RunDirectory.create(tmp_path / "file" / "b", case)
    with pytest.raises(RunError, match="no such folder"):
        mesokit.open(tmp_path / "nowhere")
    (tmp_path / "empty").mkdir()
    with pytest.raises(RunError, match="holds no run"):
        mesokit.open(tmp_path / "empty")
    RunDirectory.create(tmp_path / "empty", case)  # an empty folder is welcome


def test_several_folders_are_no_run():
    with pytest.raises(RunError, match=r"^[^\n]*mesokit.merge[^\n]*$"):
        mesokit.open(["a", "b"])


@pytest.mark.skipif(sys.platform == "win32", reason="no limit of the size of files")
def test_hdf5_reads_back_what_the_disk_refused(tmp_path):
    """Else it takes zeros for its own records, and may end the process."""
    program = """
import resource, signal
import numpy as np
from mesokit.io.hdf5 import made

signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (5000, resource.getrlimit(resource.RLIMIT_FSIZE)[1]))
try:
    with made("out.h5") as (file, check):
        for k in range(300):
            file[f"group {k}/numbers"] = np.arange(50) + k
        file.flush()
        print(all(file[f"group {k}/numbers"][49] == 49 + k for k in range(300)))
        check()
        print("unreachable")
except OSError as error:
    print(error.strerror)
"""
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == ["True", "File too large"]


@pytest.mark.parametrize("size", [3_000, 60_000, 400_000])
@pytest.mark.skipif(sys.platform == "win32", reason="no limit of the size of files")
def test_a_disk_that_is_full_ends_in_one_line_and_loses_nothing(tmp_path, size):
    """A limit on the size of files stands for it, in a process that HDF5 could bring down."""
    program = f"""
import resource, signal
import mesokit.io.h5md as h5md
from mesokit import *

signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
case = Case(
    run=Run(steps=100), box=Box([32, 32]), observe=[Conservation(every=10)],
    trajectory=Trajectory(every=2),
)
write, (_, most) = h5md.write, resource.getrlimit(resource.RLIMIT_FSIZE)
def limited(*given, **more):
    resource.setrlimit(resource.RLIMIT_FSIZE, ({size}, most))
    try:
        return write(*given, **more)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))
h5md.write = limited
try:
    Simulation(case, output="run").run(progress=False)
except RunError as error:
    print(error)
h5md.write = write
print(Simulation.resume("run").run(progress=False) is not None)
"""
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0 and not done.stderr, done.stderr
    assert done.stdout.splitlines()[0] == "cannot write run/run.h5: file too large"
    assert len(mesokit.open(tmp_path / "run").trajectory) == 51
