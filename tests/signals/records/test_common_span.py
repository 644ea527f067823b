"""Channels with their own starts, rates and axes: cut or resampled to the common span, never shifted in silence."""

import shlex
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.failing_inputs import PLATE, made
from tests.signals.formats.logger_files import LVM
from tests.validation import validated
from vehicle.__main__ import main
from vehicle.commands.advice import command_for
from vehicle.commands.inspect import contents
from vehicle.commands.shaker import main as shaker
from vehicle.errors import DataError
from vehicle.signals.excitation.measured_road import read_road
from vehicle.signals.formats import hdf_format, mdf_format
from vehicle.signals.formats.channel import Channel, Measurement, uniform_axis
from vehicle.signals.formats.reader import read_record
from vehicle.signals.formats.uff_writer import write as write_uff
from vehicle.signals.records.choice import Choice, choose
from vehicle.signals.records.measured import read_measured

BOTH = {"plate_fl_displacement": "Plate FL", "knuckle_fl_acc_z": "Plate FL acceleration"}


def motion(time):
    """Smooth motion with parts from 0.7 to 11 Hz, known at any time."""
    return sum(np.sin(2 * np.pi * f * time + n) for n, f in enumerate((0.7, 2.3, 5.9, 11.0)))


def channel(name, start, rate=100.0, count=1000, unit="m/s2"):
    time = uniform_axis(count, 1.0 / rate, start)
    return Channel(name=name, values=motion(time), unit=unit, axis=time)


def measurement(*channels):
    return Measurement(path=Path("record.x"), format="test", channels=channels)


def test_starts_of_tdms_are_read_and_the_channels_cut(tmp_path):
    """The second channel is the second difference of the first, with the start time that the file states."""
    path = made("channels_start_apart.tdms", tmp_path)
    found = read_measured(path, list(BOTH), Choice(channels=BOTH))
    assert found.record is not None
    plate, measured = found.record.channels.values()
    expected = np.gradient(np.gradient(plate, found.record.step), found.record.step)
    validated(
        "File readers", "second difference of a displacement against an acceleration that starts later, TDMS",
        measured[5:-5], expected[5:-5], peak=1e-4, unit="m/s2",
        source="second derivation: the record from which both channels were made",
    )  # fmt: skip
    assert (found.record.start, found.record.time.size, found.start) == (0.25, 2975, 0.0)
    assert any("common time, 0.25 to 29.99 s" in text for text in found.notices)
    content = contents(read_record(path))
    assert [one["start_s"] for one in content["channels"]] == [0.0, 0.25]
    assert any("begin at 0 to 0.25 s and end at 29.99 to 30.24 s" in text for text in content["notices"])


