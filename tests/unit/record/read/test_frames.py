"""Frames by their numbers and by slices."""

import pytest

import softway as sw


def test_slices_of_the_frames_are_tuples_of_them(tmp_path):
    bar = sw.Solid(mesh=sw.meshes.Interval(length=1.0, cells=4), material=sw.LinearElastic(E=1.0), density=1.0)
    made = sw.Scenario(bodies={"bar": bar}, time=sw.Time(end=0.2, step=0.1))
    fields = sw.run(made, tmp_path / "run").fields
    assert [frame.time for frame in fields[::-1]] == [frame.time for frame in fields][::-1]
    assert fields[5:5] == () and fields[-1:][0].time == pytest.approx(0.2)
    with pytest.raises(IndexError, match="frame 7 of"):
        fields[7]
