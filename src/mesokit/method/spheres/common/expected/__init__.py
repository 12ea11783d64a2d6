"""Theory of spheres that both methods share."""
