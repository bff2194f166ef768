"""E02: upsetting of a cylinder with the friction of Norton and Hoff: force curve and barrelling."""

import numpy as np

import results
import softway as sw
from softway.verify.scenes.forming import Press

PRESS = Press(
    material=sw.NortonHoff(K=1.0, m=0.3),
    outer=1.0,
    height=0.75,
    friction=sw.NortonHoffFriction(alpha=0.3, p=0.3, K=1.0),
    slabs=20,
)


def test_the_case() -> None:
    found = {
        "F at reduction 0": PRESS.force_at(0.0),
        "F at 30%": PRESS.force_at(0.3),
        "barrelling r_mid - r_platen at 30%": PRESS.radius("outer", "middle") - PRESS.radius("outer", "platen"),
    }
    assert results.outside("E02", found) == set()


def test_the_whole_curve() -> None:
    """Far within the tolerance of the case, 12 x 10 linear cells against 12 x 10 quadratic ones."""
    table = np.array(results.case("E02")["reference"]["fine_12x10x24"])
    found = [PRESS.force_at(r) for r in table[:, 0]]
    np.testing.assert_allclose(found, table[:, 1], rtol=2e-3)
    assert abs(PRESS.radius("outer", "middle") - table[-1, 2]) < 1e-3
    assert abs(PRESS.radius("outer", "platen") - table[-1, 3]) < 1e-3


def test_the_ledger_closes_and_friction_takes_its_part() -> None:
    """All work is dissipated: what the volume stores is the share 1/bulk."""
    assert PRESS.ledger_error < 1e-8
    last = PRESS.steps[-1].ledger
    assert 0.999 < last.dissipation / last.work_external <= 1.0
    assert last.contacts["platen"].force_t > 0.0
    assert PRESS.most_iterations <= 20
