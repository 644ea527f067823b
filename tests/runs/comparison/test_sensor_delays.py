"""Sensors that lag the plates: the delay of each group, one sentence, and an option that takes it out."""

import json
import re

import numpy as np
import pytest

from tests.delayed_records import RATE, shaken, write_record
from tests.validation import validated
from vehicle import save_run
from vehicle.commands.compare import main
from vehicle.errors import VehicleError
from vehicle.runs.car import Car
from vehicle.runs.comparison.compared_run import compare
from vehicle.signals.formats.channel import Channel
from vehicle.signals.formats.uff_writer import write
from vehicle.signals.records.choice import Choice
from vehicle.signals.records.delays import parsed_delays

ACCELERATIONS = ("knuckle_fr_acc_z", "knuckle_fl_acc_z", "seat_rail_acc_z", "engine_acc_z")
OTHERS = ("plate_fr_displacement", "plate_fl_displacement", "damper_fr_velocity")
OPTION = re.compile(r"--delay (\S+=\S+)")


@pytest.fixture(scope="module")
def run():
    """A run of two independent plates over 16 s."""
    return Car.load().run(shaken(("fr", "fl"), 16.0), engine="reduced", channels=[*OTHERS, *ACCELERATIONS])


def delays(value):
    return {**dict.fromkeys(OTHERS, 0.0), **dict.fromkeys(ACCELERATIONS, value)}


def found(comparison):
    return {group.group: group for group in comparison.delays}


@pytest.mark.parametrize(("delay", "noise"), [(0.4e-3, 0.0), (0.0, 0.1), (12.3e-3, 0.1)])
def test_delay_of_the_accelerations_is_found_and_taken_out(run, tmp_path, delay, noise):
    file = write_record(tmp_path / "record.csv", run, delays(delay), noise=noise, noisy="")
    comparison = compare(run, file)
    groups = found(comparison)
    assert {*groups} == {"plates", "accelerations", "velocities"} and next(iter(groups)) == "plates"
    assert groups["plates"].against == "run"
    validated(
        "FRF estimation and spectra",
        f"delay of accelerations against two plates, {1e3 * delay:g} ms, {100 * noise:g} % noise, in samples",
        RATE * groups["accelerations"].delay, RATE * delay, abs=0.1 if noise else 0.02,
        source="closed form: shift of the spectrum of a run",
    )  # fmt: skip
    assert abs(RATE * groups["velocities"].delay) < (0.1 if noise else 0.02)
    said = [text for text in comparison.notices if "--delay" in text]
    if not delay:
        assert not said
        return
    (text,) = said
    assert text.startswith(f"the accelerations lag the plates by {1e3 * groups['accelerations'].delay:.3g} ms")
    name, _, value = OPTION.findall(text)[0].partition("=")
    again = compare(run, file, delay=parsed_delays([f"{name}={value}"]))
    assert not [text for text in again.notices if "--delay" in text]
    rest = found(again)["accelerations"]
    assert RATE * (rest.delay - rest.taken_out) == pytest.approx(0.0, abs=0.02) and rest.taken_out > 0.0
    # Below 3 Hz accelerations of 0.5 mm are below noise of 10 % of their RMS, with a delay or without.
    assert again.signatures is not None
    inside = again.signatures.frequency >= 3.0
    assert np.mean(again.signatures.csac[inside]) > 0.99


def test_one_sensor_alone_and_a_pattern(run, tmp_path):
    """A delay of one channel is none of its group; --delay CHANNEL=TIME takes it out."""
    file = write_record(tmp_path / "record.csv", run, {**delays(0.0), "seat_rail_acc_z": 5e-3})
    comparison = compare(run, file)
    group = found(comparison)["accelerations"]
    assert (group.agreeing, group.channels) == (3, 4) and abs(group.delay) < 2e-5
    (said,) = [text for text in comparison.notices if text.startswith("seat_rail_acc_z ")]
    assert "lags the other accelerations by 5 ms" in said and "in 3 of 4 channels" in comparison.text()
    (option,) = OPTION.findall(said)
    name, _, value = option.partition("=")
    assert name == "seat_rail_acc_z" and float(value.removesuffix("ms")) == pytest.approx(5.0, abs=0.02)
    again = compare(run, file, delay={"seat_*": 5e-3})
    assert not [text for text in again.notices if text.startswith("seat_rail_acc_z ")]
    lags = {record.channel: record.lag for record in again.records}
    assert max(map(abs, lags.values())) < 2e-5


