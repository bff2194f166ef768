"""Operators of the fixed point: ways to invert ``M + h^2/2 mu2 K`` well enough."""

from softway.solve.operators.choice import Choice as Choice
from softway.solve.operators.choice import choose as choose
from softway.solve.operators.factored import Factored as Factored
from softway.solve.operators.matrix_free import MatrixFree as MatrixFree
from softway.solve.operators.multigrid import Multigrid as Multigrid
from softway.solve.operators.operator import Made as Made
from softway.solve.operators.operator import Operator as Operator

__all__ = ["Choice", "Factored", "Made", "MatrixFree", "Multigrid", "Operator", "choose"]
