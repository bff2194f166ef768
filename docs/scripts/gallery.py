"""The gallery of scenarios and examples: ``python docs/scripts/gallery.py`` writes ``docs/tutorials/gallery.md``.

``python docs/scripts/gallery.py NAME PICTURE.png`` shrinks a large picture, for example of ``softway plot``, to the
picture of an entry; it needs Pillow, which comes with matplotlib.  The text of each entry is the first sentence of its
file, and the one that begins with "The audit finds".
"""

import re
import sys
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from PIL import Image

DOCS = Path(__file__).resolve().parents[1]
ROOT = DOCS.parent
PAGE, PICTURES = DOCS / "tutorials" / "gallery.md", DOCS / "pictures" / "gallery"
WIDTH, COLOURS = 560, 256
HEAD = """# Scenarios and programs

All scenarios and programs of the checkout, with the commands that run them. `softway plot` draws
a run, `softway view` shows it in the browser. Shorter programs with results are the {doc}`examples </examples/index>`.
`python docs/scripts/gallery.py` writes this page.
"""


@dataclass(frozen=True)
class Entry:
    """Entry of the gallery: file, title, a sentence, commands."""

    file: Path
    title: str
    sentence: str
    commands: str

    @property
    def picture(self) -> Path:
        """File of the small picture."""
        return PICTURES / f"{self.file.stem}.png"


def entries() -> Iterator[Entry]:
    """Yield all scenarios, then all examples."""
    for file in sorted(ROOT.glob("scenarios/*.toml")):
        text, name = file.read_text(encoding="utf-8"), file.stem
        comment = " ".join(line.lstrip("# ") for line in text.partition("title")[0].splitlines())
        commands = f"softway run scenarios/{file.name} --out runs/{name}\nsoftway plot runs/{name}"
        yield Entry(file, tomllib.loads(text)["title"], _first(comment), commands)
    for file in sorted(ROOT.glob("examples/*.py")):
        told = file.read_text(encoding="utf-8").split('"""')[1]
        command = re.search(rf"python examples/{file.name}(?: [\w./]+)?", told)
        sentence = _first(" ".join(told.partition("\n\n")[0].split()))
        yield Entry(file, file.name, sentence, command[0] if command else f"python examples/{file.name}")


def _first(text: str) -> str:
    """First sentence of a text, and those on the findings of the audit and the notes of the check."""
    first, *others = text.strip().split(". ")
    told = [one for one in others if one.startswith(("The audit finds", "`check` notes"))]
    return " ".join(one.rstrip(".") + "." for one in (first, *told))


def page() -> str:
    """Text of the page."""
    return "\n".join([HEAD, *(section(entry) for entry in entries())])


def section(entry: Entry) -> str:
    """Section of an entry: sentence, picture and commands."""
    picture, source = entry.picture.relative_to(DOCS), entry.file.relative_to(ROOT)
    return f"""## {entry.title}

{entry.sentence} [{source}](../../{source})

![{entry.title}](../{picture.as_posix()})

```sh
{entry.commands}
```
"""


def shrink(source: Path, target: Path) -> None:
    """Save a picture with the width of the gallery and few colours."""
    picture = Image.open(source).convert("RGBA")
    white = Image.new("RGBA", picture.size, "white")
    whole = Image.alpha_composite(white, picture).convert("RGB")
    whole.thumbnail((WIDTH, WIDTH))
    target.parent.mkdir(parents=True, exist_ok=True)
    whole.quantize(COLOURS, dither=Image.Dither.NONE).save(target, optimize=True)


def main(arguments: list[str]) -> int:
    """Write the page, or a picture."""
    if len(arguments) == 2:
        shrink(Path(arguments[1]), PICTURES / f"{arguments[0]}.png")
    elif arguments:
        sys.exit(__doc__)
    PAGE.write_text(page(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
