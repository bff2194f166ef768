"""Hot bimetals whose meshes are replaced: heat of each material, entropy, continuous temperature."""

from dataclasses import replace

import numpy as np
import pytest
from bimetals import HOW, SOFT, accounted, billet, layer, pressed
from forging import KEPT, changes, force
from warm_billets import accounted_changes, keeps_its_heat, temperatures

import softway as sw
from softway.arrays import Array
from softway.bodies.inertia.nodal_heat import heat_masses
from softway.errors import InputError
from softway.model.model import Model

CAPACITIES = {"core": 1e-2, "skin": 3e-2}
LAWS = {name: sw.heat.Conduction(conductivity=one, capacity=one) for name, one in CAPACITIES.items()}
STEEL = LAWS["core"]
TABLE = sw.heat.TemperatureTable(temperatures=(800.0, 1400.0), values=(0.01, 0.02))
LATENT = sw.heat.Latent(heat=1.0, melting=1050.0)
OFTEN = sw.meshes.Remesh(ratio=1.3, shortened=0.0)


def warm(x: Array) -> Array:
    return np.asarray(1000.0 + 200.0 * x[:, 1] - 100.0 * np.cos(6.0 * x[:, 0]))


def contents(model: Model, values: Array) -> Array:
    """Heat contents (2,) of both materials at temperatures (n,) [J]."""
    part = model.parts[0]
    found = []
    for k, capacity in enumerate(CAPACITIES.values()):
        inside = part.materials.owner == k
        found.append(capacity * heat_masses(part.mesh, part.internal.section, part.materials.density, inside) @ values)
    return np.array(found)


@pytest.mark.parametrize("expansion", [0.0, 1e-5])
def test_each_material_keeps_its_heat(expansion: float) -> None:
    thermal = sw.bodies.Thermal(law=LAWS, temperature=warm, expansion=expansion)
    steps = pressed(billet(OFTEN, thermal=thermal), 0.3, 8)
    assert len(changes(steps)) > 1
    accounted(steps)
    for last, taken in accounted_changes(steps):
        old, new = temperatures(last), taken.before.fields["temperature"]["body"][:, 0]
        np.testing.assert_allclose(contents(taken.model, new), contents(last.model, old), rtol=1e-12)
        assert old.min() * (1.0 - 1e-12) <= new.min()
        assert new.max() <= old.max() * (1.0 + 1e-12)


def test_as_on_the_mesh_of_the_start_while_that_is_good() -> None:
    thermal = sw.bodies.Thermal(law=LAWS, temperature=warm)
    kept, new = (pressed(billet(how, where=layer, thermal=thermal), 0.2, 10) for how in (KEPT, OFTEN))
    assert changes(new)
    one, other = kept[-1].ledger.heat, new[-1].ledger.heat
    assert one is not None
    assert other is not None
    assert other.received == pytest.approx(one.received, rel=5e-3)
    assert force(new[-1]) == pytest.approx(force(kept[-1]), rel=5e-3)
    found = contents(new[-1].model, temperatures(new[-1]))
    assert found == pytest.approx(contents(kept[-1].model, temperatures(kept[-1])), rel=1e-3)


def test_a_uniform_temperature_stays() -> None:
    thermal = sw.bodies.Thermal(law=LAWS, temperature=1000.0, heating=0.0)
    steps = pressed(billet(OFTEN, thermal=thermal), 0.2, 4)
    assert changes(steps)
    assert temperatures(steps[-1]) == pytest.approx(1000.0, rel=1e-12)


@pytest.mark.parametrize(
    "law",
    [
        pytest.param(replace(STEEL, capacity=TABLE), id="capacity by temperature"),
        pytest.param(replace(STEEL, latent=LATENT), id="cut cells"),
        pytest.param(replace(STEEL, latent=replace(LATENT, half_range=20.0)), id="mushy"),
    ],
)
def test_one_law_of_heat_of_several_materials(law: sw.heat.Conduction) -> None:
    steps = pressed(billet(OFTEN, thermal=sw.bodies.Thermal(law=law, temperature=warm)), 0.25, 5)
    assert list(accounted_changes(steps))


def test_laws_that_soften() -> None:
    soft = replace(SOFT, softening=sw.laws.JohnsonCookSoftening(reference=300.0, melting=1800.0))
    thermal = sw.bodies.Thermal(law=LAWS, temperature=warm)
    steps = pressed(billet(OFTEN, thermal=thermal, laws={"core": soft, "skin": SOFT}), 0.2, 5)
    assert changes(steps)
    keeps_its_heat(steps)


@pytest.mark.parametrize(
    "law",
    [
        pytest.param({"core": replace(STEEL, capacity=TABLE), "skin": STEEL}, id="table"),
        pytest.param({"low": STEEL, "high": LAWS["skin"]}, id="other regions"),
    ],
)
def test_laws_of_heat_that_do_not_pass(law: dict[str, sw.heat.Conduction]) -> None:
    scene = billet(sw.meshes.Remesh(), thermal=sw.bodies.Thermal(law=law, temperature=1000.0))
    body = scene.bodies["body"]
    assert isinstance(body, sw.Solid)
    mesh = body.mesh.with_region("low", layer).with_region("high", lambda x: ~layer(x))  # type: ignore[union-attr]
    scene = replace(scene, bodies={**scene.bodies, "body": replace(body, mesh=mesh)})
    with pytest.raises(InputError) as refusal:
        sw.march(scene, until=1e-3, step=1e-3)
    assert refusal.value.where == "bodies.body.thermal.law"
    assert "mesh that stays" in refusal.value.remedy
    laws = dict.fromkeys(law, SOFT) if "low" in law else {"core": SOFT, "skin": SOFT}
    thermal = sw.bodies.Thermal(law=law if "low" in law else STEEL, temperature=1000.0)
    body = replace(body, mesh=mesh, material=laws, density=1.0, thermal=thermal)
    sw.march(replace(scene, bodies={**scene.bodies, "body": body}), until=1e-3, step=1e-3)


@pytest.mark.slow
def test_a_hot_bimetal_upset_to_half_of_its_height() -> None:
    thermal = sw.bodies.Thermal(law=LAWS, temperature=warm)
    steps = pressed(billet(HOW, thermal=thermal), 0.5, 20)
    assert len(changes(steps)) >= 4
    accounted(steps)
    for last, taken in accounted_changes(steps):
        new = taken.before.fields["temperature"]["body"][:, 0]
        np.testing.assert_allclose(contents(taken.model, new), contents(last.model, temperatures(last)), rtol=1e-12)
