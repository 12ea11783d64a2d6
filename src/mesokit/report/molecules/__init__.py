"""Pictures of molecules: in time, and how their numbers are distributed."""
