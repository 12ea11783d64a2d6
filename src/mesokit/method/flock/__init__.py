"""Flocks: birds that fly as the others around them do (Vicsek et al. 1995)."""

from mesokit.method.flock.cohesion import Cohesion
from mesokit.method.flock.noise.angular import AngularNoise
from mesokit.method.flock.noise.vectorial import VectorialNoise
from mesokit.method.flock.observe.cluster_sizes import ClusterSizes
from mesokit.method.flock.observe.density_bands import DensityBands
from mesokit.method.flock.observe.number_fluctuations import NumberFluctuations
from mesokit.method.flock.observe.polar_order import PolarOrder
from mesokit.method.flock.section import Flock, FlockStart

__all__ = [
    "AngularNoise",
    "ClusterSizes",
    "Cohesion",
    "DensityBands",
    "Flock",
    "FlockStart",
    "NumberFluctuations",
    "PolarOrder",
    "VectorialNoise",
]
