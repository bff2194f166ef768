"""Library materials in a scenario: the name of a material gives the law, and the density if none is given."""

import copy
from collections.abc import Mapping
from typing import Any, get_args

from softway.errors import InputError
from softway.laws.heat.conduction import Conduction
from softway.laws.law import Material as Law
from softway.laws.materials import find
from softway.laws.materials.material import LawName
from softway.laws.materials.material import Material as Constants
from softway.scenario.hints.type_hints import kinds, members, nearest
from softway.scenario.text.conduction_names import furnish_conduction, named, with_expansion
from softway.scenario.text.writer import write


def with_materials(data: Mapping[str, Any]) -> dict[str, Any]:
    """Copy of the data of a scenario, with library materials replaced by laws and densities.

    ``material = "steel S235"`` selects the elastic law for arbitrary rotations.
    ``material = { library = "steel S235", law = "plastic" }`` selects another law: elastic, linear or plastic.  Further
    keys of such a table replace parameters of the law.  A table of tables or names gives a material to each region.
    Solids with a ``thermal`` table soften where the constants are known; a thermal table without a law gets that of the
    material, with its expansion if none is given.  Laws of conduction may be names, too.

    Examples
    --------
    >>> with_materials({"bodies": {"rod": {"material": "glass"}}})["bodies"]["rod"]["density"]
    '2500.0 kg/m^3'
    """
    out = copy.deepcopy(dict(data))
    bodies = out.get("bodies")
    if isinstance(bodies, dict):
        for name, body in bodies.items():
            if isinstance(body, dict) and "material" in body:
                _furnish(body, f"bodies.{name}.material")
            if isinstance(body, dict):
                furnish_conduction(body, f"bodies.{name}")
    return out


def _by_regions(given: Any) -> bool:
    """True if a material is given by regions: a table of tables, laws by kind, or names of library materials."""
    if not isinstance(given, dict) or not given or {"kind", "library"} & given.keys():
        return False
    return all(isinstance(one, dict) or isinstance(one, str) and one[:1].isalpha() for one in given.values())


def _furnish_regions(body: dict[str, Any], given: dict[str, Any], where: str) -> None:
    """Replace the material of each region, and add the densities that are not given."""
    heat: dict[str, Any] = {"thermal": {"law": {}}} if "thermal" in body else {}
    found = {name: {"material": one, **heat} for name, one in given.items()}
    for name, one in found.items():
        _furnish(one, f"{where}.{name}")
        if isinstance(one["material"], str):
            one["material"] = {"kind": one["material"]}
    body["material"] = {name: one["material"] for name, one in found.items()}
    densities = {name: one["density"] for name, one in found.items() if "density" in one}
    old = body.get("density", {})
    if isinstance(old, dict) and (old or densities):
        body["density"] = {**densities, **old}


def _furnish(body: dict[str, Any], where: str) -> None:
    """Replace the material of one body by its law if it is a library material."""
    given = body["material"]
    if _by_regions(given):
        _furnish_regions(body, given, where)
        return
    if (
        isinstance(given, dict)
        and "library" not in given
        and named(given.get("kind"))
        and given["kind"] not in kinds(members(Law))
    ):
        given = {"library": given["kind"], **{key: value for key, value in given.items() if key != "kind"}}
    if isinstance(given, str) and given not in kinds(members(Law)):
        given = {"library": given}
    if not (isinstance(given, dict) and "library" in given):
        return
    if not isinstance(given["library"], str):
        raise InputError(f"{where}.library", f"{given['library']!r} is not a name", 'a name such as "steel S235"')
    try:
        material = find(given["library"])
    except InputError as error:
        raise InputError(where, error.problem, f"{error.remedy}; or a table with kind = ...") from None
    choice, known = given.get("law", "elastic"), get_args(LawName)
    if choice not in known:
        raise InputError(f"{where}.law", f"{choice!r} is unknown", nearest(str(choice), known))
    try:
        law = material.law(choice, softening="thermal" in body)
    except InputError as error:
        raise error.within(where) from None
    thermal = body.get("thermal")
    if isinstance(thermal, dict) and "law" not in thermal:
        _conducting(thermal, material, where.removesuffix(".material") + ".thermal")
    more = {key: value for key, value in given.items() if key not in ("library", "law")}
    body["material"] = {**write(law, Law, where), **more}
    body.setdefault("density", f"{material.density!r} kg/m^3")


def _conducting(thermal: dict[str, Any], material: Constants, where: str) -> None:
    """Add the law of conduction of a material, and its expansion if none is given."""
    try:
        thermal["law"] = write(material.conduction(), Conduction, where)
    except InputError as error:
        raise error.within(where) from None
    with_expansion(thermal, material)
