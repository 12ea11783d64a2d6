"""Body forces. A new one is a file here."""

from mesokit.case.registry import parts_in
from mesokit.method.mpcd.field.protocol import Force

__getattr__ = parts_in(__name__, RULES=Force)

__all__ = ["RULES", "Force"]
