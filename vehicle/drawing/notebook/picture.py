"""Tables of a notebook with a small drawing on their right."""

import html
from collections.abc import Mapping

import numpy as np

from vehicle.arrays import Indices
from vehicle.signals.analysis.samples import Vector

WIDTH, HEIGHT = 330, 110
"""Size of a small drawing [pixel]."""


def card(title: str, rows: Mapping[str, str], drawing: str) -> str:
    """Return HTML with a title, a table and a drawing on the right."""
    cells = "".join(f"<tr><td>{html.escape(name)}</td><td>{html.escape(text)}</td></tr>" for name, text in rows.items())
    return (
        f'<div style="display:flex;gap:1.5em;align-items:center"><div><b>{html.escape(title)}</b>'
        f"<table>{cells}</table></div>{drawing}</div>"
    )


def line_drawing(along: Vector, values: Vector, label: str) -> str:
    """Draw a curve as SVG, with minimum and maximum in each pixel column.

    Args:
        along: increasing horizontal coordinates, (n,).
        values: values, (n,); values that are not finite are left out.
    """
    finite = np.isfinite(values) & np.isfinite(along)
    along, values = along[finite], values[finite]
    if along.size < 2 or np.ptp(along) == 0.0:
        return ""
    across = (WIDTH - 4) * (along - along[0]) / np.ptp(along) + 2
    up = 16 + (HEIGHT - 36) * (values.max() - values) / (np.ptp(values) or 1.0)
    points_of_line = []
    for column in np.unique(across.astype(int)):
        inside = up[across.astype(int) == column]
        points_of_line += [(column, inside.max()), (column, inside.min())] if inside.size > 1 else [(column, inside[0])]
    points = " ".join(f"{x},{y:.1f}" for x, y in points_of_line)
    return _svg(f'<polyline points="{points}" fill="none" stroke="#1f5fa8"/>', label)


def frame_drawing(points: Vector, lines: Indices, label: str) -> str:
    """Draw lines between points as SVG, seen from the right with the front on the left.

    Args:
        points: x to the rear, y right, z up [m], (n, 3).
        lines: pairs of points, (m, 2).
    """
    side_view = points[:, [0, 2]]
    low, size = side_view.min(axis=0), np.ptp(side_view, axis=0)
    scale = min((WIDTH - 8) / size[0], (HEIGHT - 24) / size[1])
    pixels = np.column_stack([4 + scale * (side_view[:, 0] - low[0]), HEIGHT - 20 - scale * (side_view[:, 1] - low[1])])
    path = "".join(
        f"M{pixels[i, 0]:.1f} {pixels[i, 1]:.1f}L{pixels[j, 0]:.1f} {pixels[j, 1]:.1f}" for i, j in lines.tolist()
    )
    return _svg(f'<path d="{path}" fill="none" stroke="#1f5fa8" stroke-width=".8"/>', label)


def _svg(content: str, label: str) -> str:
    style = 'font-size="11" fill="#5a6672" font-family="sans-serif"'
    text = f'<text x="4" y="{HEIGHT - 4}" {style}>{html.escape(label)}</text>'
    return f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}">{content}{text}</svg>'
