"""Methods of simulation, a folder each."""
