"""The loops of a flock."""
