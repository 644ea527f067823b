"""Files as users have them: what is accepted, converted, noticed or mended on request."""

import hashlib

import numpy as np
import pytest

from scenarios.signals.random_road import random_road
from tests.signals.excitation.csv_samples import HEADER, curve, read_plain, rows, with_row, write
from vehicle.errors import ConfigurationError, DataError, OutputError
from vehicle.signals.excitation.input_files import find_input, shipped_inputs
from vehicle.signals.excitation.rest import half_cosine
from vehicle.signals.excitation.signal import Signal, uniform_time
from vehicle.signals.excitation.signal_file import read_signal, write_signal
from vehicle.signals.records.choice import Choice
from vehicle.signals.records.finding import Finding

CLEAN = np.array([float(row.split(",")[1]) for row in rows()])


def test_clean_file(tmp_path):
    path = write(tmp_path, ["# a comment", "", HEADER, *rows(), "# the end"])
    signal = read_plain(path)
    assert np.array_equal(signal.displacement["fr"], CLEAN)
    assert signal.timestep == pytest.approx(1e-3, rel=1e-12)
    assert signal.notices == ()
    assert signal.source == "signal.csv"
    assert signal.sha256 == hashlib.sha256(path.read_bytes()).hexdigest()


def test_a_plain_column_needs_a_wheel(tmp_path):
    path = write(tmp_path, [HEADER, *rows()])
    for choice in (None, Choice(first=0.0, last=0.3)):
        with pytest.raises(DataError, match=r"'displacement( .m.)?' .* no wheel; .*wheel='fl'.* displacement_fl$"):
            read_signal(path, choice=choice)


def test_a_written_signal_keeps_its_wheel(tmp_path):
    for wheel in ("fr", "fl"):
        signal = random_road(rms=1e-4, seed=2, wheel=wheel, duration=2.0)
        write_signal(tmp_path / "named.csv", signal)
        assert read_signal(tmp_path / "named.csv").wheels == (wheel,)
        write_signal(tmp_path / "plain.csv", signal, plain=True)
        assert read_signal(tmp_path / "plain.csv", wheel="rr").wheels == ("rr",)


def test_two_wheels_and_column_order_by_name(tmp_path):
    lines = [f"{z},0,{t}" for t, z in (row.split(",") for row in rows())]
    signal = read_plain(write(tmp_path, ["Displacement_FL [mm], displacement_fr [m], time [s]", *lines]))
    assert signal.wheels == ("fr", "fl")
    np.testing.assert_allclose(signal.displacement["fl"], 1e-3 * CLEAN, rtol=1e-15)
    assert not signal.displacement["fr"].any()  # a plate at rest beside a moving one is fine
    assert signal.notices == ("column 'Displacement_FL [mm]' converted from mm to m",)


def test_millimetres_are_converted(tmp_path):
    lines = [f"{t},{float(z) * 1e3!r}" for t, z in (row.split(",") for row in rows())]
    signal = read_plain(write(tmp_path, ["time [s],displacement [mm]", *lines]))
    np.testing.assert_allclose(signal.displacement["fr"], CLEAN, rtol=1e-12, atol=1e-20)
    assert signal.notices == ("column 'displacement [mm]' converted from mm to m",)


def test_bom_crlf_and_quotes_are_accepted_with_notice(tmp_path):
    path = tmp_path / "spreadsheet.csv"
    quoted = [",".join(f'"{cell}"' for cell in row.split(",")) for row in rows()]
    text = "\r\n".join(['"time [s]","displacement [m]"', *quoted]) + "\r\n"
    path.write_bytes(b"\xef\xbb\xbf" + text.encode())
    signal = read_plain(path)
    assert np.array_equal(signal.displacement["fr"], CLEAN)
    assert signal.notices == (
        "the byte order mark at the beginning of the file is skipped",
        "line endings of Windows (CR LF) or old Macs (CR) are accepted",
    )


def test_semicolons_and_decimal_commas_are_read_as_meant(tmp_path):
    lines = [row.replace(",", ";").replace(".", ",") for row in rows()]
    signal = read_plain(write(tmp_path, [HEADER.replace(",", ";"), *lines]))
    assert np.array_equal(signal.displacement["fr"], CLEAN)
    assert signal.notices == (
        "the columns are separated by ';' instead of the usual ','",
        "decimal comma read as decimal point",
    )


