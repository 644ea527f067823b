"""Sphinx configuration of the documentation: `make docs`; no network, no web fonts."""

import re
from importlib.metadata import version as version_of
from typing import Any

from docs.live_page import live_cars

project = "vehicle-on-shaker"
release = version_of("vehicle-on-shaker")
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
exclude_patterns = ["_build", "notebooks"]
suppress_warnings = ["myst.header"]  # sources without sections on the generated page of published results

html_theme = "furo"
html_title = "A complete car on the shaker"
html_static_path = ["_static"]
html_css_files = ["wrap.css"]
html_show_copyright = False
html_show_sourcelink = False
html_copy_source = False
smartquotes = False  # ' is a derivative
default_role = "code"
highlight_language = "none"

myst_heading_anchors = 4
myst_enable_extensions = ["colon_fence"]

autodoc_member_order = "bysource"
autodoc_typehints = "none"
autodoc_class_signature = "separated"
napoleon_use_ivar = True
napoleon_use_rtype = False


def readable(app: Any, what: str, name: str, target: Any, options: Any, lines: list[str]) -> None:
    """Turn the plain text of a docstring into reStructuredText: single backquotes are code, * and | are themselves."""
    for index, line in enumerate(lines):
        pieces = re.split(r"(`+[^`]+`+)", line)
        pieces[::2] = [re.sub(r"([*|]|_(?=\W|$))", r"\\\1", piece) for piece in pieces[::2]]
        pieces[1::2] = [f"``{piece.strip('`')}``" for piece in pieces[1::2]]
        lines[index] = "".join(pieces)
    if what in ("property", "attribute") and lines:
        lines[0] = lines[0].replace(": ", " - ", 1)  # napoleon takes what is before a colon for a type


def anchors(app: Any, name: str, content: list[str]) -> None:
    """Turn the HTML anchors of the generated page into targets, so that Sphinx checks its links."""
    content[0] = re.sub(r'^<a id="([^"]+)"></a>$', r"(\1)=", content[0], flags=re.MULTILINE)


def setup(app: Any) -> None:
    """Register the hooks; `readable` runs before the sections of the docstrings are read."""
    app.connect("autodoc-process-docstring", readable, priority=400)
    app.connect("source-read", anchors)
    app.connect("build-finished", live_cars)
