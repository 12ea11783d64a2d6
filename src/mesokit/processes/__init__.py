"""Processes that run a case together: one, or the ranks that an MPI launcher has started."""
