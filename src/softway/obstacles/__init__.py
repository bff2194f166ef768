"""Shapes of rigid obstacles: signed gaps, normals and curvatures."""

from softway.obstacles.half_space import HalfSpace as HalfSpace
from softway.obstacles.primitives import Block as Block
from softway.obstacles.primitives import Cavity as Cavity
from softway.obstacles.primitives import Cylinder as Cylinder
from softway.obstacles.primitives import Roller as Roller
from softway.obstacles.primitives import Sphere as Sphere
from softway.obstacles.primitives import Torus as Torus
from softway.obstacles.signed_distance import SignedDistance as SignedDistance
from softway.obstacles.triangulated import Facets as Facets
from softway.obstacles.triangulated import Surface as Surface

__all__ = [
    "Block",
    "Cavity",
    "Cylinder",
    "Facets",
    "HalfSpace",
    "Roller",
    "SignedDistance",
    "Sphere",
    "Surface",
    "Torus",
]
