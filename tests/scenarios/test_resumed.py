"""Every scenario stopped at a random slab and resumed has the same bits as one that never stopped."""

import random

import pytest

import softway as sw
from records import differences
from variants import each, small

pytestmark = pytest.mark.slow


@pytest.mark.few(6)
@pytest.mark.parametrize("name", each())
def test_a_resumed_run_has_the_same_bits(name, tmp_path):
    given = small(name)
    given = small(name, f"output.fields_every={given.time.end / 4} s")
    whole = sw.run(given, tmp_path / "whole")
    after = random.Random(name).randrange(1, whole.summary["slabs"])
    seen: list[sw.Progress] = []

    def stop(progress: sw.Progress) -> None:
        seen.append(progress)
        if len(seen) == after:
            raise KeyboardInterrupt

    folder = tmp_path / "stopped"
    with pytest.raises(KeyboardInterrupt):
        sw.run(given, folder, progress=stop)
    assert sw.Run(folder).history.rows == after + 1
    resumed = sw.resume(folder)
    assert [r["slabs"] for r in resumed.provenance["resumed"]] == [after] and resumed.stop == whole.stop
    assert len(resumed.fields) == 5 and differences(folder, whole.path) == []
