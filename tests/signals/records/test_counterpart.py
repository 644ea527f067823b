"""What a measured channel is told by its simulated counterpart; the advice is obeyed, and does what it says."""

import re
from typing import Any

import numpy as np
import pytest

from tests.benchmarks.record_alignment import STEP, made_pair
from vehicle.runs.comparison.record_comparison import compare_records, unlike_copies
from vehicle.signals.formats.table import Record
from vehicle.signals.records.counterpart import clock_advice, counterparts, response_faults, run_times, sign_and_unit

NAMES = ("knuckle_fr_acc_z", "seat_rail_acc_z", "engine_acc_z")


def records(shift, drift, duration=20.0, noise=0.0):
    """A measurement of three accelerations, and the run that is late by shift and drift."""
    pairs = [made_pair(duration, shift, drift, seed=seed, noise=noise) for seed in range(3)]
    time = (np.arange(pairs[0][0].size) * STEP).astype(np.float64)
    units = dict.fromkeys(NAMES, "m/s2")
    return tuple(
        Record(time=time, channels=dict(zip(NAMES, values, strict=True)), units=units)
        for values in zip(*pairs, strict=True)
    )


def advice(measured, simulated, delay=0.0, drift=0.0):
    parts = counterparts(measured, simulated, run_times(measured, delay, drift))
    return clock_advice(parts, STEP, delay, drift)


@pytest.mark.parametrize(("shift", "drift"), [(5e-3, 0.0), (0.37e-3, 0.0), (0.5, 0.0), (0.0, 2e-3), (0.5, -2e-3)])
def test_the_advice_is_obeyed_and_does_what_it_says(shift, drift):
    measured, simulated = records(shift, drift)
    (said,) = advice(measured, simulated)
    assert ("clock of the measurement is 0.2 % slow" in said) is (drift > 0.0)
    assert ("0.2 % fast" in said) is (drift < 0.0) and "in all channels" in said
    delay = float(re.findall(r"--delay (-?[\d.e-]+)", said)[0])
    found = re.search(r"--drift (-?[\d.]+)", said)
    slow = float(found[1]) * 1e-6 if found else 0.0
    assert slow == pytest.approx(drift, rel=0.05)
    compared, parts = compare_records(measured, simulated, run_times(measured, delay, slow))
    assert min(one.correlation for one in compared) > 0.999 and max(abs(one.lag) for one in compared) < 0.1 * STEP
    assert clock_advice(parts, STEP, delay, slow) == []


def test_advice_adds_to_what_was_given():
    measured, simulated = records(0.3, 1e-3)
    (said,) = advice(measured, simulated, delay=0.2, drift=5e-4)
    delay, slow = (float(re.findall(rf"--{word} (-?[\d.]+)", said)[0]) for word in ("delay", "drift"))
    compared, _ = compare_records(measured, simulated, run_times(measured, delay, slow * 1e-6))
    assert min(one.correlation for one in compared) > 0.999


def test_records_that_agree_and_those_that_have_nothing_in_common_are_quiet():
    measured, simulated = records(0.0, 0.0, noise=0.2)
    parts = counterparts(measured, simulated, measured.time)
    assert clock_advice(parts, STEP, 0.0, 0.0) == [] and sign_and_unit(parts) == []
    other = records(0.0, 0.0)[0].channels
    turned = Record(
        time=simulated.time, channels=dict(zip(NAMES, [*other.values()][::-1], strict=True)), units=measured.units
    )
    parts = counterparts(measured, turned, measured.time)
    outer = [part for part in parts if part.channel != NAMES[1]]  # the one in the middle is itself
    assert all(part.reliable_shift is None for part in outer) and clock_advice(outer, STEP, 0.0, 0.0) == []


def test_sign_and_unit_are_named_with_their_option():
    measured, simulated = records(0.0, 0.0, duration=6.0)
    factors = dict(zip(NAMES, (-1.0, 1.0 / 9.80665, 1000.0), strict=True))
    channels = {name: factors[name] * values for name, values in measured.channels.items()}
    wrong = Record(time=measured.time, channels=channels, units=measured.units)
    said = sign_and_unit(counterparts(wrong, simulated, wrong.time))
    options = [re.findall(r"set (--\S+ \S+)$", text)[0] for text in said]
    assert options == [f"--turn {NAMES[0]}", f"--unit {NAMES[1]}=g", f"--unit {NAMES[2]}=mm/s2"]


def test_responses_tell_sign_and_unit_too():
    frequency = np.linspace(1.0, 40.0, 200)
    truth: Any = 1.0 / (1.0 - (frequency / 12.0) ** 2 + 0.1j * frequency / 12.0)
    model: Any = 1.2 / (1.0 - (frequency / 12.3) ** 2 + 0.1j * frequency / 12.3)
    weight = np.ones(frequency.size)
    assert response_faults("seat_rail_acc_z", truth, model, weight) == []
    (said,) = response_faults("seat_rail_acc_z", -truth, model, weight)
    assert said.endswith("set --turn seat_rail_acc_z")
    (said,) = response_faults("seat_rail_acc_z", truth / 9.80665, model, weight)
    assert said.endswith("set --unit seat_rail_acc_z=g")
    # A level that is ten times too low at some frequencies alone is no unit.
    assert response_faults("seat_rail_acc_z", np.where(frequency < 12.0, truth / 9.8, truth), model, weight) == []


def test_a_copied_channel_is_named_where_the_run_has_two():
    measured, simulated = records(0.0, 0.0, duration=6.0)
    first = measured.channels[NAMES[0]]
    copied = Record(time=measured.time, channels={**measured.channels, NAMES[1]: first}, units=measured.units)
    (said,) = unlike_copies(compare_records(copied, simulated)[0])
    assert f"--map {NAMES[1]}=NAME" in said
    symmetric = Record(time=simulated.time, channels={**simulated.channels, NAMES[1]: simulated.channels[NAMES[0]]},
                       units=simulated.units)  # fmt: skip
    assert unlike_copies(compare_records(copied, symmetric)[0]) == []
