"""The package as a whole: examples are there, import is light and needs nothing else of mesokit."""

import subprocess
import sys

import mesokit.theory


def test_public_functions_have_examples():
    for name in mesokit.theory.__all__:
        thing = getattr(mesokit.theory, name)
        assert thing.__doc__
        assert isinstance(thing, type) or ">>>" in thing.__doc__, name


def test_import_is_light_and_independent():
    code = (
        "import sys, mesokit.theory;"
        "bad = [m for m in sys.modules if m.startswith(('scipy', 'numba', 'h5py', 'pydantic'))"
        " or m.startswith('mesokit.') and not m.startswith(('mesokit.theory', 'mesokit.stub'))];"
        "assert not bad, bad"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_laws_are_not_the_files_of_their_name():
    """Whichever is imported first."""
    code = (
        "from mesokit.theory.transport import takes_angle; from mesokit import theory;"
        "assert set(dir(theory)) == set(theory.__all__);"
        "assert all(callable(getattr(theory, name)) for name in theory.__all__)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