def test_time_is_shifted_to_zero_with_a_notice(tmp_path):
    lines = [f"{float(t) + 12.5:.6f},{z}" for t, z in (row.split(",") for row in rows())]
    signal = read_plain(write(tmp_path, [HEADER, *lines]))
    assert signal.time[0] == 0.0
    assert signal.notices == ("time begins at 12.5 s in the file and was shifted to 0",)


@pytest.mark.parametrize("cell", ["nan", "", "#N/A", "inf", "NULL"])
def test_missing_values_are_interpolated_on_request_and_counted(tmp_path, cell):
    lines = with_row(100, f"0.100000,{cell}")
    lines[151] = f"0.150000,{cell}"
    lines[152] = f"0.151000,{cell}"
    signal = read_plain(write(tmp_path, lines), interpolate=True)
    # Bound of cubic spline interpolation (Hall and Meyer): 5/384 h^4 max|z^(4)|, h = 3 dt,
    # z^(4) = A/2 (2 pi f)^4, together 8.2e-9 m.
    np.testing.assert_allclose(signal.displacement["fr"], CLEAN, rtol=0, atol=8.2e-9)
    assert signal.notices == (
        "3 missing values of column 'displacement [m]' interpolated by a cubic spline, the first in line 102",
    )


def test_a_long_gap_is_not_interpolated(tmp_path):
    lines = [HEADER, *rows()]
    for index in range(101, 112):
        lines[index] = f"{(index - 1) / 1000:.6f},nan"
    with pytest.raises(DataError, match=r"signal\.csv:102:2: .*'displacement .m.' .* 0\.012 s .* 0\.01 s"):
        read_plain(write(tmp_path, lines), interpolate=True)


@pytest.mark.parametrize("index", [0, 399])
def test_the_ends_are_not_extrapolated(tmp_path, index):
    path = write(tmp_path, with_row(index, f"{index / 1000:.6f},nan"))
    with pytest.raises(DataError, match=f":{index + 2}:2: column 'displacement .m.' "):
        read_plain(path, interpolate=True)


def test_a_small_offset_gets_a_ramp_of_stated_length_and_is_not_subtracted(tmp_path):
    lines = [f"{t},{float(z) - 2e-4!r}" for t, z in (row.split(",") for row in rows(2001, frequency=2.0))]
    signal = read_plain(write(tmp_path, [HEADER, *lines]))
    z = np.array([float(line.split(",")[1]) for line in lines])
    # Length: a tenth of the 2 s record.
    expected = z * half_cosine(samples=2001, timestep=1e-3, length=0.2)
    np.testing.assert_allclose(signal.displacement["fr"], expected, rtol=1e-9, atol=1e-15)
    assert signal.displacement["fr"][0] == 0.0
    (notice,) = signal.notices
    assert "-0.2 mm" in notice and f"{1e3 * np.std(z):.3g} mm (RMS)" in notice and "first 0.2 s" in notice


def test_ramp_is_half_a_second_on_long_records(tmp_path):
    lines = [f"{t},{float(z) - 2e-4!r}" for t, z in (row.split(",") for row in rows(6001))]
    assert "first 0.5 s" in read_plain(write(tmp_path, [HEADER, *lines])).notices[0]


def test_a_constant_of_one_plate_alone_is_named(tmp_path):
    """The plate fl moves about 0, so nothing is subtracted; the notice has the offset and the motion in mm."""
    t = np.arange(2001) / 1000.0
    z = 2e-3 * np.sqrt(2.0) * np.sin(20.0 * np.pi * t)
    lines = [f"{a:.3f},{b + 0.0753:.9e},{b:.9e}" for a, b in zip(t, z, strict=True)]
    notices = read_plain(write(tmp_path, ["time [s],displacement_fr [m],displacement_fl [m]", *lines])).notices
    assert any("75.3 mm" in text and "fl has none" in text for text in notices)
    assert any("fr begins at 75.3 mm" in text and "2 mm (RMS)" in text and "--remove-mean" in text for text in notices)


