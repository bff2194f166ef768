"""Command materials: a table of all materials, or all data of one material."""

from dataclasses import fields
from typing import Any, get_args

from rich.console import Console
from rich.markup import escape
from rich.table import Table as Grid

from softway.laws.materials.library import everything, find
from softway.laws.materials.material import Isotropic, Material, Orthotropic, Rubber
from softway.scenario.hints.type_hints import hints


def materials(name: str | None = None, /) -> None:
    """Show the materials that a scenario can use by name: material = "steel S235".

    Parameters
    ----------
    name
        Material; all its constants and their sources are shown. By default all materials are listed.
    """
    console = Console()
    if name is not None:
        _one(find(name), console)
        return
    grid = Grid(box=None, pad_edge=False, header_style="bold")
    for head in ("material", "density", "E", "nu", "yield", "source"):
        grid.add_column(head, justify="left" if head in ("material", "source") else "right", overflow="fold")
    grid.add_row("", "kg/m^3", "GPa", "", "MPa", "")
    for material in everything():
        E, nu = _headline(material)
        strength = "" if material.strength is None else f"{material.strength.A / 1e6:g}"
        grid.add_row(escape(material.name), f"{material.density:g}", E, nu, strength, escape(material.source))
    console.print(grid)
    console.print('all data of one material: softway materials "NAME"', highlight=False)


def _headline(material: Material) -> tuple[str, str]:
    """Young's modulus [GPa] and Poisson's ratio as text."""
    match material.moduli:
        case Isotropic(E=E, nu=nu):
            return f"{E / 1e9:g}", f"{nu:g}"
        case Rubber():
            return f"{material.elastic().youngs() / 1e9:.3g}", "Mooney"
        case Orthotropic(E=several):
            return "/".join(f"{E / 1e9:.3g}" for E in several), "orthotropic"


def _one(material: Material, console: Console) -> None:
    """Print all constants of a material with their units."""
    console.print(escape(material.name), style="bold")
    grid = Grid(box=None, pad_edge=False, show_header=False)
    grid.add_row("density", f"{material.density:g}", "kg/m^3")
    for part in (material.moduli, material.strength, material.thermal):
        for row in _rows(part):
            grid.add_row(*row)
    console.print(grid)
    for head, text in (("also", ", ".join(material.aliases)), ("note", material.note), ("source", material.source)):
        if text:
            console.print(f"{head}: {escape(text)}", soft_wrap=True, highlight=False)


def _rows(part: Any) -> list[tuple[str, str, str]]:
    """Name, value and unit of each known constant."""
    rows = []
    for field in fields(part) if part is not None else ():
        value = getattr(part, field.name)
        if value is not None:
            text = ", ".join(f"{v:g}" for v in value) if isinstance(value, tuple) else f"{value:g}"
            rows.append((field.name, text, _unit(hints(type(part))[field.name])))
    return rows


def _unit(hint: Any) -> str:
    """Unit of the numbers in a type hint."""
    known = [arg for arg in get_args(hint) if isinstance(arg, str)]
    return known[0] if known else next((u for arg in get_args(hint) if (u := _unit(arg))), "")
