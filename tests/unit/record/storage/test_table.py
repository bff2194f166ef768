"""history.csv, events.csv and their reader."""

import math

import numpy as np
import pytest

from softway.errors import InputError
from softway.record.storage import table
from softway.record.write.events import open_events
from softway.record.write.history import open_history
from softway.record.write.probes import readings


def recorded(fake, folder, opener):
    recorder = opener(folder, fake.opening())
    for step in fake.steps():
        recorder.take(step)
    return recorder


def test_history_has_a_row_per_slab_with_all_digits(bar, tmp_path):
    recorder = recorded(bar, tmp_path, open_history)
    read = table.read(tmp_path / "history.csv")  # before closing: rows are on the disk
    recorder.close()
    assert read.rows == bar.slabs + 1
    np.testing.assert_array_equal(read["time"], np.linspace(0.0, 1.0, bar.slabs + 1))
    np.testing.assert_array_equal(read["energy_kinetic"], 1.0 / 3.0)
    np.testing.assert_array_equal(read["spin_y"], 3.0)
    names = ("min_gap", "min_force", "complementarity", "power_residual", "momentum_error", "energy_error")
    assert [read[f"certificate.{name}"][-1] for name in names] == [0.5, 1.5, 2.5, 3.5, 4.5, 5.5]
    assert not any(read[f"certificate.{name}"][0] for name in names[1:])
    assert read.units["momentum_z"] == "kg m/s" and read.units["contact.part.surface-floor.force_n"] == "N"
    assert read["h"][0] == 0.0 and read["iterations"].dtype == np.int64


def test_history_header_is_name_and_unit(bar, tmp_path):
    open_history(tmp_path, bar.opening()).close()
    header = (tmp_path / "history.csv").read_text().splitlines()[0].split(",")
    assert header[:5] == ["time [s]", "h [s]", "iterations [1]", "pairs [1]", "contraction [ratio]"]
    assert header[16] == "contact.part.surface-floor.force_n [N]" and header[28:30] == [
        "certificate.shape [ratio]",
        "tip [m]",
    ]
    assert header[20] == "certificate.min_gap [m]" and header[25] == "certificate.energy_error [J]"


def test_probes(bar, tmp_path):
    recorded(bar, tmp_path, open_history).close()
    read = table.read(tmp_path / "history.csv")
    u = [bar.state(t).displacement["part"][:, 0] for t in read["time"]]
    np.testing.assert_array_equal(read["tip"], [x[-1] for x in u])
    np.testing.assert_array_equal(read["middle"], [0.5 + x[2] for x in u])
    assert set(read["speed"]) == {1.0, 0.0} and read["support"][1] == 5.0 and math.isnan(read["support"][0])


@pytest.mark.parametrize(
    ("wrong", "path"),
    [
        ({"of": "nobody", "tag": "right"}, "output.probes[0].of"),
        ({"tag": "rigth"}, "output.probes[0].tag"),
        ({}, "output.probes[0]"),
        ({"at": (1.0, 2.0)}, "output.probes[0].at"),
        ({"tag": "right", "component": "z"}, "output.probes[0].component"),
        ({"tag": "right", "quantity": "colour"}, "output.probes[0].quantity"),
        ({"name": "a,b", "tag": "right"}, "output.probes[0].name"),
    ],
)
def test_wrong_probes_name_their_place(bar, probe, wrong, path):
    with pytest.raises(InputError) as error:
        readings([probe(**{"name": "p", **wrong})], {"part": bar.mesh})
    assert error.value.where == path and error.value.remedy


def test_events(fake, tmp_path):
    recorded(fake, tmp_path, open_events).close()
    read = table.read(tmp_path / "events.csv")
    assert list(read["kind"]) == ["touch", "release"] and list(read["time"]) == [0.4, 0.6]
    assert read["node"].dtype == np.int64 and read["impulse"][0] == 0.25 and read.units["x"] == "m"
    assert list(read["contact"]) == ["part.surface-floor"] * 2


def test_half_a_line_at_the_end_is_left_out(tmp_path):
    file = tmp_path / "t.csv"
    file.write_text("time [s],kind [-]\n1.5,touch\n2.5,to")
    read = table.read(file)
    assert read["time"].tolist() == [1.5] and read.rows == 1 and dict(read.units) == {"time": "s", "kind": "-"}


def test_tables_cannot_be_changed(tmp_path):
    read = table.parse("a [m]\n1\n")
    with pytest.raises(ValueError, match="read-only"):
        read["a"][0] = 2.0
    assert table.parse("").rows == 0 and "a" in repr(read)


def test_names_with_commas_survive(tmp_path):
    rows = table.lines(tmp_path / "t.csv")
    rows.write(table.header([("contact.a,b.force_n", "N")]))
    rows.write([0.1])
    rows.close()
    assert table.read(tmp_path / "t.csv")["contact.a,b.force_n"].tolist() == [0.1]
