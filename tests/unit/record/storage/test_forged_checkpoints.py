"""Checkpoints that somebody forged, with the right checksum: named and passed over, and no code of theirs is run."""

import hashlib
import io
import json
import logging
import pickle
import random
import resource
import shutil
import zipfile
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import softway as sw
from softway.apps.cli import main
from softway.marching.start.initial_state import initial_state
from softway.marching.start.stored_state import require_of_model
from softway.marching.state.march_state import MarchState
from softway.record.storage.checkpoint import FORMAT, Damaged, last, listed, read
from softway.scenario.checks.check import check
from softway.scenario.files import loads

BLOCKS = """
[bodies.lower]
kind = "Solid"
mesh = { kind = "Rectangle", size = ["1 m", "0.5 m"], cells = [2, 1] }
material = { kind = "J2", E = "1 Pa", nu = 0.3, yield_stress = "0.01 Pa" }
density = "1 kg/m^3"
supports = [{ on = "bottom" }]

[bodies.upper]
kind = "Solid"
mesh = { kind = "Rectangle", size = ["0.5 m", "0.5 m"], cells = [1, 1], origin = ["0.2 m", "0.51 m"] }
material = { kind = "LinearElastic", E = "1 Pa", nu = 0.3 }
density = "1 kg/m^3"
velocity = ["0.02 m/s", "-0.1 m/s"]

[[contacts]]
between = ["upper.bottom", "lower.top"]
friction = { kind = "Coulomb", mu = 0.3 }

[time]
end = "0.6 s"
step = "0.1 s"

[output]
checkpoints = { every = "0 s", keep = 1 }
"""
"""History of a material, friction, and rows between two bodies."""


class Bomb:
    """What runs code when it is read as a pickle."""

    def __reduce__(self) -> tuple[Any, tuple[str]]:
        return pytest.fail, ("code of the file was run",)


@pytest.fixture(scope="module")
def stopped(tmp_path_factory) -> Path:
    """A run that was interrupted in contact."""
    folder = tmp_path_factory.mktemp("forged") / "run"

    def stop(progress: sw.Progress) -> None:
        if progress.slabs == 4:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sw.run(loads(BLOCKS), folder, progress=stop)
    assert [f.name for f in listed(folder)] == ["slab-000000004"]
    return folder


Content = dict[str, bytes]


def content_of(file: Path) -> Content:
    with zipfile.ZipFile(io.BytesIO(file.read_bytes().partition(b"\n")[2])) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def forge(file: Path, content: Content, packing: int = zipfile.ZIP_STORED) -> None:
    """Write a checkpoint of this content, with its checksum."""
    body = io.BytesIO()
    with zipfile.ZipFile(body, "w", packing) as archive:
        for name, data in content.items():
            archive.writestr(name, data)
    data = body.getvalue()
    file.write_bytes(f"{FORMAT} {hashlib.sha256(data).hexdigest()}\n".encode() + data)


def array(values: Any, **options: Any) -> bytes:
    file = io.BytesIO()
    np.save(file, np.asarray(values), **options)
    return file.getvalue()


def about_of(content: Content) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(np.load(io.BytesIO(content["about.npy"])).tobytes())
    return {**found, "march_state": json.loads(found["march_state"])}


def with_about(content: Content, about: dict[str, Any]) -> Content:
    text = json.dumps({**about, "march_state": json.dumps(about["march_state"])})
    return {**content, "about.npy": array(np.frombuffer(text.encode(), np.uint8))}


def header(shape: str, kind: str = "<f8") -> bytes:
    text = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}".ljust(117) + "\n"
    return b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text.encode()


