"""A hard disc on an adapted mesh rolls over a floor as a circle, not as the polygon of its base mesh."""

from math import pi

import numpy as np
import pytest
from adapting import adaptive_march

import softway as sw
from softway.arrays import Array
from softway.meshes.adaptive.adapt import Adapt

RADIUS, EDGES = 1.0, 32
"""Radius, and edges of the base mesh: its sagitta is 4.8e-3."""


def heights(cell: str, cells: int, adapt: Adapt) -> tuple[Array, sw.Step]:
    """Heights of the centre above that of a circle that rolls, and the last slab."""
    spin = sw.bodies.Affine(value=(0.0, 0.0), gradient=((0.0, 1.0), (-1.0, 0.0)))
    body = sw.Solid(
        mesh=sw.meshes.Disc(radius=RADIUS, cells=cells, cell=cell), material=sw.NeoHookean(E=1e7, nu=0.3),
        density=1.0, velocity=spin,
    )  # fmt: skip
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -RADIUS), normal=(0.0, 1.0)))
    contact = sw.Contact(between=("body.boundary", "floor"))
    scene = sw.Scene(
        bodies={"body": body, "floor": floor}, contacts=(contact,), loads=(sw.Gravity(acceleration=(0.0, -10.0)),)
    )
    out = []
    for step in adaptive_march(scene, {"body": adapt}, until=0.12, step=0.01):
        mass = step.model.mass
        places = step.model.points + step.model.join(step.after.displacement)
        out.append(float((mass @ places)[:, 1].sum() / mass.sum()))
    return np.array(out), step


def coarse(levels: int, smooth: float = pi / 6.0) -> Adapt:
    return Adapt(levels=levels, smooth=smooth, contact_cells=4, every=2, tolerance=0.5)


@pytest.mark.parametrize(
    ("cell", "cells", "levels"),
    [
        ("tri3", 8, 2),
        ("tri3", 8, 4),
        pytest.param("quad4", 16, 2, marks=pytest.mark.slow),
        pytest.param("quad4", 16, 4, marks=pytest.mark.minutes),
    ],
)
def test_the_centre_stays_at_the_height_of_the_radius(cell: str, cells: int, levels: int) -> None:
    found, last = heights(cell, cells, coarse(levels))
    sagitta = RADIUS * (1.0 - np.cos(pi / (EDGES * 2 ** (levels // 2))))
    assert found.min() > -1.25 * sagitta  # that of the finest edges, and vibrations from corner to corner
    assert abs(last.ledger.energy_error) < 1e-9
    assert found.max() < 8.0 * sagitta  # it hops from corner to corner of the fine polygon


@pytest.mark.slow
def test_flat_facets_let_it_sink_to_their_middles() -> None:
    found, _ = heights("tri3", 8, coarse(4, smooth=0.0))
    assert found.min() < -0.8 * RADIUS * (1.0 - np.cos(pi / EDGES))
