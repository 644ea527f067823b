"""Notice on accelerations that a record does not resolve: against the same run at eight times the rate."""

import re

import numpy as np
import pytest

from vehicle import Car, road

TOP = "damper_top_rl_acc_z"


@pytest.fixture(scope="module")
def car():
    return Car.load("sedan")


def notices(run):
    return [text for text in run.recording.statistics.notices if "low (RMS)" in text]


def test_a_strut_top_reads_low_and_its_run_says_so(car):
    drive, names = road("B", 80, duration=6), [TOP, "damper_top_rr_acc_z", "seat_rail_acc_z"]
    (coarse, fine) = (
        each.run(drive, engine="reduced", channels=names) for each in (car, car.with_(["solver.record_rate=8000"]))
    )
    (said,) = notices(coarse)
    assert TOP in said and "1 more channels less" in said and "solver.record_rate=8000" in said
    low = 1.0 - np.std(coarse.recording.channels[TOP]) / np.std(fine.recording.channels[TOP])
    (share,) = re.findall(r"at least ([\d.]+) %", said)
    stated = float(share) / 100.0
    # The rest is motion of which the record has nothing.
    assert 0.003 < stated < low < 4.0 * stated
    assert not notices(fine)


@pytest.mark.parametrize("names", [None, ["seat_rail_acc_z", "knuckle_fl_acc_z", "damper_fl_velocity"], []])
def test_other_runs_say_nothing(car, names):
    assert not notices(car.run(road("B", 80, duration=3), engine="reduced", channels=names))
