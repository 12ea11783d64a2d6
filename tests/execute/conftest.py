"""Lets the tests of this folder import the laboratory of the laws."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent / "laws"))
