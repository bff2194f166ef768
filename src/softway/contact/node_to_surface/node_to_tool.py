"""Contact of nodes with a rigid tool, which may move."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, IntArray
from softway.bodies.prescribed_motion import Still, carried_tool
from softway.bodies.rigid_motion import RigidShape
from softway.bodies.solid import Tool
from softway.contact.contact_rows import on_nodes
from softway.contact.stencils import Stencils
from softway.obstacles.half_space import HalfSpace


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class NodeToTool:
    """Contact with a tool or rigid body of this ``name``: one row for each of the nodes (m,) that may touch it."""

    node: IntArray
    tool: Tool | RigidShape
    name: str = ""

    @property
    def fixed(self) -> bool:
        """True if the rows are linear and never change."""
        return isinstance(self.tool.shape, HalfSpace) and isinstance(self.tool.motion, Still)

    def during(self, start: float, end: float) -> "ToolContact":
        """Contact with the tool in its position at the end of a slab."""
        return ToolContact(node=self.node, tool=self.tool, now=end, other=start, sign=1.0)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ToolContact:
    """Contact with a tool at one end of a slab, ``now``; ``other`` is the other end, ``sign`` is 1 at the later end."""

    node: IntArray
    tool: Tool | RigidShape
    now: float
    other: float
    sign: float

    @property
    def found(self) -> int:
        """Number of nodes that may touch."""
        return len(self.node)

    def opening(self) -> "ToolContact":
        """Contact with the tool at the start of the slab."""
        return ToolContact(node=self.node, tool=self.tool, now=self.other, other=self.now, sign=-1.0)

    def at(self, x: Array) -> Stencils:
        """Exact gaps and normals at positions ``x`` (n, d)."""
        gap, normal = self.tool.at(self.now).gap_and_normal(x[self.node])
        return Stencils(gap=gap, normal=normal, weights=on_nodes(self.node, len(x)))

    def normal_motion(self, x: Array, normal: Array) -> Array:
        """Normal motion (m,) of the tool over the slab at the nodes at ``x`` (n, d) [m]."""
        if isinstance(self.tool.motion, Still):
            return np.zeros(len(self.node))
        return np.einsum("mi,mi->m", normal, self.moved(x))

    def moved(self, x: Array) -> Array:
        """Motion (m, d) of the tool over the slab at the nodes at ``x`` (n, d) [m]."""
        if isinstance(self.tool.motion, Still):
            return np.zeros((len(self.node), x.shape[1]))
        return self.sign * carried_tool(self.tool.motion, self.other, self.now, x[self.node])
