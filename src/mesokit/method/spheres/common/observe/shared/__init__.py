"""Geometry that several observables of spheres share."""
