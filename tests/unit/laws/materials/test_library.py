"""The materials: laws that pass, numbers that follow from their sources, names."""

import re
import tomllib
from collections.abc import Mapping
from dataclasses import fields
from importlib import resources
from pathlib import Path

import numpy as np
import pytest

from softway.errors import InputError
from softway.laws.bulk import J2, LinearElastic, LinearOrthotropic, MooneyRivlin, NeoHookean
from softway.laws.law import Increment
from softway.laws.materials import Material, find, names
from softway.laws.materials.library import everything
from softway.testing import check_law

ALL = list(everything())
PLASTIC = [m for m in ALL if m.strength is not None]


@pytest.mark.few(5)
@pytest.mark.parametrize("material", ALL, ids=lambda m: m.name)
def test_its_elastic_laws_pass(material: Material) -> None:
    check_law(material.elastic())
    check_law(material.linear())


@pytest.mark.parametrize("material", ALL, ids=lambda m: m.name)
def test_its_elastic_laws_have_the_same_moduli(material: Material) -> None:
    assert material.linear().youngs() == pytest.approx(material.elastic().youngs(), rel=1e-12)
    assert material.linear().wave_speed(1.0) == pytest.approx(material.elastic().wave_speed(1.0), rel=1e-9)


@pytest.mark.parametrize("name", ["steel S235", "copper OFHC"])
def test_its_plastic_law_passes(name: str) -> None:
    check_law(find(name).plastic())


def test_there_are_enough_and_each_has_its_source() -> None:
    assert len(ALL) >= 14
    assert all(m.source and m.density > 0.0 for m in ALL)
    words = [w.casefold() for m in ALL for w in (m.name, *m.aliases)]
    assert len(words) == len(set(words))
    assert names() == tuple(m.name for m in ALL)


def test_names_and_aliases() -> None:
    assert find("STEEL s235") == find("S235") == find(" structural steel ")
    assert find("rubber").name == "natural rubber"
    with pytest.raises(InputError, match="did you mean 'aluminium 6061-T6'") as found:
        find("aluminium 6061T6")
    assert found.value.where == "material"


def test_kinds_of_laws() -> None:
    assert isinstance(find("glass").elastic(), NeoHookean) and isinstance(find("glass").linear(), LinearElastic)
    assert isinstance(find("rubber").elastic(), MooneyRivlin)
    wood = find("wood")
    assert isinstance(wood.elastic(), LinearOrthotropic) and wood.linear().linear and not wood.elastic().linear
    assert isinstance(find("lead").law("linear"), LinearElastic)
    for name in ("glass", "wood", "rubber"):
        with pytest.raises(InputError, match="no yield stress"):
            find(name).plastic()


@pytest.mark.parametrize("material", PLASTIC, ids=lambda m: m.name)
def test_flow_stress_of_johnson_and_cook(material: Material) -> None:
    """A long uniaxial pull at a rate of 10/s ends on (A + B p^n)(1 + C ln rate)."""
    law, given = material.plastic(), material.strength
    assert isinstance(law, J2) and given is not None
    strain = 0.2 * np.diag([1.0, -0.5, -0.5])[None]
    response = law.respond(Increment(stress=np.zeros((1, 3, 3)), memory=law.virgin(1), strain=strain, span=0.02))
    p = float(response.memory["plastic_strain"][0])
    s = response.stress[0]
    s = s - np.trace(s) / 3.0 * np.eye(3)
    flow = np.sqrt(1.5 * np.sum(s * s))
    assert flow == pytest.approx((given.A + given.B * p**given.n) * (1.0 + given.C * np.log(p / 0.02)), rel=1e-9)


def test_steel_has_the_thermal_constants_of_its_formulas() -> None:
    """EN 1993-1-2, 3.4.1.2 and 3.4.1.3 at 20 degrees."""
    thermal = find("S235").thermal
    assert thermal is not None
    assert thermal.conductivity == pytest.approx(54.0 - 3.33e-2 * 20.0, abs=0.05)
    assert thermal.capacity == pytest.approx(425.0 + 0.773 * 20.0 - 1.69e-3 * 400.0 + 2.22e-6 * 8000.0, abs=0.5)


