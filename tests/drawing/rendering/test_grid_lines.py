"""Grid lines drawn at once are those of matplotlib's ticks, and ticks without a label are not made."""

import numpy as np
import pytest
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.axis import Tick
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from vehicle.drawing.rendering.figure import STYLE, power_of_ten, saved_figure
from vehicle.drawing.rendering.grid_lines import bared, draw_grid


def places(axes):
    """Where its grid lines stand: vertical ones, horizontal ones."""
    found: dict[str, list[float]] = {"x": [], "y": []}
    for lines in (part for part in axes.collections if isinstance(part, LineCollection)):
        for (x0, y0), (x1, y1) in lines.get_segments():
            found["x" if x0 == x1 else "y"].append(x0 if x0 == x1 else y0)
            assert {0.0, 1.0} == ({y0, y1} if x0 == x1 else {x0, x1})
    return {name: sorted(values) for name, values in found.items()}


def image(taken_over):
    """A picture of linear and logarithmic axes with all their labels, as an array."""
    with rc_context(STYLE):
        figure = Figure(figsize=(6.0, 3.0))
        canvas = FigureCanvasAgg(figure)
        linear, decades = figure.subplots(1, 2)
        linear.plot([0.1, 3.0], [-2.0, 5.0])
        decades.set(xscale="log", yscale="log", xlim=(2.0, 7.0), ylim=(2.0, 3000.0))
        decades.tick_params(which="minor", left=False)  # marks that `bared` leaves out
        if taken_over:
            for axes in (linear, decades):
                draw_grid(axes, bared(axes))
        canvas.draw()
        return np.asarray(canvas.buffer_rgba())


def test_the_grid_is_that_of_the_ticks():
    np.testing.assert_array_equal(image(True), image(False))


def test_shared_scales_have_all_their_lines_and_ticks_only_at_the_edge(tmp_path, monkeypatch):
    made: list[Axes] = []
    create = Tick.__init__

    def counted(tick, axes, *arguments, **look):
        made.append(axes)
        create(tick, axes, *arguments, **look)

    monkeypatch.setattr(Tick, "__init__", counted)
    with saved_figure(tmp_path / "shared.png", (6.0, 5.0)) as figure:
        axes = figure.subplots(2, 2, sharex=True, sharey=True)
        axes[0, 0].set(yscale="log", xlim=(0.0, 9.0), ylim=(2.0, 300.0), xticks=range(10))
        made.clear()
    for one in axes.flat:
        lines = places(one)
        assert lines["x"] == list(range(10))
        inside = {value for value in lines["y"] if 2.0 <= value <= 300.0}
        assert inside == {*range(2, 10), *range(10, 101, 10), 200.0, 300.0}
    assert [made.count(one) for one in axes[:, 1]] == [0, 9], "the first tick of an axis is older"


def test_small_ticks_of_a_short_decade_keep_their_labels(tmp_path):
    with saved_figure(tmp_path / "short.png", (4.0, 3.0)) as figure:
        axes = figure.subplots()
        axes.set(yscale="log", ylim=(2.0, 7.0))
    assert axes.yaxis.get_tick_params("minor")["left"]


def test_axes_without_a_grid_get_none(tmp_path):
    with saved_figure(tmp_path / "none.png", (4.0, 3.0)) as figure:
        one, half, hidden = figure.subplots(1, 3)
        one.grid(visible=False)
        half.grid(visible=False, axis="y")
        hidden.set_axis_off()
    assert places(one) == places(hidden) == {"x": [], "y": []}
    assert places(half)["x"] and not places(half)["y"]


@pytest.mark.parametrize(("value", "words"), [(1.0, "10⁰"), (0.01, "10⁻²"), (1e12, "10¹²")])
def test_a_decade_is_written_in_plain_letters(value, words):
    assert power_of_ten(value) == words


def test_a_logarithmic_axis_without_a_value_is_drawn(tmp_path):
    with saved_figure(tmp_path / "a.png", (3.0, 2.0)) as figure:
        axes = figure.subplots()
        axes.set(xscale="log", yscale="log")
        axes.plot([1.0, 2.0], [np.nan, np.nan])
    assert (tmp_path / "a.png").stat().st_size > 1000
    assert axes.get_ylim() == (0.1, 1.0)
