"""Files: the only place that knows HDF5."""