def test_shaker_cuts_two_plates_to_their_common_span(tmp_path, capsys):
    nptdms = pytest.importorskip("nptdms")
    path, begin = tmp_path / "rig.tdms", np.datetime64("2026-11-26T10:00:00")
    starts = {"Plate FR": 0, "Plate FL": 250}
    with nptdms.TdmsWriter(path) as writer:
        writer.write_segment([
            nptdms.ChannelObject("g", name, 1e-3 * motion(uniform_axis(1500, 2e-3, 1e-3 * later)),
                                 properties={"wf_start_time": begin + np.timedelta64(later, "ms"), "wf_increment": 2e-3,
                                             "wf_start_offset": 0.0, "unit_string": "m"})
            for name, later in starts.items()
        ])  # fmt: skip
    picks = [word for name in starts for word in ("--channel", f"{name[-2:].lower()}={name}")]
    output = tmp_path / "out"
    assert shaker(["--input", str(path), *picks, "--output", str(output), "--engine", "reduced", "--no-figures"]) == 0
    assert "common time, 0.25 to 2.998 s" in capsys.readouterr().out
    with np.load(output / "time.npz") as run:
        names = {name.split(" [")[0]: name for name in run.files}
        plates = [run[names[f"plate_{wheel}_displacement"]] for wheel in ("fr", "fl")]
    late = slice(plates[0].size // 3, None)
    np.testing.assert_allclose(plates[0][late], plates[1][late], atol=1e-6)  # one motion at one time


def test_samples_that_coincide_are_cut_and_said():
    record = measurement(channel("a", 3.0), channel("b", 3.5), channel("c", 2.0))
    chosen = choose(record, Choice(channels={"x": "a", "y": "b", "z": "c"}))
    assert (chosen.time[0], chosen.time[-1]) == (3.5, pytest.approx(11.99))
    for values in chosen.values.values():
        np.testing.assert_allclose(values, motion(chosen.time), atol=1e-12)
    said = " ".join(chosen.notices)
    assert "x 3 to 12.99 s, y 3.5 to 13.49 s, z 2 to 11.99 s" in said and "common time, 3.5 to 11.99 s" in said


@pytest.mark.parametrize(("start", "rate"), [(3.0037, 100.0), (3.0, 250.0), (2.5003, 40.0)])
def test_samples_at_other_times_need_resampling_and_get_it(tmp_path, start, rate):
    pytest.importorskip("h5py")
    record = measurement(channel("seat x", 3.0), channel("seat y", start, rate, int(10 * rate)))
    both = Choice(channels={"x": "seat x", "y": "seat y"})
    lowest = min(rate, 100.0)
    with pytest.raises(DataError, match=rf"at different times \(x 100 Hz from 3 s, .*set --resample {lowest:g}"):
        choose(record, both)
    chosen = choose(record, replace(both, resample=lowest))
    assert chosen.time[0] == max(3.0, start) and chosen.highest == pytest.approx(0.4 * lowest)
    inside = slice(60, -60)  # the anti-alias filter has half a second of its own at the ends
    for values in chosen.values.values():
        np.testing.assert_allclose(values[inside], motion(chosen.time)[inside], atol=2e-3)
    path = tmp_path / "record.h5"
    hdf_format.write(path, record.channels, "test")
    command, _ = command_for(read_record(path), str(path))
    assert f"--resample {lowest:g}" in command
    assert main(shlex.split(command)[3:]) == 0


def test_channels_of_other_hours_have_no_common_span():
    record = measurement(channel("a", 0.0), channel("b", 3600.0))
    with pytest.raises(DataError, match=r"x 0 to 9\.99 s, y 3600 to 3609\.99 s"):
        choose(record, Choice(channels={"x": "a", "y": "b"}))


def test_a_rate_on_request_keeps_the_starts():
    """--rate replaces the clock of the file, not what it says on which samples belong together."""
    record = measurement(channel("a", 3.0), channel("b", 3.5))
    chosen = choose(record, Choice(channels={"x": "a", "y": "b"}, rate=200.0))
    np.testing.assert_allclose(chosen.values["x"], chosen.values["y"], atol=1e-12)
    assert (chosen.time[0], chosen.time.size) == (0.0, 950)


@pytest.mark.parametrize("form", ["uff", "mf4", "h5", "lvm X0", "lvm Time"])
def test_starts_of_other_formats(tmp_path, form):
    """UFF 58 (abscissa minimum), MDF (times of a group), HDF5 (start), LVM (X0, or Date and Time of a channel)."""
    channels = (channel("a", 0.0, count=400), channel("b", 0.25, count=400))
    path = tmp_path / f"record.{form.split()[0]}"
    if form == "uff":
        write_uff(path, channels, "test")
    elif form == "mf4":
        pytest.importorskip("asammdf")
        mdf_format.write(path, channels, "test")
    elif form == "h5":
        pytest.importorskip("h5py")
        hdf_format.write(path, channels, "test")
    else:
        head = (
            LVM[: LVM.index("X_Value\tExcitation")].replace("3,906250E-5", "1,0E-2").replace("\t6\t6\t", "\t400\t400\t")
        )
        head = head.replace("Newtons", "m/s2").replace("m/s^2", "m/s2")
        old, new = {
            "lvm X0": ("X0\t0,0000000000000000E+0\t0,0000000000000000E+0", "X0\t0,0\t0,25"),
            "lvm Time": ("Time\t09:51:40,5\t09:51:40,5", "Time\t09:51:40,5\t09:51:40,75"),
        }[form]
        assert old in head
        rows = [f"\t{x:.9f}\t{y:.9f}".replace(".", ",")
                for x, y in zip(channels[0].values, channels[1].values, strict=True)]  # fmt: skip
        path.write_text("\n".join([head.replace(old, new) + "X_Value\ta\tb\tComment", *rows, ""]), newline="\n")
    found = read_record(path)
    assert [float(one.axis[0]) for one in found.channels if one.axis is not None] == [0.0, 0.25]
    chosen = choose(found, Choice(channels={"x": "a", "y": "b"}))
    np.testing.assert_allclose(chosen.values["x"], motion(chosen.time), atol=1e-6)
    np.testing.assert_allclose(chosen.values["y"], motion(chosen.time), atol=1e-6)
    assert chosen.time.size == 375


def master(path, kind, unit, name="s", heights="m", step=0.05):
    """Write an MDF 4 group whose master channel has another type than time, as the header states."""
    asammdf = pytest.importorskip("asammdf")
    with asammdf.MDF(version="4.10") as file:
        over = asammdf.Signal(motion(np.arange(200) / 50), step * np.arange(200), name="height_left", unit=heights,
                              master_metadata=(name, kind))  # fmt: skip
        file.append([over])
        file.groups[0].channels[0].unit = unit
        file.save(path, overwrite=True)


def test_a_master_of_distance_is_a_road(tmp_path):
    path = made("master_distance.mf4", tmp_path)
    found = read_record(path)
    assert [(one.name, one.unit, one.rate) for one in found.channels] == [("distance", "m", None), ("height_left", "m", None)]  # noqa: E501  # fmt: skip
    command, _ = command_for(found, str(path))
    assert command.endswith(f"--road {path} --speed 80")
    road = read_road(path, 1.5)
    assert road.length == pytest.approx(59.98, rel=1e-3) and np.std(road.left) == pytest.approx(np.std(PLATE), rel=1e-3)
    with pytest.raises(DataError, match="'height_left' is a road profile but must be a time history"):
        choose(found, Choice(channels={"fl": "height_left"}, rate=200.0))


@pytest.mark.parametrize(("kind", "unit", "quantity"), [(2, "rad", "angle"), (2, "deg", "angle"), (4, "", "index"), (3, "km", "distance"), (1, "m", "distance")])  # noqa: E501  # fmt: skip
def test_masters_that_are_no_time(tmp_path, kind, unit, quantity):
    path, step = tmp_path / "record.mf4", 5e-4 if unit == "km" else 0.05  # 100 m, which an advised command drives over
    master(path, kind, unit, step=step)
    found = read_record(path)
    over, heights = found.channels
    assert over.unit == unit and heights.axis is None and f"has the quantity {quantity}, not time" in heights.remark
    np.testing.assert_allclose(over.values, step * np.arange(200))
    if quantity != "index":  # a count of samples may get a rate, an angle may not
        with pytest.raises(DataError, match="must be a time history"):
            choose(found, Choice(channels={"fl": "height_left"}, rate=200.0))


def test_a_master_in_milliseconds_is_converted(tmp_path):
    path = tmp_path / "record.mf4"
    master(path, 1, "ms")
    (heights,) = read_record(path).channels
    assert heights.rate == pytest.approx(20000.0)


def test_axes_of_tdms_that_are_no_time(tmp_path):
    nptdms = pytest.importorskip("nptdms")
    path = tmp_path / "record.tdms"
    with nptdms.TdmsWriter(path) as writer:
        writer.write_segment([
            nptdms.ChannelObject("g", unit, motion(np.arange(100) / 50),
                                 properties={"wf_increment": 0.5, "wf_xunit_string": unit, "unit_string": "m"})
            for unit in ("s", "ms", "Hz", "m", "deg")
        ])  # fmt: skip
    time, milli, lines, road, angle = read_record(path).channels
    assert time.rate == 2.0 and milli.rate == pytest.approx(2000.0)
    assert lines.kind == "frequency" and lines.axis is not None and lines.axis[1] == 0.5
    assert road.axis is None and "in 'm', not a time" in road.remark
    assert angle.axis is None and "in 'deg', not a time" in angle.remark


def test_a_scaling_of_tdms_is_applied_or_takes_the_unit_away(tmp_path):
    nptdms = pytest.importorskip("nptdms")
    path = tmp_path / "raw.tdms"
    scalings = {
        "linear": {"Scale_Type": "Linear", "Linear_Slope": 0.05, "Linear_Y_Intercept": 1.0},
        "reciprocal": {"Scale_Type": "Reciprocal", "Reciprocal_X": 0.05},
    }
    with nptdms.TdmsWriter(path) as writer:
        writer.write_segment([
            nptdms.ChannelObject("g", name, np.arange(5, dtype=np.int16),
                                 properties={"wf_increment": 0.01, "unit_string": "m/s^2", "NI_Number_Of_Scales": 1,
                                             **{f"NI_Scale[0]_{key}": value for key, value in scaling.items()}})
            for name, scaling in scalings.items()
        ])  # fmt: skip
    linear, raw = read_record(path).channels
    np.testing.assert_allclose(linear.values, 1.0 + 0.05 * np.arange(5))
    assert (linear.unit, linear.remark, raw.unit) == ("m/s^2", "", "")
    assert "scaling (Unsupported scale type: Reciprocal), so the unit 'm/s^2' is ignored" in raw.remark


def test_an_axis_of_lvm_that_is_no_time(tmp_path):
    path = tmp_path / "record.lvm"
    path.write_text(LVM.replace("X_Dimension\tTime\tTime", "X_Dimension\tDistance\tTime"), newline="\n")
    over, time = read_record(path).channels
    assert over.axis is None and over.remark == "the axis is a distance, not a time" and time.rate == 25600.0
