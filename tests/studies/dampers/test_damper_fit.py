"""Fit of dampers: a known damper is found, a real damper is described, and what tests do not show is said."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from tests.benchmarks.known_dampers import KNOWN, deviations, is_right, law_of, records_of, values_of
from tests.validation import validated
from vehicle.signals.records.choice import Choice
from vehicle.studies.dampers.damper_choice import choose_law, judged
from vehicle.studies.dampers.damper_fit import finished
from vehicle.studies.dampers.damper_law import DamperLaw
from vehicle.studies.dampers.damper_test import read_test
from vehicle.studies.dampers.fitted_damper import FittedDamper
from vehicle.studies.dampers.waveform import reversals, waveform_of

SUBJECT = "Sweeps, tuning and optimisation"
REAL = Path(__file__).resolve().parents[4] / "shared" / "data" / "mr-damper"
COLUMNS = Choice(
    channels={"time": "1", "displacement": "2", "velocity": "3", "force": "4"},
    units={"time": "s", "displacement": "mm", "velocity": "mm/s", "force": "N"},
)
AT_REST = DamperLaw(bends=2, series=True, gas_stiffness=True)
POWERED = DamperLaw(bends=2, friction="presliding", elements=1, series=True)
START = {"gas_force": 0.0, "gas_stiffness": 900.0, "slider_limit_1": 70.0, "slider_stroke_1": 2e-3} | {
    "velocity_1": 0.02,
    "velocity_2": 0.027,
}
CASES = {
    "0A": (
        AT_REST,
        START | {"series_stiffness": 1.6e6, "damping_1": 7e3, "damping_2": 1.6e3, "damping_3": 100.0},
        0.09,
    ),
    "1A": (POWERED, START | {"series_stiffness": 5e6, "damping_1": 5e4, "damping_2": 1e4, "damping_3": 2e3}, 0.12),
}
"""Law that `choose_law` takes for the real damper, start values, largest RMS error over the standard deviation."""


@pytest.mark.skipif(not REAL.is_dir(), reason="the records of the real damper are not beside the project")
@pytest.mark.parametrize("current", CASES)
def test_a_real_damper_is_described_and_predicted(current):
    law, start, most = CASES[current]
    names = ("2mm5Hz", "10mm1Hz", "25mm0x5Hz")
    tests = [read_test(REAL / f"{name}{current}.txt", COLUMNS) for name in names]
    fit = finished(tests, judged(tests, law, [np.array([start[name] for name in law.parameters])]))
    assert np.all(fit.fitted < most), fit.fitted
    assert np.all(fit.left_out < 0.2), fit.left_out
    sentences = FittedDamper(conditions={}, tests=tests, fit=fit, compared=[fit]).left_open()
    assert any(text.startswith("friction at rest: ") for text in sentences)


def test_a_known_damper_is_chosen_and_its_parameters_are_found():
    number = 1
    known = KNOWN[number]
    fit, compared = choose_law(records_of(known, number))
    assert is_right(known, fit.law), fit.law.title
    assert len(compared) > 5 and fit.law in [other.law for other in compared]
    largest = max(map(abs, deviations(known, fit).values()))
    validated(
        SUBJECT, "damper test: known damper with 2 % noise, deviation in standard errors", largest, 0.0, abs=3.0,
        source="second derivation: parameters of the records, integrated by LSODA with exact dry friction",
    )  # fmt: skip


def test_velocity_steps_and_random_motion_give_the_law():
    """One record with three velocities and one of a random motion; the machine is found beside dry friction."""
    known = KNOWN[3]
    tests = records_of(known, 3, ("few steps", "short random"))
    assert [test.waveform.words for test in tests] == ["velocity steps, 20, 100, 500 mm/s", "random motion"]
    true = values_of(known)
    law = law_of(known)
    fit = finished(tests, judged(tests, law, [np.array([0.9 * true[name] for name in law.parameters])]))
    assert np.all(fit.fitted < 0.022) and np.all(fit.left_out < 0.05), (fit.fitted, fit.left_out)
    # All strokes of a test with velocity steps count alike, as in the fit and in the error left out.
    turns = reversals(tests[0].displacement, tests[0].velocity)[1:-1]
    strokes = [each.mean() for each in np.split((fit.force(tests[0]) - tests[0].force) ** 2, turns)]
    assert fit.fitted[0] == pytest.approx(np.sqrt(np.mean(strokes)) / tests[0].scale, rel=1e-2)
    largest = max(map(abs, deviations(known, fit).values()))
    validated(
        SUBJECT, "damper test: velocity steps and random motion, deviation in standard errors", largest, 0.0, abs=3.0,
        source="second derivation: parameters of the records, integrated by LSODA with exact dry friction",
    )  # fmt: skip


def test_standard_errors_hold_for_correlated_residuals():
    """A force with a slow error: the spread over seeds is that of the errors, which independent noise would miss."""
    law, times = DamperLaw(), np.arange(4000) / 500.0
    (plain,) = records_of(KNOWN[1], 1, ("8mm",))
    x, v = 0.01 * np.sin(4.0 * np.pi * times), 0.04 * np.pi * np.cos(4.0 * np.pi * times)
    values, errors = [], []
    for seed in range(40):
        white = np.random.default_rng(seed).standard_normal(times.size + 400)
        slow = np.convolve(white, np.exp(-np.arange(200) / 25.0), mode="same")[200:-200]
        test = dataclasses.replace(plain, time=times, displacement=x, velocity=v, force=1500.0 * v + 10.0 * slow,
                                   waveform=waveform_of(times, x, v))  # fmt: skip
        fit = finished([test], judged([test], law, [np.array([0.0, 1000.0])]))
        values.append(fit.values[1])
        errors.append(fit.errors[1])
    # 40 draws give a standard deviation within 23 % at two standard errors; 16 cycles give errors that are a bit small.
    assert 0.7 < np.sqrt(np.mean(np.square(errors))) / np.std(values) < 1.3