def test_frfs_of_a_file_have_the_delay_in_their_phase(run, tmp_path):
    motion = run.frfs(ACCELERATIONS[:2])[0]
    frf = motion.response
    turn = np.exp(-2j * np.pi * frf.frequency * 12.3e-3)
    channels = [
        Channel(name=f"{name}/{motion.input}", values=values * turn, unit="(m/s2)/(m)", kind="frequency",
                function="frequency response", axis=frf.frequency)
        for name, values in zip(ACCELERATIONS[:2], frf.response, strict=True)
    ]  # fmt: skip
    write(tmp_path / "frf.uff", channels, "made")
    comparison = compare(run, tmp_path / "frf.uff")
    (group,) = comparison.delays
    assert (group.group, group.against) == ("accelerations", "plates")
    assert group.delay == pytest.approx(12.3e-3, abs=2e-5)
    assert "the accelerations lag the plates by 12.3 ms" in " ".join(comparison.notices)
    again = compare(run, tmp_path / "frf.uff", choice=Choice(delays={"accelerations": 12.3e-3}))
    assert max(band.phase_deg for item in again.responses for band in item.bands) < 0.5


def test_command_says_it_and_takes_it_out(run, tmp_path, capsys):
    """A record that began 0.05 s after the run as well: both options at once."""
    save_run(run.car.run(run.signal, engine="reduced"), tmp_path / "run", figures=False)
    file = write_record(tmp_path / "all.csv", run, delays(12.3e-3))
    rows = file.read_text().splitlines()
    head = next(number for number, row in enumerate(rows) if row.startswith("time"))
    kept = [row.split(",") for row in rows[head + 51 :]]
    begin = float(kept[0][0])
    table = [",".join([f"{float(first) - begin:.9g}", *rest]) for first, *rest in kept]
    (tmp_path / "record.csv").write_text("\n".join([rows[head], *table, ""]))
    words = [str(tmp_path / "run"), "--measured", str(tmp_path / "record.csv"), "--no-figures"]
    assert main([*words, "--output", str(tmp_path / "first")]) == 0
    said = capsys.readouterr().out
    options = [text.rstrip(",") for text in re.findall(r"--delay (\S+)", said)]
    assert options[0] == "0.05" and options[1].startswith("accelerations=12.3")
    assert "accelerations 12.300 +- " in said and "ms after the plates" in said
    again = [word for option in options for word in ("--delay", option)]
    assert main([*words, *again, "--output", str(tmp_path / "second"), "--json"]) == 0
    content = json.loads(capsys.readouterr().out)
    assert not [text for text in content["notices"] if "--delay" in text]
    entry = next(each for each in content["delays"] if each["group"] == "accelerations")
    assert entry["delay_s"] == pytest.approx(12.3e-3, abs=2e-5) and entry["taken_out_s"] > 0.0
    assert min(record["correlation"] for record in content["records"]) > 0.999


@pytest.mark.parametrize(
    ("option", "message"),
    [
        ("accelerations=x", "--delay accelerations=x: .* ms or us"),
        ("accelerations=3min", "--delay accelerations=3min: "),
        ("forces=1ms", "--delay forces=.*plates, velocities, accelerations"),
        ("accelerations=900", "--delay: 0 to 900 s "),
    ],
)
def test_what_is_no_delay_is_refused(run, tmp_path, option, message):
    assert parsed_delays(["accelerations=12.3", "0.2"]) == {"accelerations": 12.3, "record": 0.2}
    file = write_record(tmp_path / "record.csv", run, delays(0.0))
    with pytest.raises(VehicleError, match=message):
        compare(run, file, delay=parsed_delays([option]))
