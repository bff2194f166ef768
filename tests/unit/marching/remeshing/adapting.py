"""Scenes whose solids adapt."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

import softway as sw
from softway.meshes.adaptive.adapt import Adapt


def adapting(scene: sw.Scene, adapt: Mapping[str, Adapt]) -> sw.Scene:
    """The scene with solids that adapt."""
    bodies = {name: replace(scene.bodies[name], adapt=how) for name, how in adapt.items()}
    return replace(scene, bodies={**scene.bodies, **bodies})


def adaptive_march(scene: sw.Scene, adapt: Mapping[str, Adapt], **given: Any) -> Iterator[sw.Step]:
    """March of the scene with solids that adapt."""
    return sw.march(adapting(scene, adapt), **given)
