"""Axes stand where the margins in inches say, and so do their labels and titles."""

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from vehicle.drawing.rendering.placed_axes import LABEL_DEPTH, LABEL_DISTANCE, Margins, placed_axes

SIZE = (10.0, 8.0)
MARGINS = Margins(left=1.0, right=0.5, bottom=0.75, top=0.25, across=0.5, down=0.25)
WIDTHS, HEIGHTS = (3.0, 1.0), (2.0, 1.0, 1.0)
LEFT, RIGHT = (1.0, 7.5), (7.0, 9.5)
"""Edges of the columns [inch]: 8 of 10 are left, 6 and 2 in parts of 3 and 1."""
TOP, BOTTOM = (7.75, 4.25, 2.375), (4.5, 2.625, 0.75)
"""Edges of the rows [inch]: 6.5 of 8 are left, 3.25 and twice 1.625 in parts of 2, 1 and 1."""


@pytest.fixture(scope="module")
def axes():
    figure = Figure(figsize=SIZE, dpi=100)
    FigureCanvasAgg(figure)
    placed = placed_axes(figure, MARGINS, widths=WIDTHS, heights=HEIGHTS, sharex=True, sharey="row")
    for axis in placed.flat:
        axis.set(xlabel="time [s]", ylabel="force [N]", title="a title")
    figure.draw_without_rendering()
    return placed


def test_the_axes_fill_what_the_margins_leave(axes):
    assert axes.shape == (3, 2)
    for row, top, bottom in zip(axes, TOP, BOTTOM, strict=True):
        for axis, left, right in zip(row, LEFT, RIGHT, strict=True):
            np.testing.assert_allclose(axis.get_position().extents * [*SIZE, *SIZE], [left, bottom, right, top])


def test_labels_keep_the_same_distance_from_an_axis_of_any_size(axes):
    for row, bottom in zip(axes, BOTTOM, strict=True):
        for axis, left in zip(row, LEFT, strict=True):
            beside = axis.yaxis.label.get_window_extent().extents / 100.0
            below = axis.xaxis.label.get_window_extent().extents / 100.0
            assert beside[2] == pytest.approx(left - LABEL_DISTANCE, abs=0.03), "the edge towards the axis"
            assert below[3] == pytest.approx(bottom - LABEL_DEPTH, abs=0.03), "the upper edge"
            assert axis.title.get_window_extent().y0 / 100.0 == pytest.approx(axis.bbox.y1 / 100.0, abs=0.15)


def test_rows_share_a_scale_and_all_columns_one_along(axes):
    axes[0, 0].set(xlim=(2.0, 3.0), ylim=(4.0, 5.0))
    assert axes[2, 1].get_xlim() == (2.0, 3.0)
    assert axes[0, 1].get_ylim() == (4.0, 5.0) != axes[1, 0].get_ylim()
