"""Measured speed of a crankshaft, from a file, in rad/s over times that begin at 0."""

import numpy as np
import pytest

from vehicle.errors import DataError
from vehicle.model.parameters.crank_file import measured_speed

HEADER = "time [s],speed [1/min],seat rail z [m/s2]"


def written(folder, times, speeds, header=HEADER):
    file = folder / "run-up.csv"
    file.write_text("\n".join([header, *(f"{time},{speed},0.1" for time, speed in zip(times, speeds, strict=True))]))
    return str(file)


@pytest.mark.parametrize("channel", ["", "speed", "1"])
def test_times_begin_at_zero_and_the_speed_is_in_radians(tmp_path, channel):
    times, speeds = measured_speed(written(tmp_path, [5.0, 5.5, 6.0, 6.5], [600, 900, 1200, 1500]), channel)
    assert times == pytest.approx([0.0, 0.5, 1.0, 1.5], abs=1e-12)
    assert speeds == pytest.approx(2.0 * np.pi * np.array([10.0, 15.0, 20.0, 25.0]), rel=1e-12)


@pytest.mark.parametrize(
    ("times", "speeds", "channel", "words"),
    [
        ([0.0, 0.5, 1.0], [600, "", 900], "", "gap"),
        ([0.0, 0.5, 1.0], [600, 800, 20000], "", "600 to 20000 1/min"),
        ([0.0, 0.5, 1.0], [600, 800, -1], "", "-1 to 800 1/min"),
        ([0.0, 0.5, 1.0], [0, 0, 0], "", "0 to 0 1/min"),
        ([0.0, 0.5, 1.0], [600, 800, 900], "rpm", "0 channels match 'rpm'"),
        ([0.0, 0.5, 1.0], [600, 800, 900], "7", "0 channels match '7'"),
    ],
)
def test_a_channel_that_is_no_speed_of_an_engine_is_refused(tmp_path, times, speeds, channel, words):
    with pytest.raises(DataError, match=words):
        measured_speed(written(tmp_path, times, speeds), channel)
