"""The curves of a run where its numbers are unusual: nothing but work, nothing touched, gaps of rounding."""

import numpy as np
import pytest

from softway.record.storage.table import Table
from softway.record.view.plots.heat_panels import heat_panels_of_solids
from softway.record.view.plots.history import energies, forces, gaps
from softway.record.view.style import canvas

TIME = np.linspace(0.0, 1.0, 5)


@pytest.fixture
def axis():
    return canvas(4.0, 3.0).subplots()


def table(**columns):
    names = ("energy_kinetic", "energy_strain", "dissipation", "work_external")
    return Table({name: np.zeros(5) for name in names} | columns)


def test_work_decides_the_unit_where_nothing_else_is_stored(axis):
    """A forming without inertia: the work is a joule, strain energy a microjoule."""
    energies(axis, TIME, table(energy_strain=1e-6 * TIME, dissipation=TIME, work_external=TIME))
    assert axis.get_ylabel() == "energy [J]" and axis.dataLim.y1 == pytest.approx(1.0)
    assert [line.get_label() for line in axis.lines][-2:] == ["dissipated", "external work"]


def test_gaps_of_rounding_are_no_distance(axis):
    gaps(axis, TIME, table(**{"contact.a.min_gap": np.array([0.0, -2e-16, 0.0, 0.0, -1e-16])}), ("a",))
    assert axis.get_ylabel() == "gap [nm]" and axis.get_ylim() == (-1.0, 1.0)


def test_a_zero_force_lies_on_the_axis(axis):
    forces(axis, TIME, table(**{"contact.a.force_n": np.zeros(5)}), ("a",))
    assert axis.get_ylim() == (0.0, 1.0)


def test_the_heats_of_solids_begin_at_zero(axis):
    heats = {"heat.received": 2e3 + 3e3 * TIME, "heat.brought": -1e3 * TIME, "heat.cold_work": np.zeros(5)}
    draw = heat_panels_of_solids(table(**heats))[0]
    draw(axis, TIME, table(**heats))
    assert axis.get_ylabel() == "heat [kJ]"
    assert [line.get_ydata()[-1] for line in axis.lines] == pytest.approx([3.0, -1.0, 0.0])  # of an earlier version
    axis.clear()
    draw(axis, TIME, table(**heats, **{"heat.friction": 1e3 * TIME}))
    assert [line.get_ydata()[-1] for line in axis.lines] == pytest.approx([3.0, 1.0, -1.0, 0.0])