def test_the_third_factor_of_johnson_and_cook() -> None:
    """Half of the flow stress is lost at T* = .5^(1/m); materials without the constants keep theirs."""
    for material in PLASTIC:
        given, law = material.strength, material.plastic(softening=True)
        assert given is not None and material.plastic().softening is None
        assert (law.softening is None) == (given.m is None or given.melting is None)
        if law.softening is not None:
            half = 298.0 + (given.melting - 298.0) * 0.5 ** (1.0 / given.m)
            assert law.softening.at(np.array([200.0, 298.0, half, given.melting])) == pytest.approx(
                [1.0, 1.0, 0.5, 0.0]
            )
    assert sum(m.plastic(softening=True).softening is not None for m in PLASTIC) >= 5


def test_melting_heats_are_those_of_a_mole() -> None:
    """Enthalpies of fusion in kJ/mol and molar masses in g/mol, CRC Handbook of chemistry and physics."""
    moles = {"iron": (13.81, 55.845), "copper": (13.26, 63.546), "lead": (4.77, 207.2), "tungsten": (52.31, 183.84)}
    for name, (heat, mass) in moles.items():
        thermal = find(name).thermal
        assert thermal is not None and thermal.latent == pytest.approx(1e6 * heat / mass, rel=2e-3)
    law = find("iron").conduction(latent=True)
    assert law.latent is not None and (law.latent.melting, law.latent.heat) == (1811.0, 247.3e3)
    assert find("iron").conduction().latent is None and find("iron").conduction().conductivity == 73.0


def test_every_metal_has_all_constants_of_heat() -> None:
    text = (resources.files("softway.laws.materials") / "data" / "metals.toml").read_text(encoding="utf-8")
    assert len(names := tomllib.loads(text)) >= 10
    for name in names:
        thermal = find(name).thermal
        assert thermal is not None
        assert not [field.name for field in fields(thermal) if getattr(thermal, field.name) is None], name
        assert find(name).conduction(latent=True).latent is not None


MOLES = {
    "Fe": (13.81, 55.845),
    "Cr": (21.00, 51.996),
    "Ni": (17.48, 58.693),
    "Mn": (12.91, 54.938),
    "Mo": (37.48, 95.95),
    "Si": (50.21, 28.086),
    "Al": (10.71, 26.982),
    "Mg": (8.48, 24.305),
    "Cu": (13.26, 63.546),
    "Ti": (14.15, 47.867),
    "V": (21.5, 50.942),
}
"""Enthalpies of fusion [kJ/mol] and molar masses [g/mol], CRC Handbook of chemistry and physics."""
ALLOYS = {
    "steel S235": {"Fe": 100.0},
    "stainless steel 304": {"Fe": 72.0, "Cr": 18.0, "Ni": 10.0},
    "steel 4340": {"Fe": 96.2, "Ni": 1.8, "Cr": 0.8, "Mn": 0.7, "Mo": 0.25, "Si": 0.25},
    "aluminium 6061-T6": {"Al": 97.9, "Mg": 1.0, "Si": 0.6, "Cu": 0.28, "Cr": 0.2},
    "aluminium 2024-T3": {"Al": 93.5, "Cu": 4.4, "Mg": 1.5, "Mn": 0.6},
}


def of_its_elements(shares: Mapping[str, float]) -> float:
    """Latent heat [J/kg] of shares by mass [%]."""
    return sum(0.01 * share * 1e6 * MOLES[name][0] / MOLES[name][1] for name, share in shares.items())


@pytest.mark.parametrize("name", ALLOYS)
def test_latent_heats_of_alloys_are_those_of_their_elements(name: str) -> None:
    thermal = find(name).thermal
    assert thermal is not None and thermal.latent == pytest.approx(of_its_elements(ALLOYS[name]), rel=3e-3)


def test_the_elements_of_titanium_have_nearly_the_latent_heat_of_its_measurement() -> None:
    """Measured within 6 %; the sum over the elements is within a tenth."""
    thermal = find("Ti64").thermal
    assert thermal is not None
    assert thermal.latent == pytest.approx(of_its_elements({"Ti": 90.0, "Al": 6.0, "V": 4.0}), rel=0.1)


def test_capacities_of_elements_are_those_of_a_mole() -> None:
    """J/(mol K), CRC Handbook, standard thermodynamic properties; the law of Dulong and Petit is 3 R."""
    for name, (heat, mass) in {"lead": (26.4, 207.2), "tungsten": (24.3, 183.84)}.items():
        thermal = find(name).thermal
        assert thermal is not None and thermal.capacity == pytest.approx(1e3 * heat / mass, rel=4e-3)
        assert thermal.capacity == pytest.approx(3e3 * 8.314 / mass, rel=0.08)


