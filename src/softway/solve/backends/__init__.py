"""Direct solvers of other libraries, one file and one extra each, and the choice among them."""

from softway.solve.backends.choice import best as best
from softway.solve.backends.choice import named as named
from softway.solve.backends.cholmod import Cholmod as Cholmod
from softway.solve.backends.mumps import Mumps as Mumps
from softway.solve.backends.pardiso import Pardiso as Pardiso

__all__ = ["Cholmod", "Mumps", "Pardiso", "best", "named"]
