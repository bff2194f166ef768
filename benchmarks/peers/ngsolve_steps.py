"""Steps of the expert's NGSolve: generalised alpha, Newton's method, a factor kept while it contracts."""

import ngsolve as ng
import numpy as np
from cube import DENSITY, LAMBDA, MU, RESIDUAL, Newmark, in_pattern


def density(w):
    """Strain energy of a displacement, per unit of volume."""
    F = ng.Id(3) + ng.Grad(w)
    J = ng.Det(F)
    return MU / 2 * (ng.Trace(F.trans * F) - 3) - MU * ng.log(J) + LAMBDA / 2 * ng.log(J) ** 2


def inertia(space, file):
    """The consistent mass matrix, or with a ``file`` that of the file, in the same pattern."""
    u, w = space.TnT()
    matrix = ng.BilinearForm(DENSITY * ng.InnerProduct(u, w) * ng.dx, symmetric=True).Assemble().mat
    if file:
        rows, columns, _ = (np.array(part) for part in matrix.COO())
        count = space.ndof // 3
        values = in_pattern(file, rows % count, columns % count, count)
        matrix.AsVector().FV().NumPy()[:] = np.where(rows // count == columns // count, values, 0.0)
    return matrix


class Motion:
    """Motion in steps as asked, from rest but for the unknowns ``thrown``, which have the velocity ``-ask.speed``.

    ``tangent(form, share, mass, scale)`` is the matrix of an iteration, ``share`` of the form and ``scale`` of the
    mass.  A factor is kept while an iteration reduces the residual to ``kept`` of what it was.
    """

    def __init__(self, ask, form, mass, thrown, tangent, kept):
        self.h, self.rule = ask.step, Newmark.of(ask.radius)
        self.form, self.mass, self.tangent, self.kept, self.inverse = form, mass, tangent, kept, None
        self.shift = ng.GridFunction(form.space)
        self.place, self.older, self.velocity, self.acceleration, self.before = (self._zero() for _ in range(5))
        self.predicted, self.end, self.inner, self.rest, self.pull = (self._zero() for _ in range(5))
        self.velocity.FV().NumPy()[thrown] = -ask.speed
        self.older.data = -self.h * self.velocity
        self.ones, self.weights = self._zero(), self._zero()
        self.ones.FV().NumPy()[thrown] = 1.0
        self.weights.data = mass * self.ones

    def _zero(self):
        vector = self.mass.CreateColVector()
        vector[:] = 0.0
        return vector

    @property
    def momentum(self):
        """Momentum along z of what was thrown."""
        return ng.InnerProduct(self.weights, self.velocity)

    def residual(self):
        """Norm of the residual, which stands in ``rest``, at the displacement ``shift``."""
        am, af = self.rule.am, self.rule.af
        self.form.Apply(self.shift.vec, self.inner)
        self.end.data = 1.0 / (self.rule.beta * self.h**2) * (self.shift.vec - self.predicted)
        self.pull.data = (1.0 - am) * self.end + am * self.acceleration
        self.rest.data = self.mass * self.pull + (1.0 - af) * self.inner + af * self.before
        return np.linalg.norm(self.rest.FV().NumPy())

    def factorised(self):
        """Factor at the displacement ``shift``."""
        self.form.AssembleLinearization(self.shift.vec)
        scale = (1.0 - self.rule.am) / (self.rule.beta * self.h**2)
        matrix = self.tangent(self.form, 1.0 - self.rule.af, self.mass, scale)
        self.inverse = matrix.Inverse(inverse="sparsecholesky")

    def step(self, update=lambda shift: None):
        """One step; ``update`` is called with the displacement that is expected at its end."""
        h, rule = self.h, self.rule
        with ng.TaskManager():
            self.predicted.data = self.place + h * self.velocity + h**2 * (0.5 - rule.beta) * self.acceleration
            self.shift.vec.data = 2.0 * self.place - self.older
            self.older.data = self.place
            update(self.shift)
            size = self.residual()
            for _ in range(40):
                if size < RESIDUAL:
                    break
                if self.inverse is None:
                    self.factorised()
                self.shift.vec.data -= self.inverse * self.rest
                was, size = size, self.residual()
                if size > self.kept * was:
                    self.inverse = None
            self.velocity.data += h * (1.0 - rule.gamma) * self.acceleration + h * rule.gamma * self.end
            self.place.data, self.acceleration.data, self.before.data = self.shift.vec, self.end, self.inner
