"""The site builds without a warning, and needs no network."""

import re
import shlex
import subprocess
import sys

import pytest

import vehicle
from tests.documentation.pages import DOCS, ROOT, pages
from tests.patience import HANG

pytest.importorskip("sphinx", reason="sphinx is missing: pip install 'vehicle-on-shaker[docs]'")


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """Folder of the site, built by the command of `make docs`."""
    folder = tmp_path_factory.mktemp("site")
    (line,) = re.findall(r"^\t\$\(BIN\)/python (-m sphinx .*)$", (ROOT / "Makefile").read_text("utf-8"), re.MULTILINE)
    words = [str(folder) if word == "docs/_build/html" else word for word in shlex.split(line)]
    words[words.index("-b") : words.index("-b")] = ["-d", str(tmp_path_factory.mktemp("doctrees"))]
    done = subprocess.run([sys.executable, *words], cwd=ROOT, capture_output=True, text=True, timeout=HANG, check=False)
    assert done.returncode == 0, done.stderr
    return folder


def test_every_page_is_built_and_can_be_reached(site):
    for page in pages():
        if page != "README.md":
            name = (ROOT / page).relative_to(DOCS).with_suffix(".html")
            assert (site / name).is_file()
            assert name.name in (site / "index.html").read_text(encoding="utf-8"), f"{name} is in no table of contents"


def test_the_reference_has_every_public_name(site):
    text = (site / "reference.html").read_text(encoding="utf-8")
    assert [name for name in vehicle.__all__ if f'id="vehicle.{name}"' not in text] == []


def test_nothing_is_loaded_from_the_network(site):
    loaded = re.compile(
        r"""(?:<(?:script|img|iframe)[^>]*\ssrc|<link(?![^>]*rel="canonical")[^>]*\shref)="(?:https?:)?//"""
    )
    for path in site.rglob("*.html"):
        assert not loaded.search(path.read_text(encoding="utf-8")), path.name
    for path in site.rglob("*.css"):
        assert not re.search(r"""(?:@import|url\()\s*["']?(?:https?:)?//""", path.read_text(encoding="utf-8")), (
            path.name
        )


def test_the_first_page_has_the_live_cars(site):
    """Frame and links of index.html name files that the build has written."""
    named = re.findall(r"""(?:src|href)="(live/[^"]+)\"""", (site / "index.html").read_text(encoding="utf-8"))
    assert {*named} == {"live/shaker.html", "live/road.html"}
    assert all((site / name).stat().st_size > 100_000 for name in named)
