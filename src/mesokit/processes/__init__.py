"""Who runs a case together: one process, or the ranks that an MPI launcher has started."""
