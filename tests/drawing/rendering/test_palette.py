"""Colours that every eye tells apart: distances in OKLab, with sight and without that of red or green.

Without one kind of cones: Machado, Oliveira and Fernandes, IEEE Trans. Vis. Comp. Graphics 15 (2009) 1291, matrices of
severity 1.0 on linear RGB. OKLab: Ottosson, A perceptual color space for image processing, 2020; a difference that can
just be noticed is about 0.02 there.
"""

import re
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

from scenarios.charts import LEVEL_COLOURS
from vehicle.drawing.rendering import overlay, trace_strip
from vehicle.drawing.rendering.figure import COLOURS, FADING, INK, LINES, fading, saved_figure

SIGHT = {
    "all cones": np.eye(3),
    "protanope": np.array(
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]
    ),
    "deuteranope": np.array(
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]
    ),
}
TO_CONES = np.array(
    [[0.4122214708, 0.5363325363, 0.0514459929], [0.2119034982, 0.6806995451, 0.1073969566],
     [0.0883024619, 0.2817188376, 0.6299787005]]
)  # fmt: skip
TO_LAB = np.array(
    [[0.2104542553, 0.7936177850, -0.0040720468], [1.9779984951, -2.4285922050, 0.4505937099],
     [0.0259040371, 0.7827717662, -0.8086757660]]
)  # fmt: skip
APART = 0.12
"""Six differences that can just be noticed."""


def rgb(text: str) -> np.ndarray:
    return np.frombuffer(bytes.fromhex(text.removeprefix("#")), dtype=np.uint8) / 255.0


def linear(colour: np.ndarray) -> np.ndarray:
    """sRGB without its gamma, IEC 61966-2-1."""
    return np.where(colour <= 0.04045, colour / 12.92, ((colour + 0.055) / 1.055) ** 2.4)


def oklab(colour: np.ndarray) -> np.ndarray:
    return np.asarray(TO_LAB @ np.cbrt(TO_CONES @ colour))


def distance(one: np.ndarray, other: np.ndarray, sight: np.ndarray) -> float:
    seen = [oklab(np.clip(sight @ linear(colour), 0.0, 1.0)) for colour in (one, other)]
    return float(np.linalg.norm(seen[0] - seen[1]))


@pytest.mark.parametrize("sight", SIGHT)
def test_colours_are_told_apart(sight):
    pairs = list(combinations([rgb(text) for text in COLOURS], 2))
    assert len(pairs) == 10
    assert min(distance(one, other, SIGHT[sight]) for one, other in pairs) > APART
    assert min(distance(rgb(text), np.ones(3), SIGHT[sight]) for text in COLOURS) > 2.0 * APART
    lamps = [np.array(colour) / 255.0 for colour in (overlay.STICK_COLOUR, overlay.SLIP_COLOUR)]
    assert distance(lamps[0], lamps[1], SIGHT[sight]) > APART


def test_red_and_green_of_equal_lightness_would_be_refused():
    assert distance(rgb("#d1495b"), rgb("#2e8b57"), SIGHT["deuteranope"]) < APART
    assert distance(rgb("#d1495b"), rgb("#2e8b57"), SIGHT["all cones"]) > APART


def test_levels_and_traces_are_colours_of_the_palette():
    traces = ["#" + bytes(colour).hex() for colour in trace_strip.TRACE_COLOURS]
    assert set(LEVEL_COLOURS) | set(traces) <= set(COLOURS)
    assert len(set(LINES)) == len(LINES) == len(COLOURS)


def test_figures_name_no_line_colour_of_their_own():
    """Greys, and pale shades behind the curves, are no colours of lines."""
    root = Path(__file__).resolve().parents[3]
    foreign = []
    pictures = [*root.glob("vehicle/drawing/rendering/*.py")]
    assert len(pictures) > 20, "the plots were not found"
    for path in [*pictures, *root.glob("scenarios/**/*.py")]:
        for line in path.read_text(encoding="utf-8").splitlines():
            for text in re.findall(r'"(#[0-9a-fA-F]{6})"', line):
                light, *hue = oklab(linear(rgb(text)))
                if text not in COLOURS and np.hypot(*hue) > 0.05 and light < 0.8:
                    foreign.append((path.name, text))
    assert foreign == []


def test_low_coherence_is_pale(tmp_path):
    """Every point is drawn, and drawn at the opacity of its coherence."""
    frequency, coherence = np.linspace(1.0, 50.0, 50), np.repeat([1.0, 0.6, 0.1, np.nan, 0.79], 10)
    with saved_figure(tmp_path / "faded.png", (4.0, 3.0)) as figure:
        axis = figure.subplots()
        fading(axis, frequency, frequency, coherence, "knuckle", color=INK)
        drawn = {line.get_alpha(): np.isfinite(line.get_ydata()) for line in axis.lines}
        assert [text.get_text() for text in axis.legend().get_texts()] == ["knuckle"]
    assert set(drawn) == {opacity for _, _, opacity in FADING}
    assert drawn[1.0][:10].all() and drawn[1.0][30:40].all() and not drawn[1.0][11:30].any()
    assert drawn[0.5][10:20].all() and drawn[0.5][40:].all() and drawn[0.2][20:30].all()
    assert np.any(list(drawn.values()), axis=0).all()
