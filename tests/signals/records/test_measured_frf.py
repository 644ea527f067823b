"""Responses of other programs as m/s2 per m: by their units, as parts, over other inputs, from time histories."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle.errors import DataError
from vehicle.signals.formats.channel import Channel, Measurement, uniform_axis
from vehicle.signals.formats.reader import read_record
from vehicle.signals.records.choice import Choice
from vehicle.signals.records.measured import read_measured
from vehicle.signals.records.measured_frf import measured_frfs

LINES = np.arange(2.0, 30.0, 0.5)
OMEGA = 2.0 * np.pi * LINES
RECEPTANCE = 400.0 / (400.0 - OMEGA**2 + 4.0j * OMEGA)
"""Displacement over displacement of a mass on a spring and a damper at rest [m/m]."""
TRUTH = -(OMEGA**2) * RECEPTANCE
NAME = "knuckle_fr_acc_z"


def made(tmp_path, values, unit, **about):
    channel = Channel(name="H", values=values, unit=unit, axis=LINES, kind="frequency", function="frequency response",
                      **about)  # fmt: skip
    return Measurement(path=tmp_path / "made", format="uff", channels=(channel,))


@pytest.mark.parametrize(
    ("values", "unit"),
    [
        (TRUTH, "(m/s2)/m"),
        (TRUTH / 9.80665, "g/m"),
        (TRUTH / 9806.65, "g/mm"),
        (RECEPTANCE, "mm/mm"),
        (1j * OMEGA * RECEPTANCE, "(m/s)/m"),
        (RECEPTANCE, "g/g"),
        (TRUTH / (1j * OMEGA), "(m/s2)/(m/s)"),
    ],
)
def test_all_motions_over_motions_become_accelerations_over_displacements(tmp_path, values, unit):
    found, _ = measured_frfs(made(tmp_path, values, unit), {NAME: "1"}, Choice())
    np.testing.assert_allclose(found.response[0], TRUTH, rtol=1e-12)
    np.testing.assert_array_equal(found.frequency, LINES)


@pytest.mark.parametrize(
    ("unit", "message"),
    [
        ("(m/s2)/N", r"\(m/s2\)/N, a response to a force"),
        ("g/N", "g/N, a response to a force"),
        ("V/m", "V/m but must be a motion .*--unit knuckle_fr_acc_z=UNIT"),
        ("", "no unit; set --unit knuckle_fr_acc_z=UNIT"),
        ("qq", "unit 'qq'"),
    ],
)
def test_others_are_refused(tmp_path, unit, message):
    with pytest.raises(DataError, match=message):
        measured_frfs(made(tmp_path, TRUTH, unit), {NAME: "1"}, Choice())
    found, _ = measured_frfs(made(tmp_path, TRUTH, unit), {NAME: "1"}, Choice(units={NAME: "m/s2/m"}))
    np.testing.assert_allclose(found.response[0], TRUTH)


@pytest.mark.parametrize(
    ("direction", "reference", "turned", "sign"),
    [("+Z", "1+Z", (), 1), ("-Z", "1+Z", (), -1), ("-Z", "1-Z", (), 1), ("+Z", "1-Z", (), -1), ("-Z", "", (NAME,), 1)],
)
def test_the_sign_is_that_of_both_directions(tmp_path, direction, reference, turned, sign):
    one = made(tmp_path, TRUTH, "(m/s2)/m", direction=direction, reference=reference, place="12")
    found, _ = measured_frfs(one, {NAME: f"Dof 12 {direction}"}, Choice(), turned)
    np.testing.assert_allclose(found.response[0], sign * TRUTH)


@pytest.mark.parametrize("parts", ["real", "magnitude"])
def test_columns_of_parts_are_one_response(tmp_path, parts):
    first, second = (TRUTH.real, TRUTH.imag) if parts == "real" else (np.abs(TRUTH), np.degrees(np.angle(TRUTH)))
    heads = ("real", "imag", "[g/m]") if parts == "real" else ("magnitude", "phase", "[deg]")
    lines = [f"Frequency [Hz];H {heads[0]} [g/m];H {heads[1]} {heads[2]};H coherence"]
    lines += [f"{f!r};{a!r};{b!r};0.9" for f, a, b in zip(LINES.tolist(), first.tolist(), second.tolist(), strict=True)]
    path = tmp_path / "analyser.txt"
    path.write_text("\n".join(lines) + "\n")
    response, coherence = read_record(path).channels
    assert (response.name, response.function, coherence.function) == ("H", "frequency response", "coherence")
    found = read_measured(path, (NAME,), Choice(channels={NAME: "H"}))
    assert found.frf is not None and found.record is None
    validated(
        "File readers", f"measured FRF in g, columns of {parts}, in SI", found.frf.response[0], 9.80665 * TRUTH,
        rel=1e-9, source="closed form: the FRF that was written, standard gravity",
    )  # fmt: skip
    np.testing.assert_array_equal(found.frf.coherence[0], 0.9)


def test_a_magnitude_alone_is_refused(tmp_path):
    rows = "\n".join(f"{f!r};{abs(h)!r}" for f, h in zip(LINES.tolist(), TRUTH.tolist(), strict=True))
    (tmp_path / "x.csv").write_text(f"Frequency [Hz];H magnitude [g/m]\n{rows}\n")
    with pytest.raises(DataError, match="a spectrum without a phase"):
        read_measured(tmp_path / "x.csv", (NAME,), Choice(channels={NAME: "H*"}))


def test_responses_over_unequal_lines_share_their_union(tmp_path):
    some = Channel(name="K", values=TRUTH[10:], unit="(m/s2)/m", axis=LINES[10:] + 1e-4, kind="frequency",
                   function="frequency response")  # fmt: skip
    both = Measurement(path=tmp_path, format="uff", channels=(*made(tmp_path, TRUTH, "(m/s2)/m").channels, some))
    found, said = measured_frfs(both, {NAME: "H", "engine_acc_z": "K"}, Choice())
    assert found.frequency.size == LINES.size and np.isnan(found.response[1, :10]).all()
    np.testing.assert_array_equal(found.response[1, 10:], TRUTH[10:])
    assert "engine_acc_z: the file has no coherence, so all lines have equal weight" in said


def test_time_histories_give_the_response_of_the_system(tmp_path):
    """Plate in mm and acceleration in g of a mass on a spring, solved line by line for a periodic input."""
    time = uniform_axis(16000, 1.0 / 400.0)
    lines = np.fft.rfftfreq(time.size, 1.0 / 400.0)
    noise = np.random.default_rng(2)
    spectrum = np.where((lines > 0.5) & (lines < 60.0), np.exp(2j * np.pi * noise.random(lines.size)), 0.0)
    omega = 2.0 * np.pi * lines
    gain = -(omega**2) * 400.0 / (400.0 - omega**2 + 4.0j * omega)
    plate, answer = np.fft.irfft(spectrum), np.fft.irfft(gain * spectrum)
    table = np.column_stack([time, 1e3 * plate, answer / 9.80665])
    path = tmp_path / "log.csv"
    np.savetxt(path, table, delimiter=";", header="t [s];Shaker [mm];Knuckle [g]", comments="", fmt="%.12g")
    names = (NAME, "plate_fr_displacement")
    found = read_measured(path, names, Choice(channels={NAME: "Knuckle", "plate_fr_displacement": "Shaker"}))
    assert found.frf is not None and found.record is not None and "local rational" in found.estimator
    omega = 2.0 * np.pi * found.frf.frequency
    expected = -(omega**2) * 400.0 / (400.0 - omega**2 + 4.0j * omega)
    inside = (found.frf.frequency > 1.5) & (found.frf.frequency < 45.0)
    np.testing.assert_allclose(found.frf.response[0, inside], expected[inside], rtol=1e-3)
    np.testing.assert_allclose(found.record.channels[NAME], answer, atol=1e-9)
