"""Pictures and films of birds: triangles along their headings, in a cyclic map of colours."""

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.quiver import Quiver

import mesokit
from mesokit import (
    AngularNoise,
    Box,
    CaseError,
    ClusterSizes,
    DensityBands,
    Disk,
    Flock,
    NumberFluctuations,
    PolarOrder,
    Run,
    RunError,
    Simulation,
    Trajectory,
)
from mesokit.report.flow import picture
from mesokit.report.flow.birds import colours

OBSERVED = [PolarOrder(every=1), NumberFluctuations(every=1), DensityBands(every=1)]
OBSERVED += [ClusterSizes(every=1)]


def flock(
    size=(16, 16), output=None, fields=("position", "velocity"), steps=20, noise=None, **parts
):
    simulation = Simulation(
        run=Run(steps=steps, method="flock"), box=Box(size), output=output,
        flock=Flock(density=1) if noise is None else Flock(density=1, noise=noise),
        trajectory=Trajectory(every=10, fields=fields), threads=1, **parts,
    )  # fmt: skip
    simulation.run()
    return simulation


def triangles(figure):
    (drawn,) = [part for part in figure.axes[0].get_children() if isinstance(part, Quiver)]
    return drawn


def test_each_bird_points_along_its_heading(tmp_path):
    simulation = flock(output=tmp_path / "run")
    drawn = triangles(mesokit.open(tmp_path / "run").flow())  # the kind of the method
    engine = simulation.engine
    np.testing.assert_allclose(drawn.get_offsets(), engine.positions(), atol=1e-5)
    along = np.stack([drawn.U, drawn.V], axis=1)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    np.testing.assert_allclose(along, engine.headings(), atol=1e-5)
    angle = np.arctan2(*engine.headings().T[::-1]) / np.pi
    np.testing.assert_allclose(drawn.get_facecolor(), colours()(0.5 * (angle + 1)), atol=0.03)


def test_a_simulation_in_memory_is_drawn_as_it_is():
    simulation = flock(walls=[Disk(centre=(8, 8), radius=3)])
    drawn = triangles(simulation.flow(region=((0, 8), (0, 16))))
    inside = simulation.engine.positions()
    inside = inside[inside[:, 0] <= 8]
    np.testing.assert_allclose(np.sort(drawn.get_offsets()[:, 0]), np.sort(inside[:, 0]))


def test_films_and_three_dimensions(tmp_path):
    flock((6, 6, 6), tmp_path / "run")
    files = mesokit.open(tmp_path / "run")
    assert files.animate(tmp_path / "film.gif").frames == 3
    assert triangles(files.flow(axes=("x", "z"))).N == 216


def test_what_is_missing_is_said_in_one_line(tmp_path):
    flock(output=tmp_path / "run", fields=["position"])
    files = mesokit.open(tmp_path / "run")
    with pytest.raises(RunError, match=r"positions and velocities.*fields = ") as error:
        files.flow(kind="flock")
    assert "\n" not in str(error.value)
    assert "and the run kept their positions alone; add" in str(error.value)
    with pytest.raises(RunError, match="velocities of particles, and the run kept none of them"):
        picture(files.case, {}, None, "flock")
    with pytest.raises(CaseError, match="kind = 'disks'"):
        files.flow(kind="disks")


def test_colours_go_round_and_are_told_apart_in_grey():
    table = colours()(np.linspace(0, 1, 256))[:, :3]
    assert np.abs(table[0] - table[-1]).max() < 0.05
    assert np.abs(np.diff(table, axis=0)).max() < 0.08
    grey = table @ [0.2126, 0.7152, 0.0722]
    assert grey.min() < 0.35 < 0.55 < grey.max() < 0.75
    left, right = grey[:128], grey[:127:-1]  # directions to either side of the first axis
    apart = abs(left - right)[13:116]  # but for those along it
    assert (apart > 0.03).all() and apart[51] > 0.15


def test_every_result_has_a_figure(tmp_path):
    simulation = flock(observe=OBSERVED)
    for result in simulation.results.values():
        figure = result.plot()
        assert figure.axes
        figure.savefig(tmp_path / f"{result.name}.png")
        assert result.plot(mpl.figure.Figure().subplots()) is not None


@pytest.mark.parametrize("noise", [1.0, 2 * np.pi])
def test_ordered_flocks_have_a_guide_to_giant_fluctuations(noise):
    """A slope of 0.8 through the middle of the last points, dashed; not beside birds at random.

    Powers are straight lines, as both axes are logarithmic.
    """
    simulation = flock(noise=AngularNoise(noise), steps=200, observe=OBSERVED)
    result = simulation["number-fluctuations"]
    (ax,) = result.plot().axes
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "log")
    guides = [line for line in ax.lines if "Toner and Tu" in str(line.get_label())]
    [random] = [line for line in ax.lines if "birds at random" in str(line.get_label())]
    mean, (n, spread) = result.x["mean number"], random.get_xydata().T
    assert len(n) == 200 and np.interp(mean, n, spread) == pytest.approx(result.expected, rel=1e-3)
    if noise > 6:
        assert not guides
        return
    (guide,) = guides
    x, y = np.log(guide.get_xydata()).T
    np.testing.assert_allclose(np.diff(y) / np.diff(x), 0.8)
    middle = np.log(mean[-4:]).mean()
    assert np.interp(middle, x, y) == pytest.approx(np.log(result.value[-4:]).mean())
    assert guide.get_linestyle() == "--"
