"""Files: the only place that uses HDF5."""
