"""The gallery of scenarios and examples: ``python docs/gallery.py`` writes ``docs/gallery.md``.

``python docs/gallery.py NAME PICTURE.png`` makes the small picture of one from a large one, such as that of ``softway
plot``; it needs Pillow, which comes with matplotlib.  What is said of each is the first sentence of its file.
"""

import re
import sys
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from PIL import Image

DOCS = Path(__file__).resolve().parent
ROOT = DOCS.parent
PAGE, PICTURES = DOCS / "gallery.md", DOCS / "pictures" / "gallery"
WIDTH, COLOURS = 560, 256
HEAD = """# Scenarios and programs

Every scenario and every program of the checkout, with the command that computes it. `softway plot` draws
a run, `softway view` shows it in the browser. Shorter ones with figures are the {doc}`examples <examples/index>`.
`python docs/gallery.py` writes this page.
"""


@dataclass(frozen=True)
class Entry:
    """One of the gallery: file, title, a sentence, commands."""

    file: Path
    title: str
    sentence: str
    commands: str

    @property
    def picture(self) -> Path:
        """Its small picture."""
        return PICTURES / f"{self.file.stem}.png"


def entries() -> Iterator[Entry]:
    """All scenarios, then all examples."""
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
    """The first sentence."""
    return text.strip().partition(". ")[0].rstrip(".") + "."


def page() -> str:
    """The page."""
    return "\n".join([HEAD, *(section(entry) for entry in entries())])


def section(entry: Entry) -> str:
    """Picture, sentence and command of one."""
    picture, source = entry.picture.relative_to(DOCS), entry.file.relative_to(ROOT)
    return f"""## {entry.title}

{entry.sentence} [{source}](../{source})

![{entry.title}]({picture.as_posix()})

```sh
{entry.commands}
```
"""


def shrink(source: Path, target: Path) -> None:
    """A picture of the width of the gallery, in few colours."""
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
