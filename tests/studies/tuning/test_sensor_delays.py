"""Delays of sensors as unknowns of a fit, fits that are not to be used, and what standard errors leave out."""

import json
from typing import Any

import numpy as np
import pytest

from tests.benchmarks.delayed_sensors import DELAY, FRONT, HIDDEN, REAR, fitted, hidden_run, measured_by
from tests.delayed_records import shaken, write_record
from tests.studies.tuning.two_masses import FREQUENCY, TRUE, MeasuredMasses, response
from tests.validation import validated
from vehicle.commands.tune import main
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.ranges import Range
from vehicle.runs.car import Car
from vehicle.signals.records.delays import channel_delays
from vehicle.studies.tuning.least_squares import fit
from vehicle.studies.tuning.measured_targets import measured_levels, measured_responses
from vehicle.studies.tuning.response_delays import DelayRange

SUBJECT = "Sweeps, tuning and optimisation"


@pytest.fixture(scope="module")
def run():
    return hidden_run()


@pytest.fixture(scope="module")
def record(run, tmp_path_factory):
    return measured_by(run, tmp_path_factory.mktemp("late") / "late.csv", seed=1000)


def test_two_frictions_and_the_delay_are_found(record):
    result = fitted(record)
    for path, value in HIDDEN.items():
        validated(
            SUBJECT, f"{path} fitted with accelerations 12.3 ms late and 4 % noise", result.values[path], value,
            abs=3.0 * result.standard_errors[path], unit="N",
            source="closed form: hidden value of the car that made the record",
        )  # fmt: skip
        assert result.standard_errors[path] < 0.01 * value  # else the check above would be too weak
    (delay,) = result.delays
    validated(
        SUBJECT, "fitted delay of accelerations 12.3 ms late, 4 % noise", 1e3 * result.solution[delay.path],
        1e3 * DELAY, abs=0.1, unit="ms", source="closed form: shift of the spectrum of a run",
    )  # fmt: skip
    assert abs(result.deviation(delay.path, DELAY)) < 4.0 and result.free[-1] == delay.path


def test_known_delay_is_held_and_half_a_sample_moves_the_values(record):
    """The stated shift by half a sample is that of a fit with this delay."""
    right, wrong = (fitted(record, {"accelerations": DELAY + lag}) for lag in (0.0, 0.5e-3))
    assert right.delays == wrong.delays == ()
    for path in HIDDEN:
        moved = abs(wrong.values[path] - right.values[path])
        assert abs(right.deviation(path, HIDDEN[path])) < 3.0
        # Largest of the cases of one channel and of all; the response to a lag is nonlinear by a few percent.
        assert 0.0 < moved < 1.3 * right.lag_shifts[path]
    assert max(abs(wrong.values[path] - right.values[path]) / right.standard_errors[path] for path in HIDDEN) > 3.0


def test_a_fit_with_a_forgotten_delay_prints_no_values(record, tmp_path, capsys):
    """The delay held at zero: a bound, or an error above that of a car at rest."""
    words = ["focus_road", "--record", str(record), "--engine", "reduced", "--delay", "accelerations=0"]
    words += ["--parameters", f"{FRONT}=40:200", f"{REAR}=20:200", "--output", str(tmp_path / "tune")]
    assert main(words) == 0
    said = capsys.readouterr().out
    assert "--set" not in said.replace("do not use this fit", "")
    assert "--delay" in said and "--turn" in said and "--unit" in said
    content = json.loads((tmp_path / "tune" / "tune.json").read_text(encoding="utf-8"))
    assert content["set"] == [] and content["refusal"] in said
    page = (tmp_path / "tune" / "report.html").read_text(encoding="utf-8")
    assert "Do not use this fit" in page and f"--set {FRONT}" not in page