@pytest.mark.parametrize("ratio", [3.0, 20.0, 150.0])
@pytest.mark.parametrize("begins", ["in motion", "at rest"])
def test_148_the_position_of_a_sensor_is_no_motion(tmp_path, ratio, begins):
    """0.5 mm RMS about 75 mm lifted the car by 75 mm in half a second: RMS 7.22 mm, comfort 0.1167 for 0.0925."""
    t = np.arange(8000) / 1000.0
    motion = 5e-4 * np.sqrt(2.0) * np.cos(2.0 * np.pi * 3.0 * t) * (t > (2.0 if begins == "at rest" else 0.0))
    motion[t <= 2.0] += motion[2001] if begins == "at rest" else 0.0
    signal = read_plain(write(tmp_path, curve(t, motion + 5e-4 * ratio)))
    assert signal.rms("fr") == pytest.approx(np.std(motion), rel=0.03)
    (finding,) = (text for text in signal.notices if "position of the sensor" in text)
    assert isinstance(finding, Finding) and finding.kind == "offset" and "it was subtracted" in finding
    if begins == "at rest":
        np.testing.assert_allclose(signal.displacement["fr"], motion - motion[0], atol=1e-9)


@pytest.mark.parametrize("shape", ["kerb", "ramp", "bump", "hill"])
def test_148_a_motion_from_zero_is_not_touched(tmp_path, shape):
    t = np.arange(8000) / 1000.0
    z = {
        "kerb": 0.08 * np.clip((t - 0.2) / 0.1, 0.0, 1.0),  # its mean is seven times its RMS about it
        "ramp": 0.01 * t,
        "bump": 0.05 * np.sin(np.pi * np.clip((t - 2.0) / 0.3, 0.0, 1.0)) ** 2,
        "hill": 0.05 * (1.0 - np.exp(-t / 0.5)) * np.clip(t / 0.1, 0.0, 1.0) ** 2,
    }[shape]
    signal = read_plain(write(tmp_path, curve(t, z)))
    assert not any("subtracted" in text for text in signal.notices if "--detrend" not in text)
    assert signal.displacement["fr"][-1] == pytest.approx(z[-1], abs=1e-9)


def test_148_a_constant_beyond_any_sensor_is_a_wrong_unit(tmp_path):
    t = np.arange(8000) / 1000.0
    with pytest.raises(DataError, match="values in mm"):
        read_plain(write(tmp_path, curve(t, 75.0 + 0.5 * np.sin(20.0 * t))))


def test_a_small_offset_is_removed_only_on_request(tmp_path):
    lines = [f"{t},{float(z) + 0.01!r}" for t, z in (row.split(",") for row in rows(2001, frequency=2.0))]
    signal = read_plain(write(tmp_path, [HEADER, *lines]), remove_mean=True)
    assert "10.5 mm of plate fr" in signal.notices[0]
    assert "-0.5 mm" in signal.notices[1]  # the rest of the step, ramped
    assert abs(np.mean(signal.displacement["fr"][200:])) < 1e-4


def test_jump_of_velocity_gets_a_ramp(tmp_path):
    t = np.arange(2001) / 1000
    lines = [f"{a:.3f},{1e-3 * np.sin(20 * np.pi * a):.17g}" for a in t]
    signal = read_plain(write(tmp_path, [HEADER, *lines]))
    assert "plate fr" in signal.notices[0] and "0.0628 m/s" in signal.notices[0]
    assert abs(signal.plate_motion([0.0]).velocity["fr"][0]) < 1e-4


def test_low_sampling_rates(tmp_path):
    def read(rate: float) -> Signal:
        return read_plain(write(tmp_path, [HEADER, *rows(400, rate=rate, frequency=2.0)]))

    assert read(250.0).notices == ()
    for rate, highest in ((200.0, 80), (125.0, 50)):
        (notice,) = read(rate).notices
        assert f"{rate:g} Hz" in notice and f"up to {highest} Hz" in notice and "250 Hz" in notice
    assert read(125.0).highest is None


def test_content_near_nyquist_is_noticed(tmp_path):
    # Constant velocity PSD sampled without anti-alias filter: a fifth of the velocity variance above 0.8 Nyquist.
    road = random_road(rms=1e-3, seed=2, wheel="fr", duration=20.0, rate=2000.0, upper_band_edge=500.0)
    folded = Signal(time=uniform_time(samples=10001, timestep=2e-3), displacement={"fr": road.displacement["fr"][::4]})
    write_signal(tmp_path / "aliased.csv", folded)
    notices = read_plain(tmp_path / "aliased.csv", accept_implausible=True).notices
    assert len([text for text in notices if "variance" in text and "above 200 Hz" in text]) == 1
    clean = random_road(rms=1e-4, seed=2, wheel="fr", duration=20.0, rate=500.0, upper_band_edge=100.0)
    write_signal(tmp_path / "clean.csv", clean)
    assert read_plain(tmp_path / "clean.csv").notices == ()


