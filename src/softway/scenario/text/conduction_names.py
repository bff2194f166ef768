"""Library materials as laws of conduction: of conductors, and of solids with heat."""

from typing import Any

from softway.errors import InputError
from softway.laws.heat.conduction import Conduction
from softway.laws.materials import find
from softway.laws.materials.library import everything
from softway.laws.materials.material import Material as Constants
from softway.scenario.hints.type_hints import inputs
from softway.scenario.text.writer import write


def furnish_conduction(body: dict[str, Any], where: str) -> None:
    """Replace names of library materials in ``thermal.law`` of a body, and in the ``law`` of a conductor.

    ``law = "copper OFHC"`` gives conductivity and capacity.  ``law = { library = "copper OFHC", latent = true }`` adds
    the latent heat of melting; further keys, also those of a table ``latent``, replace parameters.  A solid has the
    expansion of the material, a conductor its density, if none is given.

    Examples
    --------
    >>> body = {"kind": "Conductor", "law": "glass"}
    >>> furnish_conduction(body, "bodies.pane")
    >>> body["density"], body["law"]["conductivity"]
    ('2500.0 kg/m^3', '1.0 W/(m K)')
    """
    thermal = body.get("thermal")
    if isinstance(thermal, dict) and "law" in thermal:
        material = _furnish(thermal, f"{where}.thermal")
        if material is not None:
            with_expansion(thermal, material)
    if body.get("kind") == "Conductor" and "law" in body:
        _furnish_conductor(body, where)


def named(kind: Any) -> bool:
    """True if a kind is the name of a library material, as in a table that an override of one parameter has created."""
    if not isinstance(kind, str):
        return False
    return kind.casefold() in [word.casefold() for m in everything() for word in (m.name, *m.aliases)]


def with_expansion(thermal: dict[str, Any], material: Constants) -> None:
    """Add the expansion of a material to a thermal table without one."""
    if material.thermal is not None and material.thermal.expansion is not None:
        thermal.setdefault("expansion", f"{material.thermal.expansion!r} 1/K")


def _furnish_conductor(body: dict[str, Any], where: str) -> None:
    """Replace the names in the law of a conductor, and add the densities that are not given."""
    if not _by_regions(body["law"]):
        material = _furnish(body, where)
        if material is not None:
            body.setdefault("density", _density(material))
        return
    found = _furnish_regions(body, where)
    old = body.get("density", {})
    if isinstance(old, dict) and found:
        body["density"] = {**{region: _density(material) for region, material in found.items()}, **old}


def _density(material: Constants) -> str:
    """Density of a material as a text."""
    return f"{material.density!r} kg/m^3"


def _by_regions(law: Any) -> bool:
    """True if a law is a table of laws by regions, tables or names."""
    if not isinstance(law, dict) or not law or {"kind", "library", *inputs(Conduction)} & law.keys():
        return False
    return all(isinstance(one, dict) or isinstance(one, str) and one[:1].isalpha() for one in law.values())


def _furnish_regions(table: dict[str, Any], where: str) -> dict[str, Constants]:
    """Replace the names in the laws by regions of a table, and return the materials of these regions."""
    laws, found = table["law"], {}
    for region in laws:
        one = {"law": laws[region]}
        material = _furnish(one, where, f"law.{region}")
        laws[region] = one["law"]
        if material is not None:
            found[region] = material
    return found


def _furnish(table: dict[str, Any], where: str, key: str = "law") -> Constants | None:
    """Replace the ``law`` of a table if it is the name of a library material, which is returned."""
    given = table["law"]
    if _by_regions(given):
        _furnish_regions(table, where)
        return None
    if isinstance(given, str) and given != "Conduction":
        given = {"library": given}
    if isinstance(given, dict) and "library" not in given and named(given.get("kind")):
        given = {"library": given["kind"], **{name: value for name, value in given.items() if name != "kind"}}
    if not isinstance(given, dict) or "library" not in given:
        return None
    if not isinstance(given["library"], str):
        problem = f"{given['library']!r} is not a name"
        raise InputError(f"{where}.{key}.library", problem, 'a name such as "steel S235"')
    try:
        material = find(given["library"])
    except InputError as error:
        remedy = f"{error.remedy}; or a table with conductivity and capacity"
        raise InputError(f"{where}.{key}", error.problem, remedy) from None
    table["law"] = _law(material, given, f"{where}.{key}")
    return material


def _law(material: Constants, given: dict[str, Any], where: str) -> dict[str, Any]:
    """Table of the law of a material, with the parameters that a table with its name replaces."""
    more = {name: value for name, value in given.items() if name not in ("library", "latent")}
    asked = given.get("latent", False)
    try:
        law = write(material.conduction(latent=asked is not False), Conduction, where)
    except InputError as error:
        raise InputError(where, error.problem, error.remedy) from None
    if isinstance(asked, dict):
        law["latent"] = {**law["latent"], **asked}
    elif not isinstance(asked, bool):
        remedy = 'true, or a table such as { half_range = "10 K" }'
        raise InputError(f"{where}.latent", f"{asked!r} is no latent heat", remedy)
    return {**law, **more}
