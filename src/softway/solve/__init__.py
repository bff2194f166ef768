"""Equations of one slab (time step) and the methods that solve them."""

from softway.solve.methods.central_difference import Explicit as Explicit
from softway.solve.methods.fixed_point import FixedPoint as FixedPoint
from softway.solve.methods.newton import Newton as Newton
from softway.solve.operators import ConjugateGradients as ConjugateGradients
from softway.solve.operators import Device as Device
from softway.solve.operators import Factored as Factored
from softway.solve.operators import MatrixFree as MatrixFree
from softway.solve.operators import Multigrid as Multigrid

__all__ = [
    "ConjugateGradients",
    "Device",
    "Explicit",
    "Factored",
    "FixedPoint",
    "MatrixFree",
    "Multigrid",
    "Newton",
]
