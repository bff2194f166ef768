"""Common materials with their constants and sources."""

from softway.materials.library import find as find
from softway.materials.library import names as names
from softway.materials.material import Material as Material

__all__ = ["Material", "find", "names"]
