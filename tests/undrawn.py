"""Figures beside what a test is about: built in full, drawn by matplotlib once for each function that plots.

A figure takes 0.1 to 0.5 s, and most tests of commands and pages write several that nobody looks at. Each function
that plots draws its first figure of a process for real, so that one that cannot be drawn is found; of the others
everything but the drawing runs. Tests outside `UNDRAWN` may look at their figures and draw all of them.
"""

import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

UNDRAWN = (
    *(
        "tests/commands/",
        "tests/documentation/test_executed_pages",
        "tests/documentation/test_doctests",
        "tests/handover/",
    ),
    *("tests/runs/", "tests/scenarios/", "tests/signals/", "tests/studies/", "tests/system/"),
)
"""Folders and modules of tests that do not look at their figures."""

DRAWN = ("tests/signals/formats/test_full_disk",)
"""Modules of these folders that need every drawing, beside those that look at a file (`_looks`)."""

SVG = '<svg viewBox="0 0 1 1"></svg>'
PNG = bytes.fromhex(
    "89504e470d0a1a0a0000000d49484452000000010000000108000000003a7e9b550000"
    "000a49444154789c63f80f0001010100b138f6140000000049454e44ae426082"
)
"""A drawing of one dot."""

_drawn: set[tuple[str, str, str]] = set()


def leave_out_drawings(present: Callable[[], str]) -> None:
    """Replace the two slow methods of matplotlib in this process.

    Args:
        present: function that returns the node of the present test.
    """
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    def all_of() -> bool:
        node = present()
        return not node.startswith(UNDRAWN) or node.startswith(DRAWN) or _looks(node.partition("::")[0])

    save, lay_out = Figure.savefig, ConstrainedLayoutEngine.execute

    def savefig(self: Figure, path: Any, **options: Any) -> None:
        form, name = str(options.get("format")), (*_plotting(), str(options.get("format")))
        if all_of() or form not in ("svg", "png") or name not in _drawn:
            _drawn.add(name)
            save(self, path, **options)
        elif form == "svg":
            Path(path).write_text(SVG, encoding="utf-8")
        else:
            Path(path).write_bytes(PNG)

    def execute(self: ConstrainedLayoutEngine, figure: Any) -> None:
        if all_of() or not {(*_plotting(), form) for form in ("svg", "png")} & _drawn:
            lay_out(self, figure)

    Figure.savefig = savefig  # type: ignore[method-assign, assignment]
    ConstrainedLayoutEngine.execute = execute  # type: ignore[method-assign, assignment]


@cache
def _looks(module: str) -> bool:
    """Return True for a module of tests that takes sizes or bytes of files, among them of pictures, or text of SVG."""
    path, words = Path(__file__).parents[1] / module, ("st_size", "read_bytes", '.svg").read_text')
    return path.is_file() and any(word in path.read_text(encoding="utf-8") for word in words)


def _plotting() -> tuple[str, str]:
    """Return file and name of the function whose `with saved_figure(...)` ends."""
    frame = sys._getframe(2)
    while frame.f_back is not None and frame.f_code.co_filename.endswith(("contextlib.py", "rendering/figure.py")):
        frame = frame.f_back
    return frame.f_code.co_filename, frame.f_code.co_name
