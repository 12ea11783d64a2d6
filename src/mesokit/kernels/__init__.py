"""How compiled code is made and kept: parts, groups by address, the store, and warming it."""
