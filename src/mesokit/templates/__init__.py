"""Cases that `mesokit new` writes."""
