"""The bench of the FRF estimate with few seeds: what it must show, with the scatter that few seeds leave."""

import json

import pytest

from tests.benchmarks import frf_accuracy


def test_peaks_keep_their_height_in_noise_and_the_stated_region_holds():
    table = {(row["coherence"], row["B"]): row for row in frf_accuracy.peak_accuracy(3, durations=(60.0,))}
    for coherence, most, near in ((0.9, 4.0, 0.02), (0.5, 5.0, 0.07)):
        row = table[coherence, "16 to inf"]
        # The mean over n peaks scatters by rms / sqrt(2 n); the multiple equation-error fit is low by 10 and 20 %.
        assert abs(row["bias_percent"]) < most + 2.0 * row["rms_percent"] / (2.0 * row["peaks"]) ** 0.5
        assert row["inside_region_percent"] > 88.0
        assert table[coherence, "all, 60 s"]["estimated_coherence"] == pytest.approx(coherence, abs=near)


def test_resonances_are_true_and_those_of_a_longer_record_complete():
    short, longer = frf_accuracy.resonance_lists(1, (60.0, 240.0))
    assert short["false"] == longer["false"] == 0
    # A minute cannot tell maxima of 1 to 3 dB, nor a mode with 4 lines within its half-power width.
    assert short["missed"] <= 0.3 * short["true"] and longer["missed"] <= 0.1 * longer["true"]


def test_two_plates_are_separated():
    clean = frf_accuracy.two_plates(1, 1.0, 0.7)
    assert clean["rms_percent"] < 3.0 and clean["least_coherence"] > 0.97
    noisy = frf_accuracy.two_plates(1, 0.9, 0.0)
    assert noisy["rms_percent"] < 20.0 and noisy["bias_percent"] < 2.0


def test_the_command_prints_its_tables(capsys, monkeypatch):
    monkeypatch.setattr(frf_accuracy, "resonance_lists", lambda seeds: [{"seconds": 60.0, "false": 0}])
    monkeypatch.setattr(frf_accuracy, "peak_accuracy", lambda seeds: [{"coherence": 0.9, "peaks": seeds}])
    monkeypatch.setattr(frf_accuracy, "two_plates", lambda *case: {"coherence": case[1]})
    monkeypatch.setattr(frf_accuracy, "computing_time", dict)
    assert frf_accuracy.main(["--json", "--seeds", "1"]) == 0
    tables = json.loads(capsys.readouterr().out)
    assert tables["lines without input"] == [
        {"outside": pytest.approx(1, abs=1), "inside_percent": pytest.approx(100, abs=1), "sine": 0}
    ]
    assert frf_accuracy.main(["--seeds", "1"]) == 0
    assert "  coherence 0.9, peaks 1" in capsys.readouterr().out.splitlines()