ARCHIVES: dict[str, Callable[[Content], Content]] = {
    "pickle": lambda c: {**c, "array0.npy": array([Bomb()], allow_pickle=True)},
    "pickle alone": lambda c: {**c, "array0.npy": pickle.dumps(Bomb())},
    "a trillion numbers": lambda c: {**c, "array0.npy": header("(1000000000000,)") + bytes(8)},
    "negative": lambda c: {**c, "array0.npy": header("(-1, -8)") + bytes(64)},
    "huge and empty": lambda c: {**c, "array0.npy": header("(99999999999999999999, 0)")},
    "text": lambda c: {**c, "array0.npy": array(["a", "b"])},
    "complex": lambda c: {**c, "array0.npy": array([1j])},
    "times": lambda c: {**c, "array0.npy": array([1], allow_pickle=False).replace(b"<i8", b"<M8")},
    "code in the header": lambda c: {**c, "array0.npy": header("(__import__('os').abort(),)") + bytes(8)},
    "no array": lambda c: {**c, "array0.npy": b"rubbish"},
    "nothing": lambda c: {},
    "no text": lambda c: {**c, "about.npy": array(np.zeros(3, np.uint8))},
}


@pytest.mark.parametrize("harm", ARCHIVES)
def test_a_forged_archive_is_damaged(stopped, tmp_path, harm):
    file = tmp_path / "slab-000000004"
    forge(file, ARCHIVES[harm](content_of(listed(stopped)[0])))
    with pytest.raises(Damaged, match="is damaged"):
        read(file)


def test_an_archive_that_unfolds_is_damaged(stopped, tmp_path):
    """A gigabyte of zeros in a megabyte: it is refused before it is unfolded."""
    file, content = tmp_path / "slab-000000004", content_of(listed(stopped)[0])
    forge(file, {**content, "array0.npy": array(np.zeros(1 << 20))}, zipfile.ZIP_DEFLATED)
    with pytest.raises(Damaged, match="packed"):
        read(file)


STATES: dict[str, Callable[[dict[str, Any]], dict[str, Any]]] = {
    "class": lambda s: {**s, "kind": "subprocess.Popen"},
    "class of ours": lambda s: {**s, "kind": "EndPeaks"},
    "fields": lambda s: {"kind": s["kind"], "with": {**s["with"], "more": 1}},
    "text for number": lambda s: {"kind": s["kind"], "with": {**s["with"], "slabs": "4"}},
    "no number": lambda s: {"kind": s["kind"], "with": {**s["with"], "slabs": float("nan")}},
    "list": lambda s: [s],
    "nothing": lambda s: None,
    "number for class": lambda s: {"kind": s["kind"], "with": {**s["with"], "state": 1.0}},
    "another class": lambda s: {"kind": s["kind"], "with": {**s["with"], "state": s["with"]["account"]}},
    "missing array": lambda s: {"kind": s["kind"], "with": {**s["with"], "state": {"array": "array999", "axes": [0]}}},
    "axes": lambda s: {"kind": s["kind"], "with": {**s["with"], "state": {"array": "array0", "axes": [7, 7, 7]}}},
    "matrix": lambda s: {"kind": s["kind"], "with": {**s["with"], "state": {"rows": [1, 2], "shape": [10**12]}}},
}


@pytest.mark.parametrize("harm", STATES)
def test_a_forged_state_is_damaged(stopped, tmp_path, harm):
    file, content = tmp_path / "slab-000000004", content_of(listed(stopped)[0])
    about = about_of(content)
    forge(file, with_about(content, {**about, "march_state": STATES[harm](about["march_state"])}))
    with pytest.raises(Damaged, match="is damaged"):
        read(file)


def test_a_deep_state_and_wrong_marks_are_damaged(stopped, tmp_path):
    file, content = tmp_path / "slab-000000004", content_of(listed(stopped)[0])
    about = about_of(content)
    deep = json.dumps({**about, "march_state": "[" * 100_000 + "]" * 100_000})
    forge(file, {**content, "about.npy": array(np.frombuffer(deep.encode(), np.uint8))})
    with pytest.raises(Damaged, match="Recursion"):
        read(file)
    negative = {"marks": {"fields.vtkhdf": -1}}
    for wrong in ({"marks": {"history.csv": "all"}}, negative, {"marks": 3}, {"wall": "long"}, {"wall": None}):
        forge(file, with_about(content, {**about, **wrong}))
        with pytest.raises(Damaged):
            read(file)


def arrays_at(plain: Any, path: str = "") -> Iterator[tuple[str, str]]:
    """Path and name of every array in a stored state."""
    if isinstance(plain, dict) and "array" in plain:
        yield path, plain["array"]
    elif isinstance(plain, dict):
        for key, value in plain.items():
            yield from arrays_at(value, path if key in ("with", "table") else f"{path}.{key}")
    elif isinstance(plain, list):
        for value in plain:
            yield from arrays_at(value, path)


