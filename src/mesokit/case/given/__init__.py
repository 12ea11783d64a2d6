"""Files of a case: arrays and snapshots from which a run starts, and their checks."""