def test_frfs_and_levels_have_the_delay_too(tmp_path):
    """One record as FRFs of the linear car with stuck dampers, and in classes of level."""
    start = Car.load()
    motion = shaken(("fl",), 12.0, rms=0.2e-3)
    run = start.run(motion, engine="reduced", channels=["plate_fl_displacement", "knuckle_fl_acc_z", "seat_rail_acc_z"])
    late = {"plate_fl_displacement": 0.0, "knuckle_fl_acc_z": DELAY, "seat_rail_acc_z": DELAY}
    file = write_record(tmp_path / "late.csv", run, late)
    for target in (measured_responses(start, file).target, measured_levels(start, file, levels=2, window=1.0).target):
        assert target.delays.groups == ("accelerations",)
        lags = target.lags(start)
        assert [lag.delay for lag in lags.values()] == pytest.approx([DELAY] * len(lags), abs=2e-5)
        pair: list[Any] = [target.settled({"accelerations": DELAY}), target]
        right, wrong = (np.sqrt(np.mean(each.misfit(each.response(start), {}, {}) ** 2)) for each in pair)
        assert right < 0.05 * wrong
    reference = measured_levels(start, file, levels=2, window=1.0, reference="knuckle_fl_acc_z").target
    assert reference.delays.groups == ()  # late like the reference


def test_delays_are_named_by_channel_pattern_or_group():
    names = ("plate_fl_displacement", "knuckle_fl_acc_z", "seat_rail_acc_z", "damper_fl_velocity")
    found = channel_delays(names, {"seat_rail_acc_z": 3.0, "accelerations": 1.0, "*_velocity": 2.0})
    assert found == {"knuckle_fl_acc_z": 1.0, "seat_rail_acc_z": 3.0, "damper_fl_velocity": 2.0}
    with pytest.raises(ConfigurationError, match="forces"):
        channel_delays(names, {"forces": 1.0})


class LateMasses(MeasuredMasses):
    """Two masses whose FRFs are late, with the delay as an unknown."""

    recorded, half_sample = ("wheel", "body"), 0.5e-3

    def __init__(self, *, seed=0, wrong=0.0):
        super().__init__(seed=seed)
        self.data = self.data * np.exp(-2j * np.pi * FREQUENCY * DELAY)
        self.wrong = wrong

    def response(self, values):
        return response(values)

    def misfit(self, answer, groups, lags):
        delays = np.array([groups["accelerations"] + lags.get(name, 0.0) for name in self.recorded])
        misfit = self.wrong * np.sin(FREQUENCY)
        turned = answer * np.exp(misfit - 2j * np.pi * delays[:, None] * FREQUENCY)
        logarithm = np.log(self.data / turned) / self.assumed
        return np.stack([logarithm.real, logarithm.imag], axis=1).reshape(4, -1)


PARAMETERS = tuple(
    Range(path=path, low=0.3 * value, high=3.0 * value, start=0.8 * value) for path, value in TRUE.items()
)


def masses(**options):
    delay = DelayRange(path="delay", group="accelerations", target=0, start=DELAY + 1e-3)
    return fit(PARAMETERS, [LateMasses(**options)], dict, delays=[delay])


def test_standard_error_of_a_delay_is_that_of_repeated_measurements():
    results = [masses(seed=seed) for seed in range(60)]
    for path in ("delay", "damping"):
        away = np.array([result.deviation(path, {**TRUE, "delay": DELAY}[path]) for result in results])
        # 60 repetitions know a standard deviation to 9 %: three times that, and the mean to 0.13.
        validated(
            "Statistics and intervals", f"scatter of the fitted {path} of late FRFs in 60 repetitions",
            np.std(away), 1.0, abs=0.27, source="second derivation: repeated measurements",
        )  # fmt: skip
        assert abs(np.mean(away)) < 0.39
    # A fitted delay takes a lag of both channels; of one alone it takes a part.
    assert all(0.0 < result.lag_shifts["delay"] == pytest.approx(0.5e-3, rel=0.05) for result in results[:3])


def test_misfit_is_beside_the_noise():
    """Noise alone gives the same error in both ways; a misfit that varies along the lines enlarges the second."""
    results = [masses(seed=seed) for seed in range(20)]
    noise = np.mean([[each.misfit_errors[path] / each.standard_errors[path] for path in TRUE] for each in results])
    assert noise == pytest.approx(1.0, abs=0.2)  # 60 lines and 20 stretches: three times 6 %
    wrong = masses(seed=3, wrong=0.2)
    assert max(wrong.misfit_errors[path] / results[3].misfit_errors[path] for path in TRUE) > 2.0