def test_resampling_keeps_the_band_and_removes_what_would_fold(tmp_path):
    t = np.arange(8001) / 2000.0
    rise = half_cosine(samples=t.size, timestep=5e-4, length=1.0)
    wanted = 1e-3 * np.sin(2 * np.pi * 20.0 * t) + 1e-5 * np.sin(2 * np.pi * 195.0 * t)  # kept up to 200 Hz
    lines = [
        f"{a:.6f},{b:.17g}" for a, b in zip(t, rise * (wanted + 1e-5 * np.sin(2 * np.pi * 450.0 * t)), strict=True)
    ]
    signal = read_plain(write(tmp_path, [HEADER, *lines]), choice=Choice(resample=500.0))
    assert signal.timestep == pytest.approx(2e-3)
    kept = slice(600, -100)
    # 450 Hz would fold to 50 Hz with 1e-5 m; the filter leaves 1e-4 of it. Ripple of 80 dB on 1e-3 m: 1e-7.
    np.testing.assert_allclose(signal.displacement["fr"][kept], wanted[::4][kept], rtol=0, atol=2e-7)
    for words in ("2000 Hz to 500 Hz", "degree 7", "filter from 200 Hz", "0.1 % up to 600 Hz", "4 % up to 800 Hz"):
        assert words in signal.notices[-1]


def test_non_uniform_time_is_resampled_on_request(tmp_path):
    t = np.arange(2001) / 1000.0 + 2e-4 * np.sin(np.arange(2001))
    t[0] = 0.0
    z = 0.5e-3 * (1 - np.cos(2 * np.pi * 10.0 * t))
    path = write(tmp_path, [HEADER, *(f"{a!r},{b!r}" for a, b in zip(t.tolist(), z.tolist(), strict=True))])
    with pytest.raises(DataError, match=r"--resample 10\d\d"):
        read_plain(path)
    signal = read_plain(path, choice=Choice(resample=1000.0))
    uniform = 0.5e-3 * (1 - np.cos(2 * np.pi * 10.0 * signal.time))
    # Median rate a little off 1000 Hz may ask for a finer grid and the filter's ripple of 80 dB; ends apart.
    np.testing.assert_allclose(signal.displacement["fr"][100:-100], uniform[100:-100], rtol=0, atol=2e-7)
    assert any("irregular times" in text and "to 1000 Hz" in text for text in signal.notices)


def test_resampling_to_the_same_rate_changes_nothing(tmp_path):
    signal = read_plain(write(tmp_path, [HEADER, *rows()]), choice=Choice(resample=1000.0))
    assert np.array_equal(signal.displacement["fr"], CLEAN)
    assert signal.notices == ()


def test_resampling_limits(tmp_path):
    path = write(tmp_path, [HEADER, *rows(200), *(f"{float(r.split(',')[0]) + 1.0:.6f},0" for r in rows(200))])
    with pytest.raises(DataError, match=r":202: gap of 0\.801 s, .* 0\.01 s; .*--to 0\.199.*--from 1"):
        read_plain(path, choice=Choice(resample=1000.0))
    path = write(tmp_path, [HEADER, *rows()])
    with pytest.raises(DataError, match=r" 399000001 samples, .* 20000000"):
        read_plain(path, choice=Choice(resample=1e9))
    # 0.5 looked like a time in ms
    for rate, limit in ((5.0, "10 Hz"), (0.5, "10 Hz"), (-1.0, "0"), (np.inf, "0"), (np.nan, "0")):
        with pytest.raises(ConfigurationError, match=rf"^--resample {rate:g} Hz: .* {limit}$"):
            read_plain(path, choice=Choice(resample=rate))


def test_roads_beyond_a_shaker_are_accepted_on_request(tmp_path):
    path = write(tmp_path, [HEADER, *rows(amplitude=0.2, frequency=2.5)])
    with pytest.raises(DataError, match=r"displaced by 0\.2 m"):
        read_plain(path)
    signal = read_plain(path, accept_implausible=True)
    assert signal.notices[0].startswith("accepted on request: ")
    assert np.max(signal.displacement["fr"]) == pytest.approx(0.2)


