"""Clipped, stuck and copied channels are named; sound ones are not."""

import importlib

import numpy as np
import pytest

from tests.benchmarks.clipped_channels import BANDS, LEVELS, RATES, WITH_RESTS, limited, noise, sound
from tests.benchmarks.record_alignment import made_pair
from vehicle.signals.excitation.input_files import find_input, shipped_inputs
from vehicle.signals.excitation.signal_file import read_signal
from vehicle.signals.records.channel_faults import clipped, copies, faults, stuck

TIME = (np.arange(20000) * 1e-3).astype(np.float64)


def random_record(seed=1, band=(0.5, 50.0)):
    return made_pair(20.0, 0.0, 0.0, band=band, seed=seed)[0]


@pytest.mark.parametrize("level", [1.0, 2.0, 3.0])
@pytest.mark.parametrize("digits", [None, 2])
def test_a_clipped_record(level, digits):
    values = np.minimum(random_record(), level)
    values = values if digits is None else np.round(values, digits)
    ((side, size, share),) = clipped(values)
    assert side == "largest value" and size == pytest.approx(level) and share == np.mean(values >= level - 1e-9)
    assert [one[0] for one in clipped(-values)] == ["smallest value"]
    (said,) = faults({"z": values}, TIME)
    assert said.startswith("z: clipped?") and "--from, --to" in said


@pytest.mark.parametrize("band", BANDS)
@pytest.mark.parametrize("rate", RATES)
def test_clipped_records_of_all_bands(band, rate):
    """A seed of the benchmark, not one of its table: found wherever more than 1 % of the samples are flat."""
    for level in LEVELS:
        flat, found = limited(band, level, rate, [100])
        assert found == flat and (flat == 1 or level >= 2.5), level


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("seed", [100, 101])
def test_sound_records_of_all_kinds(rate, seed):
    names = []
    for name, values in sound(rate, seed):
        names.append(name)
        assert clipped(values) == [], name
        assert name in WITH_RESTS or stuck(values, np.arange(values.size) / rate) is None, name
    assert len(names) == 15


RISE = np.clip((TIME - 5.0) / 0.2, 0.0, 1.0)
SOUND = {
    "random": random_record(),
    "random, one digit": np.round(random_record(), 1),
    "random, eight bits": np.round(random_record() * 32.0) / 32.0,
    "narrow band": random_record(band=(1.2, 1.6)),
    "sine": np.sin(2.0 * np.pi * 3.0 * TIME),
    "sine, two digits": np.round(np.sin(2.0 * np.pi * 0.3 * TIME), 2),
    "sine with four samples a period": np.sin(2.0 * np.pi * 250.0 * TIME),
    "bump": np.where(np.abs(TIME - 5.0) < 0.1, 0.5 * (1.0 + np.cos(10.0 * np.pi * (TIME - 5.0))), 0.0),
    "plateau with smooth flanks": RISE**2 * (3.0 - 2.0 * RISE),
    "constant": np.full(TIME.size, 2.0),
}  # fmt: skip


@pytest.mark.parametrize("name", SOUND)
def test_sound_records_are_quiet(name):
    assert faults({"z": SOUND[name], "x": random_record(seed=9)}, TIME) == []
    assert clipped(SOUND[name]) == [] and stuck(SOUND[name], TIME) is None


def test_a_stuck_sensor():
    values = random_record()
    values[8000:11000] = values[8000]
    assert stuck(values, TIME) == pytest.approx((8.0, 10.999))
    (said,) = faults({"z": values}, TIME)
    assert said.startswith("z: constant for 3 s, from 8 to 10.999 s")
    (said,) = faults({"z": values}, 12_000.0 + TIME)
    assert said.startswith("z: constant for 3 s, from 12008 to 12011 s")
    # At a few Hz, half a second is no sign by its length, but by the samples that repeat nowhere else.
    slow, time = noise(BANDS[0], 200.0, 3), np.arange(12_000) / 200.0
    slow[4000:4100] = slow[4000]
    assert stuck(slow, time) == pytest.approx((20.0, 20.495))
    coarse = np.round(slow * 5.0) / 5.0  # repeats at each extreme
    assert stuck(coarse, time) is None
    # A slow motion may rest as long.
    assert stuck(np.where(TIME < 17.0, np.sin(np.maximum(TIME, 14.0) / 2.0), np.sin(8.5)), TIME) is None


def test_a_channel_that_ends_while_another_goes_on():
    fading = random_record() * np.clip((15.0 - TIME) / 3.0, 0.0, 1.0) ** 2
    assert stuck(fading, TIME) is None  # alone it may come to rest
    assert stuck(fading, TIME, [random_record(seed=2)]) == pytest.approx((15.0, 19.999), abs=2e-3)
    other = random_record(seed=2)
    assert faults({"x": fading, "y": other}, TIME) == [] != faults({"x": fading, "y": other}, TIME, moving="xy")


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("held", ["last value", "zero"])
def test_a_record_that_is_constant_at_an_end(seed, held):
    """It was accepted, and the third of a record without motion lowered its comfort by a fifth."""
    values = random_record(seed)
    values[14000:] = values[14000] if held == "last value" else 0.0
    assert stuck(values, TIME) == pytest.approx((14.0, 19.999), abs=2e-3)
    (finding,) = faults({"z": values}, TIME)
    assert finding.options == ("--to", "14") and "--to 14" in finding
    assert stuck(values[::-1], TIME) == pytest.approx((0.0, 5.999), abs=2e-3)
    assert faults({"z": values[::-1]}, TIME)[0].options[0] == "--from"
    assert stuck(values[::-1], TIME, from_rest=True) is None  # a plate that is not yet moving


def test_copies_but_for_offset_and_sign():
    one, other = random_record(), random_record(seed=2)
    assert copies({"x": one, "y": other, "z": 9.81 - one, "r": np.zeros(one.size)}) == [("x", "z")]
    assert copies({"x": one, "y": one + 1e-3 * other}) == []


@pytest.mark.parametrize("name", shipped_inputs())
def test_shipped_inputs_are_sound(name):
    notices = read_signal(find_input(name), wheel="fr").notices
    assert not any("clipped" in text or "constant for" in text for text in notices)


@pytest.mark.parametrize(("cell", "text"), [("1e200", "1e+200"), ("inf", "inf"), ("-inf", "-inf")])
@pytest.mark.parametrize("command", ["inspect", "comfort"])
def test_an_absurd_value_is_refused_for_what_it_is(tmp_path, capsys, command, cell, text):
    """1e200 raised RuntimeWarnings before the refusal, and inf was called a missing value."""
    rows = [f"{n / 500.0},{np.sin(0.3 * n):.6f}" for n in range(2000)]
    rows[1000] = f"2.0,{cell}"
    file = tmp_path / "seat.csv"
    file.write_text("\n".join(["time [s],seat z [m/s2]", *rows, ""]))
    arguments = [str(file)] if command == "inspect" else ["--input", str(file), "--channel", "z=seat z"]
    assert importlib.import_module(f"vehicle.commands.{command}").main(arguments) == (0 if command == "inspect" else 3)
    shown = capsys.readouterr()
    if command == "comfort":
        assert f"z: {text} at 2 s " in shown.err and "1e+30" in shown.err
    assert "missing" not in shown.out + shown.err
