"""Facets of each kind on circles and spheres."""

import numpy as np
from facet_solids import SOLIDS

from softway.meshes.generators.shapes import box

Surface = tuple[np.ndarray, dict[str, np.ndarray]]


def arc(kind: str, cells: int, radius: float, ends: tuple[float, float], sign: float) -> Surface:
    """Facets on a circle, turned away from its centre (sign 1) or towards it (-1)."""
    angle = np.linspace(*ends, cells + 1)
    facets = np.stack([np.arange(cells), np.arange(1, cells + 1)], axis=1)
    if kind == "bar3":
        facets = np.concatenate([facets, cells + 1 + np.arange(cells)[:, None]], axis=1)
        angle = np.concatenate([angle, 0.5 * (angle[1:] + angle[:-1])])
    if sign < 0.0:
        facets[:, :2] = facets[:, 1::-1]
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1), {kind: facets}


def cap(kind: str, cells: int, radius: float, half: float, sign: float) -> Surface:
    """Facets on a sphere over the square of tangents up to ``half``."""
    mesh = box((1.0, 1.0, 1.0), (cells, cells, 1), cell=SOLIDS[kind])
    flat = half * (2.0 * mesh.points - 1.0)
    flat[:, 2] = 1.0
    x = radius * flat / np.linalg.norm(flat, axis=1)[:, None]
    return x, dict(mesh.facets_on("top" if sign > 0.0 else "bottom"))