@pytest.fixture(scope="module")
def gate() -> Callable[[MarchState], None]:
    """What a state of the run has to pass."""
    checked = check(loads(BLOCKS))
    start = initial_state(checked.model, checked.step)
    return partial(require_of_model, checked.model, start)


def usable(folder: Path, content: Content, gate: Callable[[MarchState], None]) -> bool:
    """Whether a run would be resumed from a forged checkpoint."""
    (folder / "checkpoints").mkdir(parents=True, exist_ok=True)
    forge(folder / "checkpoints" / "slab-000000004", content)
    return last(folder, gate) is not None


def test_numbers_that_do_not_fit_the_model_are_passed_over(stopped, tmp_path, gate):
    """Numbers of nodes far beyond the last, wrong sizes, and no numbers: kernels would read wherever these lead."""
    content = content_of(listed(stopped)[0])
    found = {name: path for path, name in arrays_at(about_of(content)["march_state"])}
    assert any("rows.node" in path for path in found.values()) and usable(tmp_path, content, gate)
    for name, path in found.items():
        values = np.load(io.BytesIO(content[f"{name}.npy"]))
        harms = [np.concatenate([values, values])] if values.size and "batches" not in path else []
        if values.size and values.dtype.kind == "f" and not path.endswith("offset"):
            harms.append(np.full_like(values, np.nan))
        if values.size and values.dtype.kind == "i":
            harms += [np.full_like(values, 10**9), np.full_like(values, -5)]
        for harmed in harms:
            assert not usable(tmp_path, {**content, f"{name}.npy": array(harmed)}, gate), (path, harmed)


@pytest.mark.slow
def test_a_state_with_any_part_exchanged_ends_in_order(stopped, tmp_path, gate):
    """Parts exchanged at random: passed over, or resumed to an end in order, never a traceback."""
    content, chance = content_of(listed(stopped)[0]), random.Random(17)
    odd = [
        None,
        True,
        -1,
        0,
        10**30,
        1e308,
        -1e300,
        "x",
        [],
        {},
        [1],
        {"array": "array1", "axes": [0]},
        {"kind": "Near"},
    ]
    admitted = []
    for _ in range(150):
        about = about_of(content)
        holder, key = chance.choice(list(places_of(about)))
        holder[key] = chance.choice(odd)
        harmed = with_about(content, {"march_state": None, **about})
        if usable(tmp_path / "one", harmed, gate):
            admitted.append(harmed)
    assert 0 < len(admitted) < 50
    for number, harmed in enumerate(admitted[:3]):
        shutil.copytree(stopped, tmp_path / f"run{number}")
        forge(listed(tmp_path / f"run{number}")[0], harmed)
        assert main(["resume", str(tmp_path / f"run{number}"), "--quiet"]) in (0, 2, 3)


def places_of(plain: Any) -> Iterator[tuple[Any, Any]]:
    """Every table or list inside a value, with each of its keys."""
    for key in plain if isinstance(plain, dict) else range(len(plain)) if isinstance(plain, list) else ():
        yield plain, key
        yield from places_of(plain[key])


@pytest.mark.slow
def test_a_run_with_a_forged_checkpoint_begins_again(stopped, tmp_path, caplog, capsys):
    content, folder = content_of(listed(stopped)[0]), tmp_path / "run"
    shutil.copytree(stopped, folder)
    forge(listed(folder)[0], {**content, "array0.npy": array(np.zeros((1, 3)))})
    with caplog.at_level(logging.WARNING):
        assert main(["resume", str(folder)]) == 0
    assert "is damaged: state" in caplog.text and "resumed from the start" in capsys.readouterr().out
    assert sw.Run(folder).stop.reason == "done"


def test_memory_is_bounded_by_the_file(stopped, tmp_path):
    file, content = tmp_path / "slab-000000004", content_of(listed(stopped)[0])
    forge(file, {**content, "array0.npy": header("(100000000,)") + bytes(8)})
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    with pytest.raises(Damaged, match="announces"):
        read(file)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 100_000
