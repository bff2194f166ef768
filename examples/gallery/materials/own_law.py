"""
A law of your own
=================

Skin and tendons are soft at small stretch and stiffen progressively at larger stretch. Fung's law
describes this; softway does not include it. A law is a frozen data class with five methods. It
needs no registration and no base class, and softway tests it like its own laws.
"""

from dataclasses import dataclass
from typing import ClassVar

import matplotlib.pyplot as plt
import numpy as np

import softway as sw
from softway.kernels.linalg import tensors
from softway.laws.elasticity.elastic_constants import dilatational_speed, lame
from softway.laws.strain_measures import Green
from softway.testing import check_law, examine_law
from softway.units import Pascal, Pure

# %%
# The energy is W = mu/b (exp(b E:E) - 1) + lambda/2 (tr E)^2 in Green's strain E; stress and moduli
# are its derivatives. For b = 0 it is the law of St. Venant and Kirchhoff.


@dataclass(frozen=True, slots=True, kw_only=True)
class Fung:
    """Tissue that stiffens exponentially.

    Examples
    --------
    >>> law = Fung(E=1e5, nu=0.4, b=5.0)
    """

    E: Pascal
    nu: Pure
    b: Pure
    measure: ClassVar[Green] = Green()
    linear: ClassVar[bool] = False

    def energy(self, E):
        first, second = lame(self.E, self.nu)
        stiff = second / self.b * np.expm1(self.b * tensors.double_dot(E, E))
        return stiff + 0.5 * first * tensors.trace(E) ** 2

    def stress(self, E):
        first, second = lame(self.E, self.nu)
        grown = 2.0 * second * np.exp(self.b * tensors.double_dot(E, E))
        return grown[..., None, None] * E + first * tensors.trace(E)[..., None, None] * np.eye(3)

    def tangent(self, E):
        first, second = lame(self.E, self.nu)
        grown = np.exp(self.b * tensors.double_dot(E, E))[..., None, None, None, None]
        outer = E[..., :, :, None, None] * E[..., None, None, :, :]
        growth = 2.0 * second * (tensors.square_symmetric(np.eye(3)) + 2.0 * self.b * outer)
        return grown * growth + first * np.einsum("ij,kl->ijkl", np.eye(3), np.eye(3))

    def wave_speed(self, density):
        return dilatational_speed(self.E, self.nu, density)

    def youngs(self):
        return self.E


law = Fung(E=1e5, nu=0.0, b=5.0)

# %%
# The test compares stress with the derivative of the energy, and moduli with the derivative of the
# stress. It checks rotations, very small strains, inverted material and units. It raises an error
# if a check fails.

check_law(law)
for finding in examine_law(law)[:4]:
    print(f"{finding.name:45} error {finding.error:.1e}, allowed {finding.allowed:.1e}")

# %%
# A strip is stretched to one and a half times its length, without inertia. Poisson's ratio is zero,
# so the axial stress is known: F S(E) per initial area, with the stretch F.

strip = sw.Solid(
    mesh=sw.meshes.Rectangle(size=(1.0, 0.5), cells=(2, 1)),
    material=law,
    density=1000.0,
    supports=(sw.Fixed(on="left"), sw.Driven(on="right", components="x", velocity=1.0)),
)
scene = sw.Scene(bodies={"strip": strip}, inertia=sw.bodies.Off())
steps = list(sw.march(scene, until=0.5, step=0.02, method=sw.Newton()))
stretch = 1.0 + np.array([step.after.time for step in steps])
work = np.array([step.ledger.energy_strain for step in steps]) / 0.5
strain = 0.5 * (stretch**2 - 1.0)
exact = law.E / law.b * 0.5 * np.expm1(law.b * strain**2)
worst = np.abs(work / exact - 1.0).max()
print(f"energy of the strip differs from W by at most {worst:.1e}")
assert worst < 1e-9

# %%
# The stress, compared with that of the same law without its exponential growth.

fig, axis = plt.subplots(figsize=(8.0, 4.0), layout="constrained")
fine = np.linspace(1.0, 1.5, 200)
green = 0.5 * (fine**2 - 1.0)
axis.plot(fine, fine * law.E * np.exp(law.b * green**2) * green / 1e3, color="0.8", lw=5, label="exact")
axis.plot(
    fine, fine * law.E * green / 1e3, color="0.5", lw=1.0, ls="--", label="St. Venant and Kirchhoff"
)
pull = [step.reactions["strip"][:, 0].clip(0.0).sum() / 0.5 / 1e3 for step in steps]
axis.plot(stretch - 0.01, pull, ".", ms=5, label="pull of the support, middle of slabs")
axis.set(xlabel="stretch", ylabel="force per initial area [kPa]", title="A strip of tissue")
axis.legend()
