"""Where keys belong that users put into another table by mistake."""

from collections.abc import Iterator

TOP = (
    "contacts",
    "ties",
    "loads",
    "time",
    "start",
    "inertia",
    "solver",
    "output",
    "joints",
    "stops",
    "springs",
    "torques",
    "forces",
    "gears",
    "motors",
    "pile",
    "heat_contacts",
    "heat_links",
)
"""Top-level keys of a scenario, put into a body."""
OF_BODIES = ("mesh", "material", "density", "velocity", "supports", "thermal")
"""Keys of bodies at the top level."""
OF_LOADS = ("gravity", "traction")
"""Kinds of loads at the top level."""
TOOLS = ("obstacle", "obstacles", "tool", "tools", "wall", "walls", "floor", "ground", "rigid_wall", "planes")
"""Rigid bodies with a given motion at the top level."""
OF_HEAT = ("conductance", "hardness", "gas", "roughness", "emissivity", "tool_temperature", "share")
"""Keys of the heat of a contact, put into the contact."""


def right_place(key: str, table: str, *, top: bool) -> str:
    """The place where a key belongs, for a remedy; empty where none is known.

    Parameters
    ----------
    key
        Key that the table does not have.
    table
        Class of the table.
    top
        Whether the table is the scenario itself.

    Examples
    --------
    >>> right_place("loads", "Solid", top=False)
    "'loads' at the top level of the file"
    >>> right_place("gravity", "Scenario", top=True)
    'a table of loads, [[loads]] with kind = "Gravity"'
    >>> right_place("speed", "Solid", top=False)
    ''
    """
    return next(_places(key, table, top=top), "")


def _places(key: str, table: str, *, top: bool) -> Iterator[str]:
    """All places where a key belongs."""
    if not top and key in TOP:
        yield f"'{key}' at the top level of the file"
    if top and key in OF_BODIES:
        yield f"'{key}' in the table of its body, bodies.NAME.{key}"
    if top and key in OF_LOADS:
        yield f'a table of loads, [[loads]] with kind = "{key.capitalize()}"'
    if top and key in TOOLS:
        yield f'a table of bodies, [bodies.{key}] with kind = "Tool" and shape = {{ kind = "HalfSpace", ... }}'
    if table == "Contact" and key in OF_HEAT:
        yield f"'{key}' in the table of its heat, heat = {{ {key} = ... }}"
