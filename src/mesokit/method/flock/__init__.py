"""Flocks: birds that fly as the others around them do (Vicsek et al. 1995)."""

from mesokit.method.flock.cohesion import Cohesion
from mesokit.method.flock.noise.angular import AngularNoise
from mesokit.method.flock.noise.vectorial import VectorialNoise
from mesokit.method.flock.section import Flock, FlockStart

__all__ = ["AngularNoise", "Cohesion", "Flock", "FlockStart", "VectorialNoise"]
