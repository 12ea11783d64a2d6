"""LAMMPS data files as people write them: any style and comment that LAMMPS takes."""

import numpy as np
import pytest

from mesokit.errors import CaseError
from mesokit.io.lammps_data import read

HEADER = """Atoms of a bed   # a title, whatever it says

2 atoms   # grains
2 atom types

-1.5 2.5 xlo xhi
0 3 ylo yhi # a comment
-0.5 0.5 zlo zhi
"""
ROWS = {
    "atomic": "{} 2 {}",
    "charge": "{} 2 0.5 {}",
    "bond": "{} 1 2 {}",
    "full": "{} 1 2 -0.25 {}",
    "sphere": "{} 2 0.5 2.5 {}",
    "bpm/sphere": "{} 1 2 0.5 2.5 {}",
}
PLACES = np.array([[1.0, 2.0, 0.25], [0.5, 1.0, 0.0]])


def written(path, row, heading, images="", comment="", more=""):
    """A file of two atoms, numbers 7 and 3."""
    lines = [
        row.format(number, " ".join(map(str, place))) + images + comment
        for number, place in zip((7, 3), PLACES.tolist(), strict=True)
    ]
    path.write_text("\n".join([HEADER, heading, "", *lines, more, ""]))
    return str(path)


@pytest.mark.parametrize("comment", ["", "  # a grain"])
@pytest.mark.parametrize("images", ["", " 1 0 -2"])
@pytest.mark.parametrize("style", ROWS)
def test_common_styles(tmp_path, style, images, comment):
    path = written(tmp_path / "a.data", ROWS[style], f"Atoms # {style}", images, comment)
    found = read(path)
    assert found.numbers.tolist() == [3, 7]
    np.testing.assert_array_equal(found.positions, PLACES[::-1])
    np.testing.assert_array_equal(found.low, [-1.5, 0, -0.5])
    np.testing.assert_array_equal(found.lengths, [4, 3, 1])
    assert (found.images is None) == (not images)
    round_ones = style.endswith("sphere")
    assert (found.diameters is None) == (not round_ones)
    if round_ones:
        np.testing.assert_allclose(found.masses, 2.5 * np.pi / 6 * 0.5**3)


@pytest.mark.parametrize("heading", ["Atoms", "Atoms # pebbles, by hand", "Atoms  #id type x y z"])
@pytest.mark.parametrize("style", ["atomic", "charge", "bond", "full", "sphere"])
def test_without_a_style_the_columns_tell(tmp_path, style, heading):
    named = read(written(tmp_path / "a.data", ROWS[style], f"Atoms # {style}"))
    found = read(written(tmp_path / "b.data", ROWS[style], heading))
    for one, other in zip(named, found, strict=True):
        np.testing.assert_array_equal(one, other)


def test_sections_that_are_of_no_use_are_passed_over(tmp_path):
    before = "Masses\n\n1 1.0 # C\n2 4.0\n\nPair Coeffs # lj/cut\n\n1 1.0 1.0\n2 1 1\n\nAtoms"
    after = "\nVelocities\n\n3 1 2 3\n7 4 5 6\n\nBonds\n\n1 1 3 7\n"
    found = read(written(tmp_path / "a.data", ROWS["bond"], before, more=after))
    assert found.masses.tolist() == [4.0, 4.0] and found.bonds.tolist() == [[0, 1]]
    np.testing.assert_array_equal(found.velocities, [[1, 2, 3], [4, 5, 6]])


@pytest.mark.parametrize("style", ["ellipsoid", "hybrid sphere", "dipole"])
def test_other_styles_are_refused(tmp_path, style):
    path = written(tmp_path / "a.data", ROWS["full"], f"Atoms # {style}")
    with pytest.raises(CaseError, match=rf"^atom style '{style.split()[0]}': expected 'atomic'"):
        read(path)


def test_lengths_are_scaled(tmp_path):
    velocities = "\nVelocities\n\n3 1 2 3 7 8 9\n7 4 5 6 7 8 9\n"
    path = written(tmp_path / "a.data", ROWS["sphere"], "Atoms", more=velocities)
    one, other = read(path), read(path).scaled(0.01)
    for name in ("positions", "low", "lengths", "diameters", "velocities"):
        np.testing.assert_allclose(getattr(other, name), 0.01 * getattr(one, name), rtol=1e-15)
    for name in ("masses", "spins", "numbers"):
        np.testing.assert_array_equal(getattr(other, name), getattr(one, name))
