"""Text files of loggers, as engineers have them: read, inspected, chosen from, or refused with what decides."""

import json

import numpy as np
import pytest

from tests.validation import validated
from vehicle.commands.comfort import main as comfort
from vehicle.commands.inspect import main as inspect
from vehicle.commands.options import read
from vehicle.commands.shaker import parser
from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.excitation.signal_file import read_signal
from vehicle.signals.formats.reader import read_record
from vehicle.signals.records.record_settings import RecordSettings

NAMES = ["Time", "Shaker FR", *(f"Acc {n}" for n in range(1, 9))]
UNITS = ["s", "mm", *["g"] * 8]
FIVE = "time [s],z [mm]\n0.1,1.5\n0.2,1.5\n0.3,1.5\n0.4,1.5\n0.5,1.5\n"


def logger(path, *, pause=0.0, delimiter=";", decimal=",", seconds=8.0, rate=2048.0, drift=0.0, encoding="utf-8"):
    """Ten columns in mm and g, time with six decimals, text above; returns times and displacement [m]."""
    count = round(seconds * rate)
    time = 100.0 + np.arange(count) / rate
    time[count // 2 :] += pause
    z = 1e-3 * np.sin(2.0 * np.pi * 8.0 * time) + drift * np.arange(count) / count
    lines = ["Datalogger X-2000, Kanäle 10", "", "Start;2026-03-01 10:00:00", *map(delimiter.join, (NAMES, UNITS))]
    for t, value in zip(time, z, strict=True):
        cells = [f"{t:.6f}", f"{1e3 * value:.9f}", *(f"{0.1 * n * value * 1e3:.6f}" for n in range(1, 9))]
        lines.append(delimiter.join(cells).replace(".", decimal))
    path.write_text("\n".join(lines) + "\n", encoding=encoding)
    return time, z


def choice(*options):
    return read(parser().parse_args(["--input", "x.csv", *options]), RecordSettings).choice("fr")


def test_a_logger_file_is_inspected(tmp_path, capsys):
    path = tmp_path / "measurement.dat"  # recognised by what it holds
    time, z = logger(path, pause=2.5, encoding="cp1252")
    assert inspect([str(path), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["format"] == "csv" and [one["number"] for one in found["channels"]] == list(range(1, 10))
    shaker, first = found["channels"][:2]
    assert (shaker["name"], shaker["unit"], shaker["si_unit"], shaker["quantity"]) == (
        "Shaker FR", "mm", "m", "displacement")  # fmt: skip
    assert shaker["rms"] == pytest.approx(1e-3 / np.sqrt(2.0), rel=1e-6) and shaker["samples"] == time.size
    assert shaker["max"] == pytest.approx(z.max(), abs=1e-12)
    assert shaker["rate_hz"] == 2048.0
    assert (first["quantity"], first["si_unit"]) == ("acceleration", "m/s2")
    assert first["max"] == pytest.approx(0.1 * 1e3 * z.max() * 9.80665, rel=1e-4)
    text = " ".join(found["notices"])
    for words in ("1 pause: 103.999512 to 106.5 s; set --from 100 --to 103.999512 ", "decimal comma", "Windows text"):
        assert words in text
    assert inspect([str(path)]) == 0
    assert "--channel 'fr=Shaker FR' --from 100 --to 103.999512\n" in capsys.readouterr().out


def test_a_logger_file_drives_the_plate_with_four_options(tmp_path):
    path = tmp_path / "logger.txt"
    time, _ = logger(path, pause=2.5, drift=4e-3, seconds=16.0)
    pause = r"gap of 2\.5\d* s, .* \(--to 107\.99\d+\) or after it \(--from 110\.5\)"
    for words, message in ((["--detrend"], "9 channels .*--channel fl=NAME"), (["--channel", "fr=Shaker*"], pause)):
        with pytest.raises(DataError, match=message):
            read_signal(path, choice=choice(*words))
    found = read_signal(path, choice=choice("--channel", "fr=Shaker FR", "--from", "101", "--to", "107.9", "--detrend"))
    said = " ".join(found.notices)
    for part in ("1 'Shaker FR' [mm]", "excerpt from 101 to 107.9", "assumed to be 2048 Hz", "straight line from"):
        assert part in said, said
    assert found.timestep == pytest.approx(1.0 / 2048.0, rel=1e-12)
    kept = (time >= 101.0) & (time <= 107.9)
    expected = np.sin(2.0 * np.pi * 8.0 * time[kept]) * 1e-3
    # The ramp changes the first seconds; a line fitted to whole periods and a bit of a sine takes 1 % of it at most.
    np.testing.assert_allclose(found.displacement["fr"][-8000:], expected[-8000:], atol=1e-5)


@pytest.mark.parametrize("order", [1, 2])
def test_accelerations_and_velocities_are_integrated(tmp_path, order):
    """z = sum of sines far above the corner; its exact derivative comes back as z, but for the ends."""
    rate, corner = 1000.0, 0.5
    time = np.arange(20000) / rate
    waves = [(2e-3, 5.0), (1e-3, 11.3)]
    z = sum(a * np.sin(2 * np.pi * f * time) for a, f in waves)
    derived = sum(a * (2 * np.pi * f) ** order * np.sin(2 * np.pi * f * time + order * np.pi / 2) for a, f in waves)
    path, unit = tmp_path / "plate.csv", {1: "m/s", 2: "m/s²"}[order]
    rows = "\n".join(f"{t:.3f}\t{v:.9e}" for t, v in zip(time, np.asarray(derived), strict=True))
    path.write_text(f"time [s]\tPlate ({unit})\n{rows}\n", encoding="utf-8")
    with pytest.raises(DataError, match=r"displacement; .*--highpass"):
        read_signal(path, choice=choice("--channel", "fr=Plate"))
    found = read_signal(path, choice=choice("--channel", "fr=Plate", "--highpass", str(corner)))
    assert "integrated in the frequency domain, high-pass 0.5 Hz" in " ".join(found.notices)
    values = found.displacement["fr"][-time.size :]
    # What the filter makes of the two ends rings for some periods of its corner.
    validated(
        "File readers", f"displacement integrated from {'a velocity' if order == 1 else 'an acceleration'}",
        values[9000:-9000], np.asarray(z)[9000:-9000], abs=3e-6, unit="m", source="closed form: sum of sines",
    )  # fmt: skip


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("time [s],z\n" + "0.01,1.5\n" * 3, "no unit; set --unit fr=UNIT"),
        ("time [s],z [furlong]\n" + "0.01,1.5\n" * 3, "'furlong'; set --unit fr=UNIT"),
        ("time,z [mm]\n" + "0.01,1.5\n" * 3, "no times; set --rate HZ"),
        ("time [s],z [mm]\n" + "0.5,1.5\n" * 3, "time 0.5 s after 0.5 s; times must increase"),
        ("time [s],z [mm]\n0,0,1,5\n0,1,1,5\n0,2,1,5\n0,3,1,6\n", "decimal commas"),
        (f"{FIVE}0.6,x\n", r"1 missing values \('x' in line 7 is not a number\)"),
        (f"{FIVE}0.6\n", "truncated"),
        ("time [s];z [mm]\n0,1;1.000,5\n0,2;1,5\n0,3;1,5\n", "no table of numbers|separate thousands"),
        ("time [s],z [mm]\n0.1,x\n" + "0.2,1.5\n" * 6, r"1 missing values \('x' in line 2 .*\), the first at 0\.1 s"),
        ("nothing\nhere\n", "no table of numbers"),
    ],
)
def test_what_is_open_is_refused_with_what_decides(tmp_path, text, message):
    path = tmp_path / "log.csv"
    path.write_text(text)
    with pytest.raises(DataError, match=message):
        read_signal(path, choice=choice("--channel", "fr=z"))


def test_a_wrong_pick_lists_all_channels(tmp_path):
    path = tmp_path / "log.csv"
    logger(path, seconds=0.1)
    for words, error, said in (
        (["--channel", "fr=Shaker FL"], DataError, r"matches no .*1 'Shaker FR' \[mm\], 2 'Acc 1' \[g\]"),
        (["--channel", "fr=Acc*"], DataError, r"matches 8 channels \(2, 3, 4.*1 'Shaker FR' \[mm\], 2 'Acc 1' \[g\]"),
        (["--channel", "fr=12"], DataError, r"matches no .*1 'Shaker FR' \[mm\], 2 'Acc 1' \[g\]"),
        (["--unit", "furlong"], ConfigurationError, "--unit furlong: unknown unit"),
        (["--channel", "xx=1"], ConfigurationError, "--channel xx=.* fr, fl, rr, rl, time"),
    ):
        with pytest.raises(error, match=said):
            read_signal(path, choice=choice(*words))


def test_units_and_rates_of_the_request_are_said(tmp_path):
    path = tmp_path / "log.csv"
    _, z = logger(path, delimiter="\t", decimal=".", seconds=2.0)
    found = read_signal(
        path, choice=choice("--channel", "fr=1", "--unit", "um", "--rate", "1024"), accept_implausible=True
    )
    said = " ".join(found.notices)
    assert "[um] as requested, not [mm]" in said and "rate 1024 Hz, as requested; the file has 2048 Hz" in said
    assert np.max(found.displacement["fr"]) == pytest.approx(1e-3 * z.max(), rel=1e-3)
    assert found.timestep == 1.0 / 1024.0


def test_a_chosen_channel_is_judged_by_its_own_unit_and_time(tmp_path):
    path, time = tmp_path / "log.csv", np.arange(400) / 512.0
    rows = (f"{t:.7f},{50.0 * np.sin(8.0 * np.pi * t):.6f}\n" for t in time)
    path.write_text("t,plate\n" + "".join(rows))
    first, second = (one.remark for one in read_record(path).channels)
    assert first.endswith("set --rate HZ, or --channel time=t --unit time=s") and second == ""
    told = ("--channel", "time=t", "--unit", "time=s", "--channel", "plate", "--unit")
    with pytest.raises(DataError, match="--unit fr=UNIT"):
        read_signal(path, choice=choice(*told, "m"))
    found = read_signal(path, choice=choice(*told, "mil"))
    assert found.notices[0] == "fr: channel 2 'plate' [mil]" and "known unit" not in "".join(found.notices)
    assert found.displacement["fr"].max() == pytest.approx(50.0 * 25.4e-6, rel=1e-3)


@pytest.mark.parametrize("head", ["|CF,2,1,1;", '<?xml version="1.0"?><usi:tdm version="1.0">', "DEWESOFT 7"])
def test_formats_that_are_not_read_are_named(tmp_path, head):
    path = tmp_path / "foreign.raw"
    path.write_text(head + "x" * 50)
    with pytest.raises(DataError, match=r"(FAMOS|TDM of DIAdem|Dewesoft), not supported; export "):
        read_record(path)


def test_comfort_takes_any_channels(tmp_path, capsys):
    path = tmp_path / "logger.txt"
    logger(path, seconds=20.0, rate=512.0)
    picks = [word for pick in ("x=Acc 1", "y=3", "z=Acc 8") for word in ("--channel", pick)]
    assert comfort(["--input", str(path), "--json", *picks, "--from", "102"]) == 0
    found = json.loads(capsys.readouterr().out)
    # 8 Hz, amplitude n/10 g: Wk(8 Hz) = 1.036, Wd(8 Hz) = 0.253 (ISO 2631-1, table 3)
    for axis, level, factor in (("z", 0.8, 1.036), ("y", 0.2, 0.253)):
        validated(
            "Comfort, ISO 2631", f"weighted RMS of a sine of 8 Hz and {level:g} g in a logger file, {axis}",
            found[axis]["weighted_rms"], level * 9.80665 / np.sqrt(2.0) * factor, rel=0.01, unit="m/s2",
            source="standard: ISO 2631-1:1997, table 3",
        )  # fmt: skip
    assert any("z: channel 9 'Acc 8' [g]" in text for text in found["notices"])
    for wrong, said in (
        (["--channel", "time=1"], "which channels are the axes"),
        ([*picks[:4], "--channel", "z=1"], "is a displacement but must be an acceleration"),
    ):
        assert comfort(["--input", str(path), *wrong]) == 3
        assert said in capsys.readouterr().err
