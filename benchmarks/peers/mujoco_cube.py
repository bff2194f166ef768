"""MuJoCo: a flex of tetrahedra with its elastic law, Euler's explicit integrator, its own contact with the plane."""

import mujoco
from cube import NU, PENALTY, Clock, E, chosen

MODEL = """
<mujoco>
  <option timestep="{step}" gravity="0 0 -{load}" integrator="Euler" solver="CG" tolerance="1e-6" iterations="100"/>
  <size memory="2G"/>
  <worldbody>
    <geom type="plane" size="5 5 .1" pos="0 0 {floor}" condim="1" solref="{stiff} 0"/>
    <flexcomp name="cube" type="grid" count="{m} {m} {m}" spacing="{edge} {edge} {edge}" pos=".5 .5 .5" dim="3" mass="1"
      radius="1e-4">
      <elasticity young="{E}" poisson="{NU}" damping="0"/>
      <contact selfcollide="none" condim="1" solref="{stiff} 0"/>
    </flexcomp>
  </worldbody>
</mujoco>
"""


def main():
    """Run, and print a line of JSON."""
    ask = chosen(__doc__, step=2e-4)
    n, m = ask.cells, ask.cells + 1
    stiff = -min(PENALTY / n**2 * m**3, 0.1 / ask.step**2)  # of a node of mass 1/m^3; a tenth of what the step bears
    text = MODEL.format(step=ask.step, floor=-ask.gap, stiff=stiff, m=m, edge=1.0 / n, E=E, NU=NU, load=ask.load)
    clock = Clock()
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    data.qvel[2::3] = -ask.speed
    for _ in range(round(ask.end / ask.step)):
        clock.step(lambda: mujoco.mj_step(model, data))
        clock.sunk(-ask.gap - data.flexvert_xpos[:, 2].min())
        mass = model.body_mass[-model.nflexvert :]
        clock.note(data.time, data.ncon > 0, mass @ data.qvel[2::3], 0.0)
    clock.told("MuJoCo", mujoco.__version__, model.nv, data.qvel[2::3].mean(), None)


if __name__ == "__main__":
    main()
