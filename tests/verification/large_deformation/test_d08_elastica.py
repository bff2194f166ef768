"""D08: the elastica, a slender cantilever with a dead load at its tip that bends it far."""

import pytest

import results
import softway as sw
from softway.apps.verify.cases.large_deformation.d08_elastica import YOUNGS, bent

TABLE = {float(k): v for k, v in results.case("D08")["reference"]["table"].items()}


@pytest.mark.parametrize("k", TABLE)
def test_elastic(k: float) -> None:
    """A load step or two; what remains is the stretch of the axis and the shear of a beam of finite height."""
    found = bent(k)
    assert found[0] == pytest.approx(TABLE[k][0], rel=6e-4)
    assert found[1] == pytest.approx(TABLE[k][1], rel=2e-3)


def test_hypoelastic() -> None:
    """The stress is carried along through all the rotation: ten steps are within a part in a thousand."""
    found = bent(5.0, sw.Hypoelastic(E=YOUNGS), 10)
    assert found[0] == pytest.approx(TABLE[5.0][0], rel=1e-3)
    assert found[1] == pytest.approx(TABLE[5.0][1], rel=3e-3)


def test_the_case() -> None:
    assert results.missed("D08") == set()
