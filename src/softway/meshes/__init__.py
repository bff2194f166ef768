"""Meshes: cells, their generators and mesh files."""

from softway.meshes.adaptive.adapt import Adapt as Adapt
from softway.meshes.generators.recipes import Ball as Ball
from softway.meshes.generators.recipes import Box as Box
from softway.meshes.generators.recipes import Cylinder as Cylinder
from softway.meshes.generators.recipes import Disc as Disc
from softway.meshes.generators.recipes import Divided as Divided
from softway.meshes.generators.recipes import Interval as Interval
from softway.meshes.generators.recipes import MeshFile as MeshFile
from softway.meshes.generators.recipes import Rectangle as Rectangle
from softway.meshes.generators.zones import InBall as InBall
from softway.meshes.generators.zones import InBox as InBox
from softway.meshes.mesh import Mesh as Mesh
from softway.meshes.remeshed.remesh import Remesh as Remesh

__all__ = [
    "Adapt",
    "Ball",
    "Box",
    "Cylinder",
    "Disc",
    "Divided",
    "InBall",
    "InBox",
    "Interval",
    "Mesh",
    "MeshFile",
    "Rectangle",
    "Remesh",
]
