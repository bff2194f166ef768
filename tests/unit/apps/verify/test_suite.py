"""The suite: which cases, in processes, and what becomes of those that die."""

import json
from pathlib import Path

import pytest

from softway import InputError
from softway.apps.verify import Case, Result, chosen, compared, listed, verified
from softway.apps.verify.catalogue import QUICK
from softway.apps.verify.page import page
from softway.apps.verify.report import causes, in_json, rows, verdict
from softway.apps.verify.result import failed

RAISES = "def compute():\n    raise ValueError('no such thing')\n"
DIES = "import os\n\n\ndef compute():\n    os._exit(7)\n"


def test_groups_and_cases_in_any_case() -> None:
    assert [c.id for c in chosen(["a02", "A01"])] == ["A01", "A02"]
    assert {c.id[0] for c in chosen(["a"])} == {"A"}
    assert chosen() == listed()
    assert all(c.seconds <= QUICK for c in chosen(quick=True))


def test_the_quick_suite_takes_less_than_two_minutes_on_two_cores() -> None:
    """By the seconds of the catalogue, and half as much again, with fifteen seconds for two processes that start."""
    assert 15.0 + 1.5 * sum(c.seconds for c in chosen(quick=True)) / 2.0 <= 120.0


def test_a_wrong_id_names_the_known_ones() -> None:
    with pytest.raises(InputError, match="no case 'A022'") as caught:
        chosen(["A022"])
    assert "A01, A02" in caught.value.remedy


def test_every_case_has_a_sheet_and_a_module() -> None:
    for case in listed():
        assert case.sheet["id"] == case.id
        assert callable(case.compute)


AMPLIFICATION = "softway.apps.verify.cases.waves.a01_amplification_matrix"


@pytest.fixture(scope="module")
def mixed(tmp_path_factory: pytest.TempPathFactory) -> tuple[Result, ...]:
    """A case that raises, one whose process dies, and one that is right, in one process after the other."""
    folder = tmp_path_factory.mktemp("cases")
    (folder / "raises.py").write_text(RAISES)
    (folder / "dies.py").write_text(DIES)
    cases = (
        Case(id="A02", module="raises", seconds=3.0),
        Case(id="A12", module="dies", seconds=2.0),
        Case(id="A01", module=AMPLIFICATION, seconds=1.0),
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(folder))
        return verified(cases, jobs=1)


@pytest.mark.slow
def test_a_case_that_fails_does_not_reach_another(mixed: tuple[Result, ...]) -> None:
    assert [r.case.id for r in mixed] == ["A02", "A12", "A01"]
    assert [r.passed for r in mixed] == [False, False, True]
    assert [r.complaint for r in mixed] == ["ValueError: no such thing", "its process ended with code 7", ""]


@pytest.mark.slow
def test_the_table_of_cases_that_were_not_computed(mixed: tuple[Result, ...]) -> None:
    lines = json.loads(in_json(mixed))
    assert [set(line) for line in lines] == [
        {"case", "quantity", "reference", "value", "error", "tolerance", "pass"}
    ] * len(lines)
    assert all(line["value"] is None and not line["pass"] for line in lines if line["case"] != "A01")
    assert all(line["pass"] for line in lines if line["case"] == "A01")
    assert causes(mixed) == (
        "A02: not computed: ValueError: no such thing",
        "A12: not computed: its process ended with code 7",
    )
    assert {row.ours for row in rows(mixed[:2])} == {"-"}


@pytest.mark.slow
def test_the_page_needs_no_other_file(mixed: tuple[Result, ...], tmp_path: Path) -> None:
    text = page(mixed)
    assert text.count("<h2 ") == 3
    assert "no such thing" in text
    assert text.count('src="data:image/svg+xml;base64,') == text.count("<img ") == 2
    assert "<script" not in text and "<link" not in text


def test_a_known_miss_says_why() -> None:
    case = Case(id="A12", module="none", seconds=1.0)
    asked = {"qoi": [{"name": "force", "value": 2.0, "tol_rel": 0.1, "why": "the mesh is coarse"}]}
    (quantity,) = compared(asked, {"force": 2.5})
    assert not quantity.passed
    result = Result(case=case, quantities=(quantity,))
    assert causes([result]) == ("A12, force: the mesh is coarse",)
    assert verdict([result]).endswith(", 1 are not, with known causes")
    assert not failed(case, "x").passed
