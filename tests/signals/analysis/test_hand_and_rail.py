"""Hand-arm vibration, daily exposure and rail comfort: printed factors, closed forms, and what is refused."""

import re

import numpy as np
import pytest

from tests.validation import validated
from vehicle.commands.comfort import main
from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis.daily_exposure import daily_exposure, exposure
from vehicle.signals.analysis.evaluation import evaluate
from vehicle.signals.analysis.rail_comfort import comfort_words, rail_comfort
from vehicle.signals.analysis.weighting import weighting

CENTRES = "6.3 8 10 12.5 16 20 25 31.5 40 50 63 80 100 125 160 200 250 315 400 500 630 800 1000 1250"
PRINTED = (
    "0.727 0.873 0.951 0.958 0.896 0.782 0.647 0.519 0.411 0.324 0.256 0.202 0.160 0.127 0.101 0.0799 0.0634 0.0503 "
    "0.0398 0.0314 0.0245 0.0186 0.0135 0.00894"
)
"""Factors of Wh at the third octaves, ISO 5349-1:2001, table A.2."""


def test_factors_of_a_hand_are_those_printed():
    # The factors are those of the exact third octaves, 10^(n/10), printed with three digits.
    centres = 10.0 ** (np.round(10.0 * np.log10(np.array(CENTRES.split(), dtype=float))) / 10.0)
    validated(
        "Comfort, ISO 2631", "factors of Wh at the third octaves", weighting("Wh").spectrum_factor(centres),
        np.array(PRINTED.split(), dtype=float), rel=0.005, source="standard: ISO 5349-1:2001, table A.2",
    )  # fmt: skip


def test_vertical_weighting_of_a_train():
    """K (1 + s/(Q3 w5) + (s/w5)^2) / (1 + s/(Q4 w6) + (s/w6)^2) and so on with K = 0.4, as other programs write it."""
    f = np.logspace(-1.0, 2.0, 61)
    s = 1j * f
    factor = s**2 / (s**2 + np.sqrt(2.0) * 0.4 * s + 0.4**2) * 100.0**2 / (s**2 + np.sqrt(2.0) * 100.0 * s + 100.0**2)
    factor *= (1.0 + s / 16.0) / (1.0 + s / (0.63 * 16.0) + (s / 16.0) ** 2)
    factor *= 0.4 * (1.0 + s / (0.8 * 2.5) + (s / 2.5) ** 2) / (1.0 + s / (0.8 * 4.0) + (s / 4.0) ** 2)
    validated(
        "Comfort, ISO 2631", "factors of Wb of EN 12299, 0.1 to 100 Hz", weighting("Wb_en12299").spectrum_factor(f),
        np.abs(factor), rel=1e-12, source="publication: form and numbers as in the open programs comfpy and pyridy",
    )  # fmt: skip


def tone(frequency, amplitude, duration=20.0, rate=4000.0):
    return amplitude * np.sin(2.0 * np.pi * frequency * np.arange(round(duration * rate)) / rate)


def test_hand_holds_a_tone():
    """Tones on whole periods: each axis has its factor times a / sqrt(2); the sum has no factors; no dose values."""
    rate, amplitudes = 4000.0, (1.0, 2.0, 4.0)
    xyz = np.stack([tone(80.0, amplitude) for amplitude in amplitudes])
    values = evaluate(1.0 / rate, xyz, contact="hand", from_rest=False)
    expected = float(weighting("Wh").spectrum_factor(80.0)) * np.sqrt(np.sum(np.square(amplitudes)) / 2.0)
    # The filter starts at rest: 0.05 s of 20 s.
    assert values["vector_sum"]["weighted_rms"] == pytest.approx(expected, rel=2e-3)
    assert values["vector_sum"]["vdv"] is None and values["z"]["msdv"] is None and values["z"]["vdv"] is None
    assert not any("msdv" in reason for reason in values["reasons"])
    limited = evaluate(1e-3, xyz[:, ::4], contact="hand")["reasons"]
    assert any("400 Hz" in reason and "1000 Hz of ISO 5349-1" in reason for reason in limited)


def test_daily_exposure():
    """A(8) of 5 m/s2 for 2 h is 2.5 m/s2; of a body the largest of 1.4 x, 1.4 y and z decides."""
    assert daily_exposure(5.0, 2.0) == pytest.approx(2.5, rel=1e-12)
    assert daily_exposure(1.0, 8.0) == 1.0
    values = {
        "place": "seat", "x": {"weighted_rms": 0.6}, "y": {"weighted_rms": 0.2}, "z": {"weighted_rms": 0.8},
        "vector_sum": {"weighted_rms": 1.0},
    }  # fmt: skip
    found = exposure(values, 4.0)
    assert found["a8"] == pytest.approx(1.4 * 0.6 / np.sqrt(2.0), rel=1e-12) and found["axis"] == "x"
    assert (found["hours"], found["action_value"], found["limit_value"]) == (4.0, 0.5, 1.15)
    assert exposure({**values, "place": "hand"}, 8.0)["a8"] == 1.0
    for hours in (0.0, -1.0, 25.0, np.nan):
        with pytest.raises(ConfigurationError, match=f"{hours:g} h in a day"):
            exposure(values, hours)
    with pytest.raises(ConfigurationError, match=r"feet; .* hand, seat"):
        exposure({**values, "place": "feet"}, 8.0)
    with pytest.raises(DataError, match="y missing"):
        exposure({**values, "y": None}, 8.0)


