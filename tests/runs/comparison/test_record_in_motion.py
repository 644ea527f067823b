"""A measurement that begins in motion: the run begins at rest, and its settling is left out of the comparison."""

import math

import numpy as np
import pytest

from vehicle import compare
from vehicle.signals.records.choice import Choice

NAMES = ("plate_fl_displacement", "knuckle_fl_acc_z")


@pytest.fixture(scope="module")
def file(car, tmp_path_factory):
    """Nine seconds from the middle of a run, whose file begins at 100 s."""
    run = car.run("high.csv", engine="reduced", channels=NAMES)
    path = tmp_path_factory.mktemp("motion") / "moving.csv"
    table = np.column_stack([run.time, *(run[name] for name in NAMES)])[5000:14000]
    table[:, 0] += 100.0 - table[0, 0]
    head = f"time [s],{NAMES[0]} [m],{NAMES[1]} [m/s2]"
    np.savetxt(path, table, delimiter=",", header=head, comments="", fmt="%.9g")
    return path


def test_the_settling_of_the_run_is_left_out_and_said(car, file):
    run = car.run(str(file), engine="reduced", channels=NAMES)

    def correlation(comparison):
        (record,) = (each for each in comparison.records if each.channel == NAMES[1])
        return record.correlation, float(record.time[0])

    settled = compare(run, file)
    value, begin = correlation(settled)
    assert begin == pytest.approx(2.0) and value > 0.999
    assert any("from 2 s" in text and "--from S" in text for text in settled.notices)
    # --from sets another begin, in times of the file; with the settling the same car does not agree with itself.
    whole = compare(run, file, choice=Choice(first=100.1))
    assert correlation(whole)[1] == pytest.approx(0.1) and not any("--from S" in text for text in whole.notices)
    assert math.sqrt(1.0 - correlation(whole)[0]) > 2.0 * math.sqrt(1.0 - value)
    short = compare(run, file, choice=Choice(last=103.0))
    assert correlation(short)[1] == 0.0 and any("2 s to settle" in text for text in short.notices)
    assert compare(run, run).records[0].time[0] == 0.0, "two runs begin at rest together"
