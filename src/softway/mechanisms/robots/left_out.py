"""Elements of a MuJoCo model that a mechanism does not have, by name."""

from types import ModuleType
from typing import Any

KINDS = {
    "actuator": "nu",
    "tendon": "ntendon",
    "sensor": "nsensor",
    "flex": "nflex",
    "skin": "nskin",
    "pair": "npair",
    "key": "nkey",
    "plugin": "nplugin",
}
"""Elements that no mechanism has, and the names of their numbers."""


def named(mujoco: ModuleType, model: Any, kind: str, k: int) -> str:
    """Name of an element of a kind, or its number."""
    name = mujoco.mj_id2name(model, getattr(mujoco.mjtObj, f"mjOBJ_{kind.upper()}"), k)
    return repr(name) if name else f"number {k}"


def left_out_of_model(mujoco: ModuleType, model: Any) -> list[str]:
    """Limits, friction, armature, contacts, actuators and the like, by name."""
    found = []
    for k in range(model.njnt):
        name, first = named(mujoco, model, "joint", k), int(model.jnt_dofadr[k])
        freedoms = slice(first, first + (6, 3, 1, 1)[int(model.jnt_type[k])])
        for what, there in (
            ("limits", bool(model.jnt_limited[k])),
            ("force limits", bool(model.jnt_actfrclimited[k])),
            ("friction", bool(model.dof_frictionloss[freedoms].any())),
            ("armature", bool(model.dof_armature[freedoms].any())),
        ):
            found += [f"{what} of the joint {name}"] if there else []
    for k in range(model.nbody):
        geoms = slice(int(model.body_geomadr[k]), int(model.body_geomadr[k]) + int(model.body_geomnum[k]))
        name = named(mujoco, model, "body", k)
        if model.body_geomnum[k] and (model.geom_contype[geoms] | model.geom_conaffinity[geoms]).any():
            found.append(f"contacts of the body {name}")
        if model.body_gravcomp[k]:
            found.append(f"gravity compensation of the body {name}")
        if model.body_mocapid[k] >= 0:
            found.append(f"motion capture of the body {name}")
    for kind, count in KINDS.items():
        found += [f"{kind} {named(mujoco, model, kind, k)}" for k in range(getattr(model, count))]
    if model.opt.density or model.opt.viscosity or model.opt.wind.any():
        found.append("forces of the medium (density, viscosity, wind)")
    return found
