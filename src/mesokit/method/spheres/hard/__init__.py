"""Event-driven dynamics: hard spheres fly freely from one collision to the next."""
