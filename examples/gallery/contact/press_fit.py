"""
A press fit
===========

A ring of 20 mm outer radius is pressed into another ring whose inner radius is 10 micrometres
smaller. What is the pressure between them? Lame's solution gives it in closed form, with the
stresses in both rings.
"""

import matplotlib.pyplot as plt
import numpy as np

import softway as sw
from softway.apps.verify.exact.contact import PressFit
from softway.meshes.generators.recipes import Ring

INNER, MIDDLE, OUTER, FIT = 0.01, 0.02, 0.04, 1e-5
lame = PressFit(
    radii=(INNER, MIDDLE, OUTER), interference=FIT, youngs=(210e9, 210e9), poisson=(0.3, 0.3)
)

# %%
# A quarter of each ring, in plane stress. The meshes overlap by the interference. ``start = "fit"``
# computes their equilibrium before anything moves.


def quarter(inner, outer):
    """Quarter of a steel ring."""
    return sw.Solid(
        mesh=Ring(inner=inner, outer=outer, cells=(10, 32), angle=0.5 * np.pi),
        material=sw.LinearElastic(E=210e9, nu=0.3),
        density=7850.0,
        section=sw.bodies.PlaneStress(),
        supports=(sw.Fixed(on="start", components="y"), sw.Fixed(on="end", components="x")),
    )


bodies = {"shaft": quarter(INNER, MIDDLE + FIT), "hub": quarter(MIDDLE, OUTER)}
contact = sw.Contact(between=("shaft.outer", "hub.inner"), name="fit", start="fit")
model = sw.build(sw.Scene(bodies=bodies, contacts=(contact,)))
step = next(sw.march(model, until=1e-7, step=1e-7))

# %%
# Radial and hoop stress at the centres of the cells.


def stresses(name):
    """Radii of the cells, with radial and hoop stress."""
    mesh = model.meshes[name]
    middle = mesh.points[mesh.blocks["quad4"]].mean(axis=1)
    stress = model.stress(name, step.after.displacement[name])[:, :2, :2]
    along = middle / np.linalg.norm(middle, axis=1)[:, None]
    radial = np.einsum("ci,cij,cj->c", along, stress, along)
    return np.linalg.norm(middle, axis=1), radial, np.trace(stress, axis1=1, axis2=2) - radial


fig, axis = plt.subplots(figsize=(8.0, 4.2), layout="constrained")
for name, exact in (("shaft", lame.inner), ("hub", lame.outer)):
    radius, radial, hoop = stresses(name)
    fine = np.linspace(*((INNER, MIDDLE) if name == "shaft" else (MIDDLE, OUTER)), 80)
    for found, curve, colour in (
        (radial, exact.stress(fine)[0], "C0"),
        (hoop, exact.stress(fine)[1], "C1"),
    ):
        axis.plot(1e3 * fine, curve / 1e6, color="0.75", lw=4, zorder=1)
        label = ("along the radius" if colour == "C0" else "around") if name == "hub" else None
        axis.plot(1e3 * radius, found / 1e6, ".", ms=3, color=colour, label=label)
axis.set(xlabel="radius [mm]", ylabel="stress [MPa]", title="Dots are cells, grey lines are Lame's")
axis.legend()

# %%
# The pressure between the rings: the contact force on a quarter divided by its area.

push = step.after.pressure["fit"]
outer = model.meshes["hub"].nodes("inner")
mesh = model.meshes["shaft"]
pressure = float(push.sum() / (0.5 * np.pi * MIDDLE))
print(f"pressure {pressure / 1e6:.3f} MPa, Lame {lame.pressure / 1e6:.3f} MPa")
worst = max(
    np.abs(stresses(n)[1] - e.stress(stresses(n)[0])[0]).max()
    for n, e in (("shaft", lame.inner), ("hub", lame.outer))
)
print(f"radial stress differs by at most {worst / 1e6:.3f} MPa")
assert abs(pressure / lame.pressure - 1.0) < 0.01 and worst < 0.03 * lame.pressure
