"""E04: a slice of Newton's fluid in plane strain under a platen with linear friction."""

import numpy as np

import results
import softway as sw
from softway.verify.scenes.forming import Press

PRESS = Press(
    material=sw.NortonHoff(K=1.0, m=1.0),
    outer=2.0,
    height=0.5,
    friction=sw.NortonHoffFriction(alpha=0.4, p=1.0, K=1.0),
    section=sw.PlaneStrain(),
    cells=(24, 10),
    stroke=0.2,
    slabs=20,
)


def test_the_case() -> None:
    found = {
        "F0 per half width per unit depth": PRESS.force_at(0.0),
        "F at 20%": PRESS.force_at(0.2),
    }
    assert results.outside("E04", found) == set()


def test_the_whole_curve() -> None:
    table = np.array(results.case("E04")["reference"]["table"])
    np.testing.assert_allclose([PRESS.force_at(r) for r in table[1:, 0]], table[1:, 1], rtol=4e-3)
    assert abs(PRESS.radius("outer", "middle") - table[-1, 2]) < 2e-3
    assert abs(PRESS.radius("outer", "platen") - table[-1, 3]) < 2e-3
    assert PRESS.ledger_error < 1e-8
