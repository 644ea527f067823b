"""Names of the modes beside a Campbell map stand at their frequencies, and apart where these are close."""

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.text import Annotation

from vehicle.drawing.rendering.order_plot import APART, plot_campbell


def test_names_of_modes_stand_at_their_frequencies(tmp_path, monkeypatch):
    figures: list[Figure] = []
    monkeypatch.setattr(Figure, "savefig", lambda self, *_, **__: figures.append(self))
    speeds, frequency = np.linspace(10.0, 30.0, 5), np.linspace(0.0, 40.0, 81)
    modes = [(30.0, "engine pitch"), (10.0, "wheel hop"), (10.2, "wheel tramp")]
    plot_campbell(
        tmp_path / "map.png", speeds, speeds / 2.0, np.array([1.0]), frequency, np.ones((5, 81)), modes,
        ("speed [m/s]", "acceleration [m/s2]"), "title", "caption",
    )  # fmt: skip
    notes = [one for axes in figures[0].axes for one in axes.texts if isinstance(one, Annotation)]
    heights = {one.get_text(): one.xyann[1] for one in notes if " Hz " in one.get_text()}
    assert heights == {
        "10.0 Hz wheel hop": pytest.approx(0.25),
        "10.2 Hz wheel tramp": pytest.approx(0.25 + APART),
        "30.0 Hz engine pitch": pytest.approx(0.75),
    }
