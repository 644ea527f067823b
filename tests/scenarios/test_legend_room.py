"""No curve of a chart is behind its legend."""

import numpy as np
import pytest

from scenarios.charts import figure_file, lines


def behind(panel):
    """Return the number of points of the curves of a panel in its legend."""
    panel.get_xlim(), panel.get_ylim()  # automatic limits are set at the first request
    box = panel.get_legend().get_window_extent()
    points = np.concatenate([line.get_transform().transform(line.get_xydata()) for line in panel.lines])
    return int(box.count_contains(points))


@pytest.mark.parametrize("scale", ["linear", "log"])
def test_no_curve_is_behind_the_legend(scale, tmp_path):
    x = np.linspace(1.0, 10.0, 400)
    curves = [("first", 1.0 + x, "k", "-"), ("second", 2.0 + 0.0 * x, "r", "--"), ("third", 3.0 * x, "b", ":")]
    with figure_file(tmp_path / "chart.png", (5.0, 3.0), "", "") as figure:
        panel, low = figure.subplots(1, 2)
        lines(panel, x, curves, xlabel="time [s]", ylabel="force [N]")
        lines(low, x, [("falls", 10.0 / x**2, "k", "-")], xlabel="time [s]", ylabel="force [N]")
        panel.set_yscale(scale)
        top = low.get_ylim()[1]
        assert behind(panel) > 0, "the case would show nothing"
    assert behind(panel) == 0
    assert low.get_ylim()[1] == top, "a legend with space keeps the limits"
