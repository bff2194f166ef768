"""GetFEM: trapezoidal rule, neo-Hookean and one-sided penalty terms in its own language, Newton's method with MUMPS."""

import getfem as gf
import numpy as np
from cube import DENSITY, ENERGY, LAMBDA, MU, SPEED, Clock, chosen

STRESS = "mu*(F-Inv(F)') + lambda*log(Det(F))*Inv(F)'"
STRAIN = "mu/2*(Norm_sqr(F)-3) - mu*log(Det(F)) + lambda/2*sqr(log(Det(F)))"


def discretised(n):
    """Element and integration on the cube of n cells along an edge, whose lower face is the region 1."""
    x = np.linspace(0.0, 1.0, n + 1)
    mesh = gf.Mesh("cartesian", x, x, x)
    element, rule = gf.MeshFem(mesh, 3), gf.MeshIm(mesh, gf.Integ("IM_GAUSS_PARALLELEPIPED(3,3)"))
    element.set_fem(gf.Fem("FEM_QK(3,1)"))
    mesh.set_region(1, mesh.outer_faces_with_direction([0.0, 0.0, -1.0], 0.1))
    return element, rule


def prepared(n, gap, step, penalty):
    """The model, its element and its integration."""
    element, rule = discretised(n)
    model = gf.Model("real")
    model.add_fem_variable("u", element)
    for name, value in {"lambda": LAMBDA, "mu": MU, "density": DENSITY, "penalty": penalty, "gap": gap}.items():
        model.add_initialized_data(name, [value])
    model.add_macro("F", "(Grad_u+Id(3))")
    model.add_nonlinear_term(rule, f"({STRESS}):Grad_Test_u")
    model.add_theta_method_for_second_order("u", 0.5)
    model.set_time_step(step)
    model.add_mass_brick(rule, "Dot2_u", "density")
    model.add_nonlinear_term(rule, "-penalty*neg_part(X(3)+u(3)+gap)*Test_u(3)", 1)
    return model, element, rule


def main():
    """Run, and print a line of JSON."""
    ask = chosen(__doc__)
    gf.util_trace_level(0)
    gf.util_warning_level(0)
    clock = Clock()
    model, element, rule = prepared(ask.cells, ask.gap, ask.step, ask.penalty)
    height, zero = element.basic_dof_nodes()[2, 2::3], np.zeros(element.nbdof())
    velocity = zero.copy()
    velocity[2::3] = -SPEED
    for name, value in {"u": zero, "Dot_u": velocity, "Dot2_u": zero}.items():
        model.set_variable(f"Previous_{name}", value)
    weights, before = DENSITY * gf.asm_generic(rule, 1, "Test_u(3)", -1, model), -SPEED
    for k in range(round(ask.end / ask.step)):
        clock.step(lambda: model.solve("max_res", 1e-7, "max_iter", 20, "lsolver", "mumps"))
        shift, velocity = model.variable("u").copy(), model.variable("Dot_u").copy()
        momentum, touching = weights @ velocity, (height + shift[2::3]).min() < -ask.gap - 1e-9
        clock.note((k + 1) * ask.step, touching, momentum, (momentum - before) / ask.step)
        before = momentum
        model.shift_variables_for_time_integration()
    strain = gf.asm_generic(rule, 0, STRAIN.replace("F", "(Grad_w+Id(3))"), -1, "w", False, element, shift,
                            "mu", False, [MU], "lambda", False, [LAMBDA])  # fmt: skip
    kinetic = gf.asm_generic(rule, 0, f"{DENSITY}/2*Norm_sqr(w)", -1, "w", False, element, velocity)
    clock.told(
        "GetFEM", getattr(gf, "__version__", "5"), element.nbdof(), velocity[2::3].mean(), (strain + kinetic) / ENERGY
    )


if __name__ == "__main__":
    main()
