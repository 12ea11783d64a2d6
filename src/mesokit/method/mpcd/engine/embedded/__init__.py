"""Solutes that act on the particles of the fluid near them by a potential."""
