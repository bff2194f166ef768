"""Operators of the fixed point: approximate inverses of ``M + h^2/2 mu2 K``."""

from softway.solve.operators.choice import OperatorChoice as OperatorChoice
from softway.solve.operators.choice import choose_operator as choose_operator
from softway.solve.operators.conjugate_gradients import ConjugateGradients as ConjugateGradients
from softway.solve.operators.device import Device as Device
from softway.solve.operators.factored import Factored as Factored
from softway.solve.operators.interface import BuiltOperator as BuiltOperator
from softway.solve.operators.interface import Operator as Operator
from softway.solve.operators.matrix_free import MatrixFree as MatrixFree
from softway.solve.operators.multigrid import Multigrid as Multigrid

__all__ = [
    "BuiltOperator",
    "ConjugateGradients",
    "Device",
    "Factored",
    "MatrixFree",
    "Multigrid",
    "Operator",
    "OperatorChoice",
    "choose_operator",
]
