"""The law of a contact of rigid grains, one idea a file."""
