"""Shapes of walls. A new one is a file here and a name in `Wall`."""

from __future__ import annotations

from typing import get_args

from mesokit.geometry.array import Array
from mesokit.geometry.capsule import Capsule
from mesokit.geometry.cosine_channel import CosineChannel
from mesokit.geometry.cuboid import Cuboid
from mesokit.geometry.cylinder import Cylinder
from mesokit.geometry.disk import Disk
from mesokit.geometry.half_space import HalfSpace
from mesokit.geometry.intersection import Intersection
from mesokit.geometry.mesh import Mesh
from mesokit.geometry.picture import Picture
from mesokit.geometry.plates import Plates
from mesokit.geometry.rectangle import Rectangle
from mesokit.geometry.sampled import Sampled
from mesokit.geometry.sphere import Sphere
from mesokit.geometry.surface import Surface
from mesokit.geometry.union import Union

Wall = (
    Plates
    | HalfSpace
    | Disk
    | Cylinder
    | Sphere
    | Rectangle
    | Cuboid
    | Capsule
    | CosineChannel
    | Union
    | Intersection
    | Array
    | Sampled
    | Picture
    | Mesh
)
SHAPES: tuple[type, ...] = get_args(Wall)

__all__ = [
    "SHAPES",
    "Array",
    "Capsule",
    "CosineChannel",
    "Cuboid",
    "Cylinder",
    "Disk",
    "HalfSpace",
    "Intersection",
    "Mesh",
    "Picture",
    "Plates",
    "Rectangle",
    "Sampled",
    "Sphere",
    "Surface",
    "Union",
    "Wall",
]
