"""Wrap the prose of the pages at 100 columns: `python -m tools.wrap_docs` writes, `--check` names what is not wrapped.

Paragraphs, also those of lists, are filled; tables, code, directives, headings and HTML stay. A code span, a link, or a
value with its % is never broken. A page keeps the same HTML apart from white space.
"""

import re
import sys
from itertools import pairwise
from pathlib import Path

from markdown_it import MarkdownIt

ROOT = Path(__file__).resolve().parents[1]
WIDTH = 100
GENERATED = "<!-- Written by "
"""Begins the comment of a page that a program writes."""

WORD = re.compile(r"(?:(`+)[^`]+\1|!?\[(?:`[^`]*`|[^\]`])*\]\([^)]*\)|<[A-Za-z!/][^>]*>|\S)+")
"""A word, code span, link or tag, with the punctuation that touches it."""

BLOCK = re.compile(r"([-+*=]+|#+|\d+[.)]|\(\S*\)=)$|[>%]|```|~~~|:::|\+\+\+")
"""A word that begins another block at the start of a line, in CommonMark or MyST."""

PARSER = MarkdownIt("commonmark").enable("table")


def filled(words: list[str], first: str, rest: str) -> list[str]:
    """Return words as lines of at most `WIDTH` characters, if no word is longer.

    Args:
        words: words of a paragraph.
        first: indentation of the first line, with the mark of a list.
        rest: indentation of the others.
    """
    lines = [first + words[0]]
    for word in words[1:]:
        if len(lines[-1]) + 1 + len(word) <= WIDTH:
            lines[-1] += f" {word}"
        else:
            lines.append(rest + word)
    return lines


def wrapped(text: str) -> str:
    """Return a page with its paragraphs filled.

    Raises:
        ValueError: the page would have another HTML.
    """
    lines = text.split("\n")
    tokens = PARSER.parse(text)
    for start, inline in reversed(list(pairwise(tokens))):
        hard = any(child.type == "hardbreak" for child in inline.children or ())
        if start.type != "paragraph_open" or start.map is None or hard or BLOCK.match(inline.content.split()[0]):
            continue
        begin, end = start.map
        first = lines[begin][: lines[begin].index(inline.content.split("\n")[0])]
        words: list[str] = []
        for match in WORD.finditer(inline.content):
            if words and BLOCK.match(match[0]):
                words[-1] += f" {match[0]}"
            else:
                words.append(" ".join(match[0].split()))
        lines[begin:end] = filled(words, first, re.sub(r"[-+*]|\d+[.)]", lambda mark: " " * len(mark[0]), first))
    result = "\n".join(lines)
    if PARSER.render(text).split() != PARSER.render(result).split():
        raise ValueError("wrapping would change the page; found a paragraph whose line begins a list or another block")
    return result


def prose() -> list[Path]:
    """Return the pages that people write."""
    pages = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
    return [page for page in pages if GENERATED not in page.read_text(encoding="utf-8")]


def main(arguments: list[str]) -> int:
    """Wrap all pages, or name those that are not wrapped."""
    changed = []
    for page in prose():
        text = page.read_text(encoding="utf-8")
        result = wrapped(text)
        if result != text:
            changed.append(page.relative_to(ROOT).as_posix())
            if arguments != ["--check"]:
                page.write_text(result, encoding="utf-8")
    if changed and arguments == ["--check"]:
        print(f"not wrapped at {WIDTH}: {', '.join(changed)}; run python -m tools.wrap_docs")
        return 1
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
