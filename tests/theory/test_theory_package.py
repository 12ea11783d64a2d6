"""The package as a whole: examples are there, import is quick and needs nothing else of mesokit."""

import subprocess
import sys

import mesokit.theory


def test_public_functions_have_examples():
    for name in mesokit.theory.__all__:
        thing = getattr(mesokit.theory, name)
        assert thing.__doc__
        assert isinstance(thing, type) or ">>>" in thing.__doc__, name


def test_import_is_quick_and_independent():
    code = (
        "import sys, numpy, time; t = time.perf_counter(); import mesokit.theory;"
        "assert time.perf_counter() - t < 0.5;"
        "bad = [m for m in sys.modules if m.startswith(('scipy', 'numba', 'h5py'))];"
        "assert not bad, bad"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
