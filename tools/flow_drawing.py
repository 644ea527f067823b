"""Draw the flow of the program: `python tools/flow_drawing.py` writes docs/architecture.svg, which a test compares."""

from __future__ import annotations

import argparse
from html import escape
from pathlib import Path

TARGET = Path(__file__).resolve().parents[1] / "docs" / "architecture.svg"
WIDTH, HEIGHT, LINE = 1000, 560, 18

BOXES = {
    "commands": (30, 30, 940, 32, ["python -m vehicle NAME, or import vehicle"]),
    "studies": (
        420,
        96,
        550,
        66,
        ["tables  design  mounts  dampers  diagnosis  replication  sweeps  tuning  optimisation"],
    ),
    "model": (210, 200, 180, 156, ["parameters", "laws", "flexbody", "shapes", "assembly", "templates, vehicles"]),
    "engines": (420, 200, 170, 120, ["simulation", "kinematics", "linear", "reduced, steady"]),
    "runs": (620, 200, 160, 138, ["car", "figures", "comparison", "output", "targets", "report"]),
    "handover": (810, 200, 160, 120, ["fmu", "page", "bench"]),
    "signals": (210, 392, 180, 138, ["formats", "records", "excitation", "analysis", "inputs"]),
    "core": (420, 356, 170, 66, ["laws and march in C"]),
    "drawing": (620, 374, 160, 84, ["rendering", "notebook"]),
}
"""Wing: left, top, width, height, and its rooms."""

FILES = {
    "vehicle file": (30, 250, 130),
    "input or record": (30, 440, 130),
    "folder of a run": (635, 490, 130),
    "FMU, report": (840, 356, 100),
}
"""Files: left, top, width."""

ARROWS = [
    (160, 265, 210, 265, "read"),
    (160, 455, 210, 455, "read"),
    (390, 265, 420, 265, ""),
    (590, 265, 620, 265, ""),
    (780, 265, 810, 265, ""),
    (505, 356, 505, 320, ""),
    (700, 374, 700, 338, ""),
    (890, 320, 890, 356, "write"),
    (700, 200, 700, 162, "many"),
]
"""Flow of data: from, to, and a word."""

BENT = [[(390, 440), (405, 440), (405, 300), (420, 300)], [(780, 300), (795, 300), (795, 505), (765, 505)]]
"""Flows with corners: signals to the engines, a run to its folder."""

STYLE = (
    "text{font:14px sans-serif;fill:#1b1f24}.t{font-weight:bold}.s{font-size:13px;fill:#444c56}"
    ".b{fill:#eef3fa;stroke:#40638f}.f{fill:#fff8e6;stroke:#9a7b2f;stroke-dasharray:4 3}"
    ".a{fill:none;stroke:#40638f;stroke-width:1.6;marker-end:url(#h)}"
)


def text(x: float, y: float, words: str, style: str) -> str:
    """Return a line of text."""
    return f'<text class="{style}" x="{x:g}" y="{y:g}">{escape(words)}</text>'


def drawing() -> str:
    """Return the drawing as SVG."""
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="Flow">',
        f"<style>{STYLE}</style>",
        '<defs><marker id="h" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" markerHeight="7" orient="auto">'
        '<path d="M0 0L8 4L0 8z" fill="#40638f"/></marker></defs>',
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>',
    ]
    for name, (x, y, width, height, rooms) in BOXES.items():
        parts.append(f'<rect class="b" x="{x}" y="{y}" width="{width}" height="{height}" rx="6"/>')
        parts.append(text(x + 10, y + 21, f"{name}/", "t"))
        if len(rooms) == 1 and height < 60:
            parts.append(text(x + 110, y + 21, rooms[0], "s"))
        else:
            parts += [text(x + 10, y + 42 + LINE * i, room, "s") for i, room in enumerate(rooms)]
    for name, (x, y, width) in FILES.items():
        parts.append(f'<rect class="f" x="{x}" y="{y}" width="{width}" height="30" rx="3"/>')
        parts.append(text(x + 10, y + 20, name, "s"))
    for x1, y1, x2, y2, word in ARROWS:
        parts.append(f'<path class="a" d="M{x1} {y1}L{x2} {y2}"/>')
        if word:
            upright = x1 == x2
            parts.append(text(x1 + (6 if upright else 8), (y1 + y2) / 2 + 5 if upright else y1 - 6, word, "s"))
    for points in BENT:
        parts.append(f'<path class="a" d="M{"L".join(f"{x} {y}" for x, y in points)}"/>')
    return "\n".join([*parts, "</svg>", ""])


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    TARGET.write_text(drawing(), encoding="utf-8")
