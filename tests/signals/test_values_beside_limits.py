"""Values that exceed a limit by less than the digits of a message: the message has more digits."""

from pathlib import Path

import numpy as np
import pytest

from vehicle.engines.reduced.validity import Validity
from vehicle.errors import DataError
from vehicle.signals.analysis.evaluation import evaluate
from vehicle.signals.analysis.order_cut import order_cut
from vehicle.signals.analysis.order_lines import order_lines
from vehicle.signals.excitation.plausibility import check_level
from vehicle.signals.records.acceleration import read_acceleration
from vehicle.signals.records.record_comfort import evaluate_comfort
from vehicle.signals.records.resampled import resampled

TIME = np.arange(20_000) / 1000.0
WAVE = np.sin(2.0 * np.pi * 5.0 * TIME)
"""Whole periods, without a mean."""


def ride(folder, z, x=0.0, y=0.0):
    path = folder / "ride.csv"
    table = np.column_stack([TIME, WAVE + x, WAVE + y, z])
    np.savetxt(path, table, fmt="%.9g", delimiter=",", header="time [s],x [m/s2],y [m/s2],z [m/s2]", comments="")
    return path


def resample(gap):
    resampled(np.where(TIME < 10.0, TIME, TIME + gap - 0.001), {"z": np.sin(TIME)}, 1000.0, str, False)


REFUSED = {
    "displacement": (lambda folder: check_level(folder, {"fl": np.linspace(0.15001, 0.15003, 99)}, 0.001),
        r"0\.15003 m at 0\.098 s, .* 0\.15 m;"),
    "acceleration": (lambda folder: read_acceleration(ride(folder, np.tile([50.003, -50.003], TIME.size // 2))),
        r"50\.003 m/s2 .* 50;"),
    "mean": (lambda folder: evaluate_comfort(ride(folder, WAVE, 1.0003, 0.5)),
        r"1\.0003 m/s2.* must be at most 1 m/s2"),
    "settling": (lambda _: evaluate(0.0009999, np.random.default_rng(1).standard_normal((3, 3500))),
        r"lasts 3\.499\d s .* 3\.5 s"),
    "turns, cut": (lambda _: order_cut(TIME, TIME[None], 2.0 * np.pi * 7.9999 / 19.999 * TIME, TIME, [1.0]),
        r"7\.9999 turns.* must be at least 8;"),
    "turns, lines": (lambda _: order_lines(TIME, TIME[None], 15.9992 / 20.0, [1.0]),
        r"15\.999 turns.* must be at least 16;"),
    "rate, cut": (lambda _: order_cut(TIME, TIME[None], 100.0 * TIME, 1000.004 * np.pi + 0.0 * TIME, [1.0]),
        r"500\.002 Hz .*must be below 500 Hz"),
    "rate, lines": (lambda _: order_lines(TIME, TIME[None], 500.002, [1.0]), r"500\.002 Hz .*must be below 500 Hz"),
    "gap": (lambda _: resample(0.01002), r"gap of 0\.01002 s.* 0\.01 s;"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_a_value_just_beyond_its_limit_does_not_read_as_the_limit(case, tmp_path):
    call, pattern = REFUSED[case]
    with pytest.raises(DataError, match=pattern):
        call(tmp_path)


def test_a_rotation_just_beyond_the_valid_range_does_not_read_as_its_end():
    (text,) = Validity(angles={"knuckle_fl": 0.050003}, loads={}, one_sided=frozenset()).warnings()
    assert "2.865 deg" in text and "2.8648 deg" in text


def test_a_spot_late_in_a_record_is_found():
    z = np.zeros(1_300_000)
    z[1_200_040:1_200_060] = 0.2
    (text, *_) = check_level(Path("road.csv"), {"fl": z}, 0.01)
    assert "at 12000.4 s" in text
