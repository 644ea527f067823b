"""Pictures of docs/gallery/: the commands of a page draw its picture, and a copy of few colours lies beside the pages.

A page names the file that its commands draw in a comment, `<!-- picture: PATH -->`, above its picture; the line below
the picture is its caption. `python -m tests.documentation.gallery [PAGE ...]` runs pages, writes their outputs anew as
`tests.documentation.pages` does, and replaces their pictures.
"""

import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image

from tests.documentation.pages import NUMBER, ROOT, Execution, Site, agrees, blocks, pages
from tests.patience import HANG
from tests.runs.report.conftest import CHROMIUM, FLAGS

FOLDER = "docs/gallery/"
PICTURE = re.compile(r"<!-- picture: (\S+) -->\n!\[[^\]]+\]\((\S+)\)\n\n\*(.+?)\*\n", re.DOTALL)
ASSIGNED = re.compile(r"^(\w+) = .*  # (" + NUMBER.pattern + r")(?: |$)", re.MULTILINE)
"""A line of Python `NAME = ...  # NUMBER unit`: the number is the value of NAME after the page has run."""

WIDTH, COLOURS, GREYS = 1200, 40, 12
"""Width [pixel], colours and greys of a committed picture: about 40 kB, and readable on a slide."""

SCREEN = "1200,1030"
"""Width and height of the browser [pixel] for a page that is the picture."""

SATURATED = 24
"""Minimum range of red, green and blue of a pixel that is not grey."""

COARSE = (30, 20)
"""Fields of a picture that are compared, columns and rows: most letters that another version shifts stay in theirs."""


@dataclass(frozen=True)
class Shown:
    """The picture of a page.

    Attributes:
        source: file that the commands of the page draw, relative to their folder.
        file: committed picture.
        caption: caption in a line.
    """

    source: str
    file: Path
    caption: str


def gallery_pages() -> list[str]:
    """Return the pages of the gallery without its index."""
    return [page for page in pages() if page.startswith(FOLDER) and not page.endswith("/index.md")]


def shown(page: str) -> Shown:
    """Return the picture of a page."""
    text = (ROOT / page).read_text(encoding="utf-8")
    ((source, file, caption),) = PICTURE.findall(text)
    return Shown(source, (ROOT / page).parent / file, " ".join(caption.split()))


def light(path: Path) -> Image.Image:
    """Return a picture as it is committed: at most `WIDTH` pixels wide, on white, with few colours.

    Args:
        path: a picture, or an HTML file, whose first screen is the picture.
    """
    if path.suffix == ".html":
        with tempfile.TemporaryDirectory() as folder:
            screen = Path(folder) / "screen.png"
            own = (
                f"--screenshot={screen}",
                f"--window-size={SCREEN}",
                "--hide-scrollbars",
                f"--user-data-dir={folder}",
            )
            subprocess.run([CHROMIUM, *FLAGS, *own, path.as_uri()], capture_output=True, timeout=HANG, check=True)
            return light(screen)
    picture = Image.open(path).convert("RGBA")
    white = Image.new("RGBA", picture.size, "white")
    flat = Image.alpha_composite(white, picture).convert("RGB")
    if flat.width > WIDTH:
        flat = flat.resize((WIDTH, round(flat.height * WIDTH / flat.width)), Image.Resampling.LANCZOS)
    # The colours of thin lines are few among white and grey, so they get a palette of their own.
    pixels = np.asarray(flat).reshape(-1, 3)
    coloured = pixels[np.ptp(pixels.astype(int), axis=1) > SATURATED]
    palette = Image.new("P", (1, 1))
    entries = [grey for level in np.linspace(0, 255, GREYS).astype(int).tolist() for grey in (level, level, level)]
    if coloured.size:
        few = Image.fromarray(coloured.reshape(1, -1, 3)).quantize(COLOURS)
        entries += list(few.getpalette() or [])[: 3 * COLOURS]
    palette.putpalette(entries)
    return flat.quantize(palette=palette, dither=Image.Dither.NONE)


def difference(drawn: Image.Image, committed: Image.Image) -> float:
    """Return the sum of the differences of the fields of two pictures over the ink of the committed one."""
    drawn_ink, ink = (
        1.0 - np.asarray(picture.convert("L").resize(COARSE, Image.Resampling.BOX)) / 255.0
        for picture in (drawn, committed)
    )
    return float(np.abs(drawn_ink - ink).sum() / ink.sum())


def numbers_of(page: str, execution: Execution) -> list[str]:
    """Return the numbers that the program made: outputs of the commands, and the assigned numbers of the Python blocks.

    Raises:
        AssertionError: an assigned number is not the value of its name.
    """
    found = []
    for block in blocks(page, "python"):
        for name, number in ASSIGNED.findall(block):
            value = f"{float(execution.names[name]):.9g}"
            assert agrees(number, value), f"{page}: {name} = {value}, the page says {number}"
            found.append(number)
    for block in blocks(page, "console"):
        found += NUMBER.findall(block)
    return found


def rounded_from(text: str, numbers: list[str]) -> bool:
    """True if a number of a caption is one of the numbers, rounded to its digits."""
    digit = 10.0 ** -len(text.partition(".")[2])
    return any(abs(abs(float(text)) - abs(float(number))) <= 0.501 * digit for number in numbers)


def main(arguments: list[str]) -> int:
    """Renew outputs and pictures of pages, by default of all."""
    with tempfile.TemporaryDirectory() as folder:
        site = Site(Path(folder))
        for page in arguments or gallery_pages():
            result = site.execution(page, renew=True)
            (ROOT / page).write_text(result.text, encoding="utf-8")
            picture = shown(page)
            picture.file.parent.mkdir(exist_ok=True)
            light(result.folder / picture.source).save(picture.file, optimize=True)
            print(f"{page}: {picture.file.name}, {picture.file.stat().st_size / 1000:.0f} kB")
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
