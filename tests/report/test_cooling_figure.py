"""The figure of a gas that cools: its theory is smooth on a logarithmic axis."""

import numpy as np
import pytest

from mesokit import theory
from mesokit.report.figures import plot
from mesokit.seam.result import Result


@pytest.mark.parametrize("start", [0.0, 0.5])
def test_few_samples_make_no_kinks_in_haffs_law(start):
    time, haff, first = start + np.arange(0.0, 210.0, 30.0), 9.0, 2.5
    law = lambda t: first * theory.haff_temperature(t - start, haff)  # noqa: E731
    value = law(time)[:, None]
    result = Result(
        "granular-temperature", "g", {"time": time, "of": np.array(["translation"])}, value,
        np.full(value.shape, np.nan), "temperature", {"value": "", "time": "tau", "of": ""},
        expected=value, theory="Haff", samples=7, drawing="cooling",
    )  # fmt: skip
    (ax, *_) = plot(result).axes
    (line,) = [line for line in ax.lines if str(line.get_label()).startswith("theory")]
    x, y = line.get_data()
    assert len(x) >= 100 and np.ptp(np.diff(np.log(x))) < 1e-9
    np.testing.assert_allclose(y, law(x), rtol=1e-12)
    assert x[0] <= time[time > 0][0] and x[-1] == time[-1]
