"""Records of a test machine: channels, units, conditions, velocity, signs, run-up."""

import numpy as np
import pytest

from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.records.choice import Choice
from vehicle.studies.dampers.conditions import by_conditions
from vehicle.studies.dampers.damper_test import read_test

HEAD = "time [s],displacement [mm],velocity [mm/s],force [kN],I [A]"


def write(path, head=HEAD, late=0.0, sign=1.0, columns=(0, 1, 2, 3, 4)):
    """Record of a viscous damper, 1500 N s/m: sine of 2 Hz with run-up and run-down, 500 Hz."""
    t = np.arange(2001) / 500.0
    envelope = np.clip(np.minimum(t, 4.0 - t) / 0.5, 0.0, 1.0)

    def displacement(at):
        return 10.0 * np.clip(np.minimum(at, 4.0 - at) / 0.5, 0.0, 1.0) * np.sin(4.0 * np.pi * at)

    v = (displacement(t + 1e-6) - displacement(t - 1e-6)) / 2e-6
    shown = (displacement(t - late + 1e-6) - displacement(t - late - 1e-6)) / 2e-6
    table = np.column_stack([t, displacement(t), shown, sign * 1.5e-3 * v, 0.5 + 0.0 * envelope])[:, columns]
    np.savetxt(path, table, delimiter=",", header=head, comments="", fmt="%.9g")
    return path


def test_channels_are_found_and_converted(tmp_path):
    test = read_test(write(tmp_path / "a.csv"))
    assert test.waveform.words == "sine, 2 Hz" and test.cycle == pytest.approx(0.5, rel=0.01)
    assert np.sum(test.force * test.velocity) / np.sum(test.velocity**2) == pytest.approx(1500.0, rel=1e-3)
    assert np.ptp(test.displacement) == pytest.approx(0.02, rel=1e-3)
    inside = test.time[test.settled]
    assert 0.35 < inside[0] < 0.75 and 3.25 < inside[-1] < 3.65 and not test.settled[0]


def test_a_file_without_a_header_has_usual_columns_unless_they_are_named(tmp_path):
    path = write(tmp_path / "12mm0x5Hz1x5A.txt", head="", columns=(0, 1, 3))
    with pytest.raises(DataError, match="--unit force=kN"):
        read_test(path)
    usual = read_test(write(tmp_path / "newton.txt", head="", sign=1000.0, columns=(0, 1, 3)))
    assert any("time [s], displacement [mm], force [N]" in text for text in usual.notices)
    channels = {"time": "1", "displacement": "2", "force": "3"}
    choice = Choice(channels=channels, units={"time": "s", "displacement": "mm", "force": "kN"})
    test = read_test(path, choice, pattern="*Hz{current}A")
    assert test.conditions == {"current": 1.5} and test.scale == pytest.approx(usual.scale)
    assert any("Savitzky-Golay filter of 5 samples" in text for text in test.notices)
    reference = read_test(write(tmp_path / "a.csv"))
    error = (test.velocity - reference.velocity)[test.settled]
    assert np.max(np.abs(error)) < 1e-3 * np.max(reference.velocity)


def test_the_frequency_of_the_notice_has_that_error(tmp_path):
    head = "time [s],displacement [mm],force [kN],I [A]"
    test = read_test(write(tmp_path / "a.csv", columns=(0, 1, 3, 4), head=head))
    (text,) = (text for text in test.notices if "Savitzky" in text)
    frequency = float(text.split("up to ")[1].split(" Hz")[0])
    t = np.arange(2000) / 500.0
    w = 2.0 * np.pi * frequency
    weights = np.array([1.0, -8.0, 0.0, 8.0, -1.0]) / 12.0 * 500.0  # cubic over five samples, closed form
    derivative = np.convolve(np.sin(w * t), weights[::-1], mode="valid")
    gain = np.sqrt(2.0 * np.mean(derivative**2)) / w
    assert abs(gain - 1.0) == pytest.approx(0.01, abs=0.003)


def test_a_velocity_that_lags_is_replaced(tmp_path):
    test = read_test(write(tmp_path / "a.csv", late=0.003))
    assert any("3 ms late" in text for text in test.notices)
    reference = read_test(write(tmp_path / "b.csv"))
    assert not any("derivative" in text for text in reference.notices)
    assert np.max(np.abs(test.velocity - reference.velocity)[test.settled]) < 1e-3 * np.max(reference.velocity)


def test_signs(tmp_path):
    plain = read_test(write(tmp_path / "a.csv"))
    opposite = read_test(write(tmp_path / "b.csv", sign=-1.0))
    assert any("inverted" in text for text in opposite.notices)
    np.testing.assert_allclose(opposite.force, plain.force)
    turned = read_test(tmp_path / "a.csv", compression=True)
    np.testing.assert_allclose(turned.displacement, -plain.displacement)
    np.testing.assert_allclose(turned.force, -plain.force)


def test_conditions(tmp_path):
    path = write(tmp_path / "a.csv")
    typed = read_test(path, conditions={"temperature": "20", "current": "channel:I"})
    assert typed.conditions == {"temperature": 20.0, "current": 0.5}
    other = read_test(path, conditions={"temperature": "5", "current": "0.5"})
    assert [dict(key)["temperature"] for key in by_conditions([typed, other, typed])] == [5.0, 20.0]
    assert [len(group) for group in by_conditions([typed, other, typed]).values()] == [1, 2]
    for wrong, said in (({"conditions": {"current": "high"}}, "channel:NAME"),
                        ({"pattern": "*Hz{current}A"}, "does not match a; ")):  # fmt: skip
        with pytest.raises(ConfigurationError, match=said):
            read_test(path, **wrong)


@pytest.mark.parametrize(("wrong", "said"), [
    ({"conditions": {"current": "channel:force"}}, "channel 3 'force' contains the force of this test; choose the"),
    ({"conditions": {"current": "channel:1"}}, "channel 1 'displacement' contains the displacement of this test"),
    ({"conditions": {"current": "channel:copy"}}, "channel 5 'copy' contains the velocity of this test"),  # other unit
    ({"conditions": {"current": "channel:I", "clicks": "channel:4"}}, "channel 4 'I' contains the current of this"),
    ({"conditions": {"force": "channel:I"}}, "force is a measured quantity, not a condition of the test; name a"),
    ({"conditions": {"time": "3"}}, "time is a measured quantity"),
    ({"pattern": "a{velocity}"}, "velocity is a measured quantity"),
    ({"pattern": "a{clicks}", "conditions": {"clicks": "3"}}, "gives the condition clicks a second time"),
])  # fmt: skip
def test_a_measured_quantity_is_no_condition(tmp_path, wrong, said):
    plain = write(tmp_path / "plain.csv")
    head, table = f"{HEAD},copy [m/s]", np.loadtxt(plain, delimiter=",", skiprows=1)
    table = np.column_stack([table, 1e-3 * table[:, 2]])
    np.savetxt(tmp_path / "a7.csv", table, delimiter=",", header=head, comments="", fmt="%.9g")
    choice = Choice(channels={"velocity": "velocity"})
    with pytest.raises(ConfigurationError, match=said):
        read_test(tmp_path / "a7.csv", choice, **wrong)
