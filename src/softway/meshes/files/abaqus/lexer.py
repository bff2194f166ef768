"""Cards of an input deck: keyword, parameters and data lines, with included files in place."""

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from softway.errors import InputError

DEEPEST = 8
"""Greatest number of levels of included files."""
FILES = 500
"""Greatest number of files that a deck reads; a file that is read twice counts twice."""
LINES = 20_000_000
"""Greatest number of lines of a deck with all its included files."""
_WITH_FILES = {"INCLUDE", "NODE", "ELEMENT", "NSET", "ELSET", "SURFACE"}
_FLAGS = {"GENERATE", "UNSORTED", "INTERNAL", "SHIFT"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Card:
    """Keyword line of a deck with its data lines.

    Parameters
    ----------
    name
        Keyword in capitals without ``*`` and blanks, such as ``SOLIDSECTION``.
    title
        Keyword as it is shown, such as ``*SOLID SECTION``.
    options
        Parameters by name in capitals without blanks; the value of a parameter without ``=`` is None.
    place
        Number of the line; in an included file the name of the file is before it.
    rows
        Data lines without comments and blank lines.
    """

    name: str
    title: str
    options: Mapping[str, str | None]
    place: str
    rows: list[str] = field(default_factory=list)

    def option(self, name: str) -> str:
        """Value of a parameter; an empty text without one."""
        return self.options.get(name) or ""

    def wrong(self, problem: str, remedy: str) -> InputError:
        """Error that names the card and its line."""
        return InputError("path", f"{self.title} in line {self.place}: {problem}", remedy)


@dataclass(frozen=True, slots=True)
class _Read:
    """Path of the deck, and the numbers of files and lines read so far."""

    main: Path
    numbers: Counter[str] = field(default_factory=Counter)


def cards(path: Path) -> Iterator[Card]:
    r"""Cards of a deck, in their order; data lines before the first keyword are no card.

    Raises
    ------
    InputError
        For a missing file, for files that include themselves, and beyond the bounds of the module.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "a.inp"
    >>> _ = path.write_text("** mesh\n*Node, nset=All\n1, 0, 0\n*End Step\n")
    >>> [(card.title, dict(card.options), card.rows, card.place) for card in cards(path)]
    [('*NODE', {'NSET': 'All'}, ['1, 0, 0'], '2'), ('*END STEP', {}, [], '4')]
    """
    last: Card | None = None
    open_head = ""
    for place, text in _lines(path, (), _Read(path)):
        if text.startswith("*"):
            if last is not None:
                yield last
            last, open_head = _card(text, place), text if text.endswith(",") else ""
        elif open_head and _continues(text):
            open_head += text
            last = _card(open_head, last.place if last else place)
            open_head = open_head if text.endswith(",") else ""
        elif last is not None:
            open_head = ""
            last.rows.append(text)
    if last is not None:
        yield last


def is_file(path: Path) -> bool:
    """True for a file; false also for a name that no file system admits.

    Examples
    --------
    >>> is_file(Path("x" * 5000))
    False
    """
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def is_folder(path: Path) -> bool:
    """True for a folder; false also for a name that no file system admits."""
    try:
        return path.is_dir()
    except (OSError, ValueError):
        return False


def _lines(path: Path, within: tuple[Path, ...], read: _Read) -> Iterator[tuple[str, str]]:
    """Places and texts of the lines without comments and blank lines, included files in place of their cards."""
    chain = (*within, path)
    _admit(path, within, read)
    with path.open(encoding="utf-8", errors="replace") as opened:
        for number, raw in enumerate(opened, start=1):
            read.numbers["lines"] += 1
            if read.numbers["lines"] > LINES:
                raise InputError(
                    "path", f"{_chain(chain)}: more than {LINES:,} lines", "a coarser mesh, or a .msh file"
                )
            text = raw.strip()
            if not text or text.startswith("**"):
                continue
            place = str(number) if not within else f"{path.name}:{number}"
            head = _card(text, place) if text.startswith("*") else None
            given = head.option("INPUT") if head and head.name in _WITH_FILES else ""
            if head is None or head.name != "INCLUDE":
                yield place, text
            if head is not None and head.name == "INCLUDE" and not given:
                raise head.wrong("no INPUT=FILE", "the path of the included file: *INCLUDE, INPUT=FILE")
            if given:
                yield from _lines(_found(given, path, read.main), chain, read)


def _admit(path: Path, within: tuple[Path, ...], read: _Read) -> None:
    """Refuse a file that is missing, that includes itself, or that exceeds the bounds of depth and number."""
    chain = _chain((*within, path))
    if not is_file(path):
        raise InputError("path", f"{chain}: no such file", "correct the path of the included file")
    if path.resolve() in [p.resolve() for p in within]:
        raise InputError("path", f"{chain}: the file includes itself", "remove the *INCLUDE line")
    if len(within) > DEEPEST:
        raise InputError("path", f"{chain}: more than {DEEPEST} levels of included files", "include the files directly")
    read.numbers["files"] += 1
    if read.numbers["files"] > FILES:
        problem = f"{chain}: more than {FILES} files, where a file that is included twice counts twice"
        raise InputError("path", problem, "remove the repeated *INCLUDE lines")


def _chain(paths: tuple[Path, ...]) -> str:
    """Names of the files, each one includes the next one."""
    return " > ".join(f"{p.name:.80}" for p in paths)


def _found(given: str, path: Path, main: Path) -> Path:
    """Path of an included file: beside the file that names it, or else beside the deck."""
    beside = path.parent / given
    return beside if is_file(beside) or not is_file(main.parent / given) else main.parent / given


def _continues(text: str) -> bool:
    """True for a line that carries on the parameters of a keyword line."""
    return "=" in text or all(part.strip().upper() in _FLAGS for part in text.rstrip(",").split(","))


def _card(text: str, place: str) -> Card:
    """Card of a keyword line, without data lines."""
    name, *parts = _split(text)
    pairs = [part.partition("=") for part in parts if part.strip()]
    options = {"".join(key.upper().split()): value.strip().strip("\"'") if sign else None for key, sign, value in pairs}
    words = name.upper().lstrip("*").split()
    if not words:
        raise InputError(
            "path", f"line {place}: {text:.40} has no keyword", "a keyword such as *NODE, or ** for a comment"
        )
    return Card(name="".join(words), title="*" + " ".join(words), options=options, place=place)


def _split(text: str) -> list[str]:
    """Parts between the commas that are not within quotes."""
    if '"' not in text:
        return text.split(",")
    pieces = text.split('"')
    marked = [piece.replace(",", "\0") if k % 2 else piece for k, piece in enumerate(pieces)]
    return [part.replace("\0", ",") for part in '"'.join(marked).split(",")]
