"""The heat of solids in the summary of a run."""

import json

import numpy as np
import pytest

from softway.record.read.heat_summary import summarise_solids
from softway.record.storage.table import Table


def test_numbers_of_the_end_and_of_the_worst_slab():
    history = Table(
        {
            "heat.content": np.array([10.0, 11.0, 12.5]),
            "heat.brought": np.array([0.0, 1.0, 2.0]),
            "heat.received": np.array([0.0, 0.25, 0.5]),
            "heat.friction": np.array([0.0, 0.1, 0.2]),
            "heat.cold_work": np.array([0.0, 0.0, 0.05]),
            "heat.error": np.array([0.0, -3e-12, 1e-12]),
            "heat.entropy": np.array([0.3, 0.2, 0.5]),
            "liquid.ring": np.array([0.0, 0.0, 0.25]),
            "temperature.iron": np.array([300.0, 310.0, 320.0]),
        }
    )
    found = summarise_solids(history)
    assert (
        found["heat_content_end"] == 12.5 and found["heat_brought"] == 2.0 and found["cold_work"] == pytest.approx(0.05)
    )
    assert found["heat_error_worst"] == pytest.approx(3e-12)
    assert found["entropy_least"] == pytest.approx(-0.1)
    assert found["entropy_produced"] == pytest.approx(0.5)
    assert found["liquid.ring"] == 0.25 and found["temperature.iron"] == 320.0
    assert json.dumps(found)
    assert summarise_solids(Table({"time": np.zeros(2)})) == {}
