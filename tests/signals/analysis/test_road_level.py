"""Level of a road: the class of a generated road, of a sine, and what is refused."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle.errors import DataError
from vehicle.signals.analysis.road_level import CLASSES, class_of, road_level
from vehicle.signals.excitation.iso_road import IsoRoad

SPEED, STEP = 25.0, 1e-3


@pytest.mark.parametrize("letter", ["A", "C"])
def test_class_of_a_generated_road(letter):
    road = IsoRoad(level=CLASSES[letter], seed=5, track=1.5)
    height = road.height(0.0, SPEED * STEP, 200_000, "right", 10.0)
    level = road_level(STEP, height, SPEED)
    assert level.letter == letter and level.fitted[0] < 0.02 and level.fitted[1] > 2.0
    # The road is a sum of waves of fixed amplitudes on whole periods of the record; only the sum over the few lines of
    # the lowest bands differs from the integral.
    validated(
        "Roads and excitation", f"G(n0) of a generated road of class {letter}", level.reference_density,
        CLASSES[letter], rel=0.01, unit="m3", source="standard: ISO 8608, geometric mean of the class",
    )  # fmt: skip


def test_limits_of_the_classes():
    # ISO 8608, table C.1: upper limits 32, 128, 512 ... 1e-6 m3; A has no lower limit, H no upper one.
    assert [class_of(value * 1e-6) for value in (1.0, 31.9, 32.1, 127.9, 128.1, 511.0, 1e9)] == list("AABBCCH")


def test_refused_roads():
    for height, speed, message in ((np.zeros(5000), SPEED, "0 third octaves"), (np.ones(5000), 0.0, "0 m/s")):
        with pytest.raises(DataError, match=message):
            road_level(STEP, height, speed)
