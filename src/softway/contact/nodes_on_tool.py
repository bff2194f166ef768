"""Nodes against a rigid tool, which may move."""

from dataclasses import dataclass

import numpy as np

from softway.bodies.motion import Still, carried
from softway.bodies.solid import Tool
from softway.contact.candidates import on_nodes
from softway.contact.stencils import Stencils
from softway.space.obstacles import HalfSpace
from softway.typing import Array, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class NodesOnTool:
    """One row for each of the nodes (m,) that may touch a tool."""

    node: IntArray
    tool: Tool

    @property
    def fixed(self) -> bool:
        """Whether the rows are the same everywhere and at all times."""
        return isinstance(self.tool.shape, HalfSpace) and isinstance(self.tool.motion, Still)

    def during(self, start: float, end: float) -> "ToolMeeting":
        """The tool as it stands at the end of a slab."""
        return ToolMeeting(node=self.node, tool=self.tool, now=end, other=start, sign=1.0)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ToolMeeting:
    """Nodes against a tool at one end of a slab, ``now``; ``other`` is the other end, ``sign`` is 1 at the later."""

    node: IntArray
    tool: Tool
    now: float
    other: float
    sign: float

    @property
    def found(self) -> int:
        """Nodes that the search came up with."""
        return len(self.node)

    def opening(self) -> "ToolMeeting":
        """The same at the start of the slab."""
        return ToolMeeting(node=self.node, tool=self.tool, now=self.other, other=self.now, sign=-1.0)

    def at(self, x: Array) -> Stencils:
        """Exact gaps and normals at positions ``x`` (n, d)."""
        gap, normal = self.tool.at(self.now).gap_and_normal(x[self.node])
        return Stencils(gap=gap, normal=normal, weights=on_nodes(self.node, len(x)))

    def drive(self, x: Array, normal: Array) -> Array:
        """Normal motion (m,) of the tool over the slab beside the nodes at ``x`` (n, d) [m]."""
        if isinstance(self.tool.motion, Still):
            return np.zeros(len(self.node))
        return np.einsum("mi,mi->m", normal, self.moved(x))

    def moved(self, x: Array) -> Array:
        """Motion (m, d) of the tool over the slab beside the nodes at ``x`` (n, d) [m]."""
        if isinstance(self.tool.motion, Still):
            return np.zeros((len(self.node), x.shape[1]))
        return self.sign * carried(self.tool.motion, self.other, self.now, x[self.node])
