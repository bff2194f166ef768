"""Direct solvers of other libraries, each in its own file, and the choice among them."""

from softway.solve.linear.backends.choice import best_solver as best_solver
from softway.solve.linear.backends.choice import solver_named as solver_named
from softway.solve.linear.backends.cholmod import Cholmod as Cholmod
from softway.solve.linear.backends.mumps import Mumps as Mumps
from softway.solve.linear.backends.pardiso import Pardiso as Pardiso
from softway.solve.linear.backends.superlu import SuperLU as SuperLU

__all__ = ["Cholmod", "Mumps", "Pardiso", "SuperLU", "best_solver", "solver_named"]