@pytest.mark.parametrize(
    ("name", "missing"), [("nylon", "conductivity"), ("concrete", "conductivity"), ("glass", "melting")]
)
def test_what_is_not_known_of_heat_is_named(name: str, missing: str) -> None:
    with pytest.raises(InputError, match=f"no {missing}"):
        find(name).conduction(latent=True)


def test_ice_is_the_mean_of_its_crystal() -> None:
    """Hill's mean of c11, c12, c13, c33, c44 = 13.929, 7.082, 5.765, 15.010, 3.014 GPa (Gammon and others 1983)."""
    c11, c12, c13, c33, c44 = 13.929, 7.082, 5.765, 15.010, 3.014
    C = np.zeros((6, 6))
    C[:3, :3] = [[c11, c12, c13], [c12, c11, c13], [c13, c13, c33]]
    C[3, 3] = C[4, 4] = c44
    C[5, 5] = 0.5 * (c11 - c12)
    S = np.linalg.inv(C)
    side, other = np.trace(C[:3, :3]), C[0, 1] + C[1, 2] + C[0, 2]
    soft, mixed = np.trace(S[:3, :3]), S[0, 1] + S[1, 2] + S[0, 2]
    bulk = 0.5 * (C[:3, :3].sum() / 9.0 + 1.0 / S[:3, :3].sum())
    voigt = (side - other + 3.0 * np.trace(C[3:, 3:])) / 15.0
    reuss = 15.0 / (4.0 * soft - 4.0 * mixed + 3.0 * np.trace(S[3:, 3:]))
    shear = 0.5 * (voigt + reuss)
    law = find("ice").elastic()
    assert pytest.approx(9.0 * bulk * shear / (3.0 * bulk + shear), abs=0.005) == law.E / 1e9
    assert law.nu == pytest.approx((3.0 * bulk - 2.0 * shear) / (6.0 * bulk + 2.0 * shear), abs=5e-4)


def test_rubber_is_the_line_through_mooneys_plot() -> None:
    """Tension of Treloar (1944), nominal stress in kgf/cm^2; the shear modulus of Wood is 0.43 MPa."""
    stretch = np.array([1.12, 1.24, 1.39, 1.61, 1.89, 2.17, 2.42, 3.01])
    stress = 9.80665e4 * np.array([1.37, 2.30, 3.23, 4.16, 5.10, 6.00, 6.90, 8.80])
    reduced = stress / (2.0 * (stretch - stretch**-2))
    line = np.polyfit(1.0 / stretch, reduced, 1)
    law = find("rubber").elastic()
    assert (law.c01, law.c10) == (pytest.approx(line[0], abs=1e3), pytest.approx(line[1], abs=1e3))
    assert 2.0 * (law.c10 + law.c01) == pytest.approx(0.43e6, abs=0.01e6)


def test_wood_has_the_ratios_of_the_handbook() -> None:
    law = find("wood").linear()
    E = law.E[0]
    assert pytest.approx(1.1 * 13.4e9, rel=1e-12) == E
    assert (law.E[1] / E, law.E[2] / E) == (pytest.approx(0.068, abs=5e-4), pytest.approx(0.050, abs=5e-4))
    assert [g / E for g in law.G] == pytest.approx([0.064, 0.078, 0.007], abs=5e-4)
    assert find("wood").density == pytest.approx(0.48 * 1.12 * 1000.0, abs=0.5)


def test_the_page_lists_them_as_they_are() -> None:
    page = (Path(__file__).parents[4] / "docs" / "how-to" / "materials.md").read_text(encoding="utf-8")
    rows = {
        line.split(" | ")[0].strip("| "): line.strip("|").split(" | ") for line in page.splitlines() if " | " in line
    }
    for material in ALL:
        cells = [cell.strip() for cell in rows[material.name]]
        assert float(cells[1]) == material.density and cells[5] == material.note
        assert cells[4] == ("" if material.strength is None else f"{material.strength.A / 1e6:g}")
    code = re.findall(r"^```python\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
    exec(compile(code[0], "materials.md", "exec"), {})


def test_every_constant_is_a_number() -> None:
    for material in ALL:
        for part in (material.moduli, material.strength, material.thermal):
            for field in fields(part) if part is not None else ():
                value = getattr(part, field.name)
                assert value is None or np.isfinite(value).all()
