"""Every page of the gallery runs, is short, and has the picture and the numbers that its commands make."""

import re

import pytest
from PIL import Image

from tests.documentation.gallery import FOLDER, difference, gallery_pages, light, numbers_of, rounded_from, shown
from tests.documentation.pages import NUMBER, ROOT, Site
from tests.runs.report.conftest import CHROMIUM

NEEDS = {"durability": "rainflow", "fmu-master": "fmpy", "pareto": "pymoo"}
"""Extra of the commands of a page."""

LARGEST_DIFFERENCE = 0.1
"""Maximum `difference` of a drawn from the committed picture: drawn again 0.00, of two pages at least 0.44."""

LARGEST_OF_A_SCREEN = 0.3
"""The same of an HTML page, whose lines may move: 0.20 after a smaller gap above a heading."""

HEAVIEST = 64_000
"""Maximum size of a picture [byte]: the repository stays light."""


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    return Site(tmp_path_factory.mktemp("gallery"))


@pytest.mark.parametrize("page", gallery_pages())
def test_a_page_runs_and_its_picture_and_numbers_are_those_of_the_program(page, site):
    name = page.removeprefix(FOLDER).removesuffix(".md")
    if name in NEEDS:
        pytest.importorskip(NEEDS[name])
    execution = site.execution(page)
    picture = shown(page)
    numbers = numbers_of(page, execution)
    in_caption = NUMBER.findall(picture.caption)
    assert in_caption and [text for text in in_caption if not rounded_from(text, numbers)] == []
    drawn = execution.folder / picture.source
    if drawn.suffix == ".html" and not CHROMIUM.is_file():
        pytest.skip("the picture is a page in chromium, which is not installed")
    change = difference(light(drawn), Image.open(picture.file))
    limit = LARGEST_OF_A_SCREEN if drawn.suffix == ".html" else LARGEST_DIFFERENCE
    assert change < limit, f"python -m tests.documentation.gallery {page} draws the picture anew"


def test_another_curve_is_another_picture():
    pages = gallery_pages()
    pictures = [Image.open(shown(page).file) for page in pages]
    pairs = [(one, other) for index, one in enumerate(pictures) for other in pictures[:index]]
    assert len(pairs) > 100 and min(difference(*pair) for pair in pairs) > LARGEST_OF_A_SCREEN


@pytest.mark.parametrize("page", gallery_pages())
def test_a_page_is_short_and_its_caption_a_sentence(page):
    text = (ROOT / page).read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 60
    caption = shown(page).caption
    assert caption.endswith(".") and not re.search(r"[.!?] [A-Z]", caption)


def test_the_index_shows_every_picture_and_no_other_lies_there():
    index = (ROOT / FOLDER / "index.md").read_text(encoding="utf-8")
    pages = gallery_pages()
    assert len(pages) == 25
    for page in pages:
        name = page.removeprefix(FOLDER)
        assert f"(pictures/{shown(page).file.name})]({name})" in index
    files = {path.name for path in (ROOT / FOLDER / "pictures").iterdir()}
    assert files == {shown(page).file.name for page in pages}
    assert all(shown(page).file.stat().st_size <= HEAVIEST for page in pages)


def test_a_number_of_a_caption_is_rounded_from_one_of_the_program():
    assert rounded_from("0.862", ["7", "0.8621"]) and rounded_from("60", ["60.154"]) and rounded_from("2.4", ["-2.4"])
    assert not rounded_from("0.863", ["7", "0.8621"]) and not rounded_from("61", ["60.154"])
