"""Section of every level: its chart and numbers are those of `Car.levels`, equal cars have one chart."""

import dataclasses
import re

import numpy as np
import pytest

from vehicle import ConfigurationError
from vehicle.digits import number
from vehicle.runs.car.levels import FREQUENCY, LEVEL
from vehicle.runs.report.finished_run import read_run
from vehicle.runs.report.levels_section import levels_section


def test_the_section_has_the_first_slip_and_the_peaks(reported):
    run = read_run(reported.folder)
    other = dataclasses.replace(run, car=run.car.with_(["damper.coulomb_friction=50"]))
    assert str(levels_section("fl", [run, other])).count("<figure>") == 2
    text = str(levels_section("fl", [run, run]))
    states = run.car.levels(plates="fl", frequency=FREQUENCY, level=LEVEL)
    slips = states.unsticking[states.dampers.index("damper_fl")]
    at, lowest = states.frequency[np.nanargmin(slips)], 1e3 * np.nanmin(slips)
    assert f"Left damper: slips first at {number(at)} Hz, from {number(lowest)} mm on." in text
    assert text.count("<figure>") == 1 and "plate of the left front wheel" in text
    rows = [re.findall(r">([^<>]+)</td>", row) for row in re.findall(r"<tr>(.*?)</tr>", text)]
    levels = [row[0] for row in rows if row]
    assert number(10.0) == levels[-1] and len(levels) == 7


def test_a_motion_that_is_none_is_refused(reported):
    with pytest.raises(ConfigurationError, match="plates 'sway'"):
        levels_section("sway", [read_run(reported.folder)])
