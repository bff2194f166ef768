"""GetFEM by an expert: its assembly in a Newton method of one's own, whose factor (SciPy's SuperLU) is kept.

With ``--mass`` the inertia is that of a given matrix, say one in which the nodes of the contact have none.
"""

import getfem as gf
import numpy as np
from cube import DENSITY, ENERGY, LAMBDA, MU, RESIDUAL, SPEED, Clock, Newmark, chosen, in_pattern
from getfem_cube import STRAIN, STRESS, discretised
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

KEPT = 0.5
"""Part to which an iteration has to reduce the residual for its factor to be kept."""


def prepared(ask):
    """The model without inertia, its element, its integration and the mass matrix."""
    element, rule = discretised(ask.cells)
    model = gf.Model("real")
    model.add_fem_variable("u", element)
    for name, value in {"lambda": LAMBDA, "mu": MU, "penalty": ask.penalty, "gap": ask.gap}.items():
        model.add_initialized_data(name, [value])
    model.add_macro("F", "(Grad_u+Id(3))")
    model.add_nonlinear_term(rule, f"({STRESS}):Grad_Test_u")
    model.add_nonlinear_term(rule, "-penalty*neg_part(X(3)+u(3)+gap)*Test_u(3)", 1)
    mass = as_csc(gf.asm_mass_matrix(rule, element, element)) * DENSITY
    if ask.mass:
        n, count = ask.cells, (ask.cells + 1) ** 3
        at = np.rint(element.basic_dof_nodes() * n).astype(int)
        number = at[0] + (n + 1) * (at[1] + (n + 1) * at[2])
        entries = mass.tocoo()
        mass.data[:] = in_pattern(ask.mass, number[entries.row], number[entries.col], count)
    return model, element, rule, mass


def as_csc(matrix):
    """A matrix of GetFEM as one of SciPy."""
    starts, rows = matrix.csc_ind()
    return csc_matrix((matrix.csc_val(), rows, starts), shape=matrix.size())


def main():
    """Run, and print a line of JSON."""
    ask = chosen(__doc__)
    gf.util_trace_level(0)
    gf.util_warning_level(0)
    clock, h, rule = Clock(), ask.step, Newmark.of(ask.radius)
    model, element, integration, mass = prepared(ask)
    height, place = element.basic_dof_nodes()[2, 2::3], np.zeros(element.nbdof())
    velocity, acceleration, before = place.copy(), place.copy(), place.copy()
    velocity[2::3] = -SPEED
    older = -h * velocity
    lower = np.zeros_like(place)
    lower[2::3] = 1.0
    weights = mass @ lower
    scale = (1.0 - rule.am) / (rule.beta * h**2)
    factor = {}

    def inner(shift):
        model.set_variable("u", shift)
        model.assembly("build_rhs")
        return -model.rhs()

    def factorised():
        model.assembly("build_matrix")
        tangent = (1.0 - rule.af) * as_csc(model.tangent_matrix()) + scale * mass
        factor["inverse"] = splu(
            tangent.tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}, diag_pivot_thresh=0.001
        )

    def step():
        nonlocal place, older, velocity, acceleration, before
        predicted = place + h * velocity + h**2 * (0.5 - rule.beta) * acceleration
        shift, older = 2.0 * place - older, place

        def residual():
            force, end = inner(shift), (shift - predicted) / (rule.beta * h**2)
            pull = mass @ ((1.0 - rule.am) * end + rule.am * acceleration)
            return force, end, pull + (1.0 - rule.af) * force + rule.af * before

        force, end, rest = residual()
        for _ in range(40):
            size = np.linalg.norm(rest)
            if size < RESIDUAL:
                break
            if not factor:
                factorised()
            shift = shift - factor["inverse"].solve(rest)
            force, end, rest = residual()
            if np.linalg.norm(rest) > KEPT * size:
                factor.clear()
        velocity = velocity + h * ((1.0 - rule.gamma) * acceleration + rule.gamma * end)
        place, acceleration, before = shift, end, force

    for k in range(round(ask.end / h)):
        clock.step(step)
        touching = (height + place[2::3]).min() < -ask.gap - 1e-9
        clock.note((k + 1) * h, touching, weights @ velocity, -(before @ lower))
    strain = gf.asm_generic(integration, 0, STRAIN.replace("F", "(Grad_w+Id(3))"), -1, "w", False, element, place,
                            "mu", False, [MU], "lambda", False, [LAMBDA])  # fmt: skip
    kinetic = 0.5 * velocity @ (mass @ velocity)
    clock.told("GetFEM", getattr(gf, "__version__", "5"), len(place), weights @ velocity, (strain + kinetic) / ENERGY)


if __name__ == "__main__":
    main()