def test_unknown_wheel(tmp_path):
    with pytest.raises(ConfigurationError, match="wheel 'xx' is unknown; must be one of fr, fl, rr, rl"):
        read_plain(tmp_path / "signal.csv", wheel="xx")


def test_written_file_reads_back(tmp_path):
    road = random_road(rms=1e-4, seed=2, wheel="fr", duration=2.0, rate=1024.0)
    both = Signal(time=road.time, displacement={"fl": road.displacement["fr"], "fr": -road.displacement["fr"]})
    write_signal(tmp_path / "both.csv", both, ["one", "two"])
    head = "# one\n# two\ntime [s],displacement_fr [m],displacement_fl [m]\n0.000000000"
    assert (tmp_path / "both.csv").read_text(encoding="utf-8").startswith(head)
    again = read_plain(tmp_path / "both.csv")
    assert again.notices == ()  # 1/1024 s keeps enough digits to be uniform
    for wheel in ("fr", "fl"):
        np.testing.assert_allclose(again.displacement[wheel], both.displacement[wheel], rtol=5.1e-7, atol=0)  # 7 digits
    assert [path.name for path in tmp_path.iterdir()] == ["both.csv"]


def test_nothing_half_written_stays(tmp_path):
    signal = random_road(rms=1e-4, seed=2, wheel="fr", duration=2.0)
    (tmp_path / "taken.csv").mkdir()
    for name, comment, fault in (
        ("no/x.csv", "a", "No such file"),
        ("taken.csv", "a", "cannot be written"),
        ("x.csv", "a\nb", "line break"),
    ):
        with pytest.raises(OutputError, match=f"{name}: .*{fault}"):
            write_signal(tmp_path / name, signal, [comment])
    assert [path.name for path in tmp_path.iterdir()] == ["taken.csv"]


@pytest.mark.parametrize(("rate", "decimals"), [(2048.0, 6), (2048.0, 5), (666.6, 4), (1024.0, 4)])
@pytest.mark.parametrize("cut", [np.round, lambda t, d: np.floor(t * 10.0**d) / 10.0**d], ids=["rounded", "cut"])
def test_64_a_rounded_clock_is_recognised(rate, decimals, cut, tmp_path):
    t = np.arange(6000) / rate
    z = 5e-4 * (1.0 - np.cos(2.0 * np.pi * 10.0 * t))
    signal = read_plain(write(tmp_path, curve(cut(t, decimals), z, decimals)))
    assert f"rounded to {decimals} decimals" in signal.notices[0]
    # A whole number of Hz is exact; any other is known to a last digit over the record.
    assert 1.0 / signal.timestep == pytest.approx(rate, rel=1e-12 if rate.is_integer() else 10.0**-decimals / t[-1])


def test_64_a_jittering_clock_is_none(tmp_path):
    """The same number of decimals, but the stamps leave the clock by two of the last."""
    t = np.arange(6000) / 2048.0 + 2e-6 * np.random.default_rng(1).uniform(-1.0, 1.0, 6000)
    with pytest.raises(DataError, match="not uniform"):
        read_plain(write(tmp_path, curve(t, 1e-3 * np.sin(60.0 * t), 6)))


def test_64_pauses_and_drift_are_mentioned(tmp_path):
    t = np.arange(10_000) / 1000.0
    shaking = curve(t, 5e-4 * np.sin(2.0 * np.pi * 5.0 * t) * ((t < 4.0) | (t > 6.0)))
    assert any("constant from 4 to 6 s" in text for text in read_plain(write(tmp_path, shaking)).notices)
    with pytest.raises(DataError, match=r":4002: .* gap of 2 s, from 3\.999 to 6 s"):
        read_plain(write(tmp_path, [*shaking[:4001], *shaking[6001:]]))
    drifting = write(tmp_path, curve(t, 1e-3 * np.sin(30.0 * t) + 3e-4 * t))
    (said,) = (text for text in read_plain(drifting).notices if "drifts" in text)
    assert "plate fr" in said and float(said.split()[4]) == pytest.approx(3.0, rel=0.05)


@pytest.mark.parametrize("name", shipped_inputs())
def test_64_shipped_inputs_neither_drift_nor_pause(name):
    assert not any("drifts" in text or "constant from" in text for text in read_plain(find_input(name)).notices)