def test_mean_comfort_of_a_train():
    """Tones that fit 5 s: every interval is the same, so N_MV = 6 times the vector sum."""
    rate = 200.0
    xyz = np.stack([tone(f, a, 320.0, rate) for f, a in ((1.0, 0.2), (2.0, 0.3), (6.0, 0.4))])
    found = rail_comfort(1.0 / rate, xyz)
    factors = [float(weighting(name).spectrum_factor(f)) for name, f in (("Wd", 1.0), ("Wd", 2.0), ("Wb_en12299", 6.0))]
    expected = 6.0 * np.sqrt(np.sum(np.square(np.array(factors) * [0.2, 0.3, 0.4])) / 2.0)
    validated(
        "Comfort, ISO 2631", "mean comfort N_MV of three tones", float(found.mean[0]), float(expected), rel=1e-3,
        source="closed form: 6 times the vector sum of the weighted tones",
    )  # fmt: skip
    assert found.mean.shape == (1,) and comfort_words(float(found.mean[0])) == "comfortable"


def test_quantile_of_the_intervals():
    """57 quiet and 3 loud intervals of 5 s: the 95 % quantile is 0.05 of the way to the loud ones."""
    rate = 200.0
    level = np.repeat(np.where(np.arange(60) < 57, 0.1, 1.0), 1000)
    tones = tone(10.0, 1.0, 300.0, rate) * level
    found = rail_comfort(1.0 / rate, np.stack([tones, tones, tones]), from_rest=True)
    ranks = np.sort(found.continuous, axis=1)
    quantile = ranks[:, 56] + 0.05 * (ranks[:, 57] - ranks[:, 56])
    assert found.mean[0] == pytest.approx(6.0 * np.sqrt(np.sum(quantile**2)), rel=1e-12)
    assert [comfort_words(n) for n in (1.49, 1.5, 2.5, 3.5, 4.5)] == [
        "very comfortable", "comfortable", "medium", "uncomfortable", "very uncomfortable"
    ]  # fmt: skip


def test_what_a_train_needs():
    for seconds, axes, message in ((300.0, 3, "296.5 s .* 3.5 s, .* 300 s"), (310.0, 2, "found 2 axes")):
        with pytest.raises(DataError, match=message):
            rail_comfort(0.005, np.stack([tone(2.0, 1.0, seconds, 200.0)] * axes))


def test_command(tmp_path, capsys):
    """A hand at 2.9 m/s2 for half an hour; a train of 310 s."""
    rate = 250.0
    time = np.arange(round(310.0 * rate)) / rate
    table = np.column_stack([time, *(3.0 * np.sin(2.0 * np.pi * f * time) for f in (20.0, 25.0, 31.5))])
    file = tmp_path / "grip.csv"
    np.savetxt(file, table[: round(20.0 * rate)], delimiter=",", header="time [s],x [m/s2],y [m/s2],z [m/s2]",
               comments="", fmt="%.7g")  # fmt: skip
    assert main(["--input", str(file), "--place", "hand", "--exposure", "0.5"]) == 0
    said = capsys.readouterr().out
    total = 3.0 * np.sqrt(np.sum(np.square(weighting("Wh").spectrum_factor([20.0, 25.0, 31.5]))) / 2.0)
    sums = re.search(r"vector sum of RMS \(comfort\)  (\S+)", said)
    day = re.search(r"exposure A\(8\), 0.5 h a day  (\S+) m/s2, below the action value", said)
    assert sums and day and "ISO 5349-1" in said
    # The filter starts at rest: 0.05 s of 20 s.
    assert float(sums[1]) == pytest.approx(total, rel=5e-3) and float(day[1]) == pytest.approx(total / 4.0, rel=5e-3)
    table[:, 1:] *= 0.1
    np.savetxt(file, table, delimiter=",", header="time [s],x [m/s2],y [m/s2],z [m/s2]", comments="", fmt="%.7g")
    assert main(["--input", str(file), "--place", "train_floor"]) == 0
    assert "mean comfort N_MV of each 5 minutes (EN 12299)  " in capsys.readouterr().out
    assert main(["--input", str(file), "--place", "feet", "--exposure", "8"]) == 2
    assert "no action value for feet" in capsys.readouterr().err
