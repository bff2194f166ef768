"""House rules about every tracked text: nothing in it depends on one machine, and it is dated in no other way."""

import re
import subprocess
import tomllib
from pathlib import Path

import pytest

GENERATED = {"demo", "runs", "build", "dist", "__pycache__", "_build"}
TEXT = {".py", ".md", ".toml", ".txt", ".cff", ".json", ".csv", ".cfg", ".inp", ".yml", ".yaml", "", ".run"}

FORBIDDEN = {
    "a path of one machine": re.compile(
        r"(?<![\w.:/~\-])/(?:h[o]me|r[o]ot|t[m]p|o[p]t|m[n]t|U[s]ers|w[o]rk|d[a]ta)/[\w.]"
    ),
    "a drive of one machine": re.compile(r"\b[A-Z]:\\\\?[A-Za-z]"),
    "a host of packages": re.compile(r"\bp[y]pi\b|p[y]thonhosted|\bc[o]nda-forge\b|a[n]aconda\.org", re.IGNORECASE),
    "an option that names a host of packages": re.compile(r"-[i]ndex-url|--[f]ind-links|--[t]rusted-host"),
    "the number of a ticket": re.compile(r"\b[i]ssues?\s*#?\s*\d", re.IGNORECASE),
    "work that is put off": re.compile(r"\b(?:T[O]DO|F[I]XME|X[X]X)\b"),
}


def tracked(root: Path) -> list[Path]:
    """Files under version control and new ones that are not ignored; without git, all but the generated."""
    listed = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard"],
        cwd=root,
        capture_output=True,
        text=True,
        check=False,
    )
    if listed.returncode == 0 and listed.stdout:
        return [p for line in listed.stdout.splitlines() if (p := root / line).is_file()]
    return [p for p in root.rglob("*") if p.is_file() and not _generated(p.relative_to(root))]


def _generated(path: Path) -> bool:
    return any(part in GENERATED or (part.startswith(".") and part != ".ci") for part in path.parent.parts)


@pytest.fixture(scope="module")
def texts(root: Path) -> dict[Path, list[str]]:
    """Lines of every tracked text file."""
    files = [p for p in tracked(root) if p.suffix in TEXT and p.stat().st_size < 5_000_000]
    return {p: p.read_text(encoding="utf-8", errors="replace").splitlines() for p in files}


@pytest.mark.parametrize("what", FORBIDDEN)
def test_texts_do_not_hold(what: str, texts: dict[Path, list[str]]) -> None:
    pattern = FORBIDDEN[what]
    found = [
        f"{p}:{k}: {line.strip()[:100]}"
        for p, lines in texts.items()
        for k, line in enumerate(lines, 1)
        if pattern.search(line)
    ]
    assert not found, f"{what}:\n" + "\n".join(found)


def test_patterns_find_what_they_forbid() -> None:
    examples = {
        "a path of one machine": "see /ho" + "me/someone/x",
        "a drive of one machine": "C" + ":\\folder",
        "a host of packages": "https://py" + "pi.org/simple",
        "an option that names a host of packages": "--extra-in" + "dex-url x",
        "the number of a ticket": "fixes iss" + "ue #12",
        "work that is put off": "# TO" + "DO later",
    }
    assert examples.keys() == FORBIDDEN.keys()
    for what, line in examples.items():
        assert FORBIDDEN[what].search(line), what


def test_constraints_are_names_and_versions(root: Path) -> None:
    lines = (root / "constraints.txt").read_text().split("\n")[:-1]
    assert lines == sorted(lines, key=str.lower)
    wrong = [line for line in lines if not re.fullmatch(r"[A-Za-z0-9_.\-]+==[0-9][0-9A-Za-z.]*", line)]
    assert not wrong


def test_every_dependency_is_constrained(root: Path) -> None:
    project = tomllib.loads((root / "pyproject.toml").read_text())["project"]
    wanted = [*project["dependencies"], *(d for group in project["optional-dependencies"].values() for d in group)]
    known = {_normal(line.partition("==")[0]) for line in (root / "constraints.txt").read_text().splitlines()}
    missing = {d for d in wanted if _normal(re.match(r"[\w.\-]+", d)[0]) not in known}
    assert not missing


def _normal(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def test_one_version(root: Path) -> None:
    version = tomllib.loads((root / "pyproject.toml").read_text())["project"]["version"]
    assert f"version: {version}" in (root / "CITATION.cff").read_text()
    assert f"## {version}" in (root / "CHANGELOG.md").read_text()


def test_links_of_the_texts_lead_somewhere(root: Path, texts: dict[Path, list[str]]) -> None:
    broken = []
    for path in (p for p in texts if p.suffix == ".md"):
        for target in re.findall(r"\]\(([^)#]+)[^)]*\)", "\n".join(texts[path])):
            if "://" not in target and not (path.parent / target).exists():
                broken.append(f"{path.relative_to(root)}: {target}")
    assert not broken, "\n".join(broken)
