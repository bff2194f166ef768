"""Checkpoints on the disk: whole or not there, the last ones kept, damaged ones named and passed over."""

import logging
import resource
import signal

import pytest

import softway as sw
from softway.record.storage.checkpoint import FORMAT, Checkpoint, Damaged, forget, last, listed, read, save


@pytest.fixture
def checkpoints() -> list[Checkpoint]:
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=4),
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        velocity=sw.bodies.Uniform(value=0.5),
    )
    steps = sw.march(sw.Scene(bodies={"bar": bar}), until=0.5, step=0.1)
    return [Checkpoint(march_state=s.march_state, marks={"history.csv": 10 * k}, wall=0.5) for k, s in enumerate(steps)]


def test_what_is_read_is_what_was_written(checkpoints, tmp_path):
    found = read(save(tmp_path, checkpoints[0], 2))
    assert found.marks == {"history.csv": 0} and found.wall == 0.5
    one, other = found.march_state, checkpoints[0].march_state
    assert one.settings == other.settings and one.account == other.account and one.step_history == other.step_history
    assert (one.state.start.displacement == other.state.start.displacement).all()


def test_the_last_ones_are_kept(checkpoints, tmp_path):
    assert last(tmp_path) is None
    for point in checkpoints:
        save(tmp_path, point, 2)
    assert [p.name for p in listed(tmp_path)] == ["slab-000000005", "slab-000000004"]
    assert last(tmp_path).march_state.slabs == 5
    forget(tmp_path)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("harm", ["empty", "short", "bit", "head", "other"])
def test_a_damaged_one_is_named_and_the_one_before_used(checkpoints, tmp_path, caplog, harm):
    for point in checkpoints[:2]:
        save(tmp_path, point, 2)
    file = listed(tmp_path)[0]
    content = bytearray(file.read_bytes())
    if harm == "bit":
        content[len(content) // 2] ^= 1
    harmed = {
        "empty": b"", "short": content[:-100], "bit": content, "head": content[1:],
        "other": b"no checkpoint at all\n" + content,
    }  # fmt: skip
    file.write_bytes(bytes(harmed[harm]))
    with caplog.at_level(logging.WARNING):
        assert last(tmp_path).march_state.slabs == 1
    assert file.name in caplog.text and "damaged" in caplog.text
    with pytest.raises(Damaged):
        read(file)


def test_one_of_another_version_is_called_so(checkpoints, tmp_path):
    save(tmp_path, checkpoints[0], 2)
    file = listed(tmp_path)[0]
    file.write_bytes(file.read_bytes().replace(FORMAT.encode(), b"softway checkpoint 1", 1))
    with pytest.raises(Damaged, match="another version of softway .'softway checkpoint 1'"):
        read(file)


def test_without_room_the_one_before_stays(checkpoints, tmp_path):
    """The limit of the size of a file stands for a disk that is full."""
    save(tmp_path, checkpoints[0], 2)
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (1000, before[1]))
        with pytest.raises(OSError, match="too large"):
            save(tmp_path, checkpoints[1], 2)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, handler)
    assert [p.name for p in (tmp_path / "checkpoints").iterdir()] == ["slab-000000001"]
    assert last(tmp_path).march_state.slabs == 1


def test_wrong_plans_name_their_place():
    for wrong in ({"every": -1.0}, {"every": float("inf")}, {"keep": -1}):
        with pytest.raises(sw.InputError) as error:
            sw.record.Checkpoints(**wrong)
        assert error.value.where == next(iter(wrong)) and error.value.remedy
