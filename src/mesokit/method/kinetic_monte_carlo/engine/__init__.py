"""The engine: how the next event and its time are chosen, and the loop over events."""
