"""Files of RaceChrono, Shimmer, MoTeC, AndroSensor, Torque, LabVIEW and VBOX: names, units, sources, times, values."""

import math

import numpy as np
import pytest

from tests.signals.formats.logger_files import CLOCKS, LVM, TEXTS, VBO, clock_file, lvm_segments
from vehicle.errors import DataError
from vehicle.signals.formats.clock_text import _any_form, _same_form, clock_seconds, epoch_seconds
from vehicle.signals.formats.heads import split_head
from vehicle.signals.formats.reader import read_record
from vehicle.signals.records.choice import Choice, choose


def read(tmp_path, text, name="log.csv", encoding="utf-8"):
    path = tmp_path / name
    path.write_text(text, encoding=encoding)
    return read_record(path)


@pytest.mark.parametrize("form", CLOCKS)
def test_dates_clocks_and_counts_are_times(tmp_path, form):
    found = read(tmp_path, clock_file(form))
    (channel,) = found.channels
    assert (channel.name, channel.unit, channel.si_unit) == ("acc_z_g", "g", "m/s2")
    np.testing.assert_allclose(channel.axis, 0.01 * np.arange(8), atol=3e-7)  # a count of s has 2.4e-7 s in a double
    np.testing.assert_allclose(channel.values, [float(f"{math.sin(n):.6f}") for n in range(8)])
    assert found.start and any("the time begins at" in text for text in found.notices)
    if form in ("s", "ms", "us", "ns"):
        assert found.start == "2026-02-09T19:20:02.000+00:00"


def test_a_date_and_a_clock_belong_together_and_the_order_of_day_and_month_is_said():
    seconds, start, notices = clock_seconds(["23:59:59.5", "00:00:00.5"], ["1/2/2026", "2/2/2026"])
    np.testing.assert_allclose(seconds, [0.0, 1.0])
    assert start == "1/2/2026 23:59:59.5" and "day first" in notices[0]
    seconds, _, notices = clock_seconds(["1/31/2026 23:59:59", "2/1/2026 00:00:01"])
    np.testing.assert_allclose(seconds, [0.0, 2.0])
    assert notices == []


def test_clocks_of_one_form_are_those_of_any_form():
    """The fast way, for cells that differ in digits alone, against the parser of each cell."""
    clocks = [f"{n % 24:02d}:{7 * n % 60:02d}:{13 * n % 60:02d}.{977 * n % 1000:03d}" for n in range(99)]
    cells = [f"2026-01-{31 - n % 2:02d}T{clock}Z" for n, clock in enumerate(clocks)]
    fast, slow = _same_form(cells), _any_form(cells)
    assert fast is not None and fast[0] == slow[0]
    np.testing.assert_allclose(fast[1], slow[1], atol=1e-9)
    assert _same_form([*cells, "2026-01-01T10:00:00Z"]) is None and _same_form(["10:00:00 AM"]) is None
    with pytest.raises(ValueError, match="2"):
        clock_seconds(["10:00:00", "10:00:01", "10:61:00"])


@pytest.mark.parametrize(("first", "step"), [(49105962326000.0, 5e7), (1.2e9, 1e4), (1.5e12, 1e7), (10.0, 0.01)])
def test_a_counter_since_power_on_is_no_date(first, step):
    assert epoch_seconds(first + step * np.arange(9), "") is None


@pytest.mark.parametrize(
    ("cell", "unit"),
    [
        *(("AccelX_g", "g"), ("acc_z_m_s2", "m/s2"), ("Time_ms", "ms"), ("Time since start in ms", "ms")),
        *(("yaw_rate_dps", "deg/s"), ("speed_kph", "km/h"), ("damper_mm", "mm"), ("mass_g", ""), ("wheel_s", "")),
        *(("speed_ms", ""), ("a_x", ""), ("Acc 1", "")),
    ],
)
def test_units_at_the_end_of_names(cell, unit):
    assert split_head(cell) == (cell, unit)


def test_names_that_other_signs_separate_and_titles(tmp_path):
    rows = "".join(f"{1549383915806 + 10 * n}\t{n}.5\t-{n}.5\n" for n in range(9))
    found = read(tmp_path, "Zeit in ms(GMT),Xpos,Geschw in km/h\n" + rows)
    assert [(one.name, one.unit) for one in found.channels] == [("Xpos", ""), ("Geschw in km/h", "km/h")]
    assert found.start == "2019-02-05T16:25:15.806+00:00" and found.channels[0].rate == pytest.approx(100.0)
    rows = "".join(f"0.0{n},{n}.5,-{n}.5\n" for n in range(9))
    found = read(tmp_path, "2017 2:47:57 PM,,\ntime_seconds,x,y\n" + rows)
    assert [(one.name, one.place) for one in found.channels] == [("x", ""), ("y", "")]


def test_a_line_of_units_alone_names_no_columns(tmp_path):
    found = read(tmp_path, "[s],[mm],(m/(s^2))\n" + "".join(f"0.0{n},{n}.5,-{n}.5\n" for n in range(9)))
    assert [(one.name, one.unit) for one in found.channels] == [("column 1", "s"), ("column 2", "mm"),
                                                                ("column 3", "m/(s^2)")]  # fmt: skip
    assert "the columns are named by their" in " ".join(found.notices)


def test_units_in_brackets_leave_the_name():
    assert split_head("Speed (km/h)") == ("Speed", "km/h") and split_head("Accel X [g]") == ("Accel X", "g")
    assert split_head("Acceleration Sensor(Total)(g)") == ("Acceleration Sensor(Total)", "g")


@pytest.mark.parametrize(
    ("name", "heads", "rate", "values"),
    [
        (
            "racechrono.csv",
            [("timestamp", "unix time", ""), ("lap_number", "", ""), ("speed", "m/s", "100: gps"),
             ("lateral_acc", "G", "calc"), ("speed", "m/s", "200: canbus")],
            20.0, [10.25, 10.5, 10.75, 11.0, 11.25],
        ),
        (
            "shimmer.csv",
            [("Shimmer_9DD4_Accel_LN_X_CAL", "m/(s^2)", ""), ("Shimmer_9DD4_Gyro_Z_CAL", "deg/s", "")],
            500.0, np.arange(8) - 3.0,
        ),
        (
            "shimmer_old.dat",
            [("Accelerometer X", "m/(sec^2)", "Shimmer CAL"), ("Accelerometer Y", "m/(sec^2)", "Shimmer CAL")],
            50.0, -0.5 * np.arange(8),
        ),
        (
            "motec.csv",
            [("Damper Pos FL", "mm", ""), ("G Force Vert", "G", ""), ("Engine RPM", "rpm", "")],
            50.0, 3000.0 + np.arange(8),
        ),
        (
            "androsensor.csv",
            [("ACCELEROMETER X", "m/s²", ""), ("ACCELEROMETER Z", "m/s²", ""), ("LIGHT", "lux", "")],
            200.0, np.arange(8.0),
        ),
        (
            "torque.csv",
            [("Longitude", "", ""), ("Acceleration Sensor(Total)", "g", ""), ("Speed (OBD)", "km/h", ""),
             ("Mass Air Flow Rate", "g/s", "")],
            1.0, np.full(8, 16.5),
        ),
        ("one.lvm", [("Excitation", "Newtons", ""), ("Response", "m/s^2", "")], 25600.0, 1.0 + np.arange(6)),
    ],
)  # fmt: skip
def test_names_units_sources_rates_and_values(tmp_path, name, heads, rate, values):
    found = read(tmp_path, TEXTS[name], name)
    assert [(one.name, one.unit, one.place) for one in found.channels] == heads
    assert all(one.rate == pytest.approx(rate, rel=1e-6) for one in found.channels)
    np.testing.assert_allclose(found.channels[-1].values, values)


def test_starts_programs_and_what_is_left_out(tmp_path):
    assert read(tmp_path, TEXTS["racechrono.csv"]).start == "2026-02-09T19:20:02.050+00:00"
    assert read(tmp_path, TEXTS["androsensor.csv"]).start == "2014-05-13 14:08:14:600"
    torque = read(tmp_path, TEXTS["torque.csv"])
    assert torque.start == "21-Aug-2012 18:20:20.500" and "ignored: 'GPS Time'" in " ".join(torque.notices)
    assert torque.channels[-1].si_unit == ""  # g/s is a flow of grams, no acceleration over time
    lvm = read(tmp_path, LVM, "x.lvm")
    assert lvm.start == "2013/02/19 09:51:40,5" and "comments behind rows are ignored" in lvm.notices


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("id,t [s],a\nACC,0.0,1.5\nGYR,0.1,2.5\nACC,0.2,1.5\nGYR,0.3,2.5\n" * 1 + "ACC,0.4,1\n" * 1 + "GYR,0.5,1\n" * 1,
         "column 'id' alternates between 'ACC', 'GYR'"),
        ("a,b,c,d\n" + "0.5,1.5,2.5\n" * 8, "4 names for 3 columns"),
        (clock_file("iso").replace("10:00:00.050Z", "later"), r"log.csv:7:1: column 'time' has the cell '2026-03-01Tl"),
    ],
)  # fmt: skip
def test_what_cannot_be_known_is_refused(tmp_path, text, said):
    with pytest.raises(DataError, match=said):
        read(tmp_path, text)


def test_a_rate_above_a_table_without_times_is_named_and_not_used(tmp_path):
    found = read(tmp_path, "# Config: data_rate = 2000.0 Hz\ncount,a_x\n" + "".join(f"{n},0.{n}\n" for n in range(9)))
    assert [one.rate for one in found.channels] == [None, None]
    assert "set --rate 2000.0" in " ".join(found.notices)
    with pytest.raises(DataError, match="has no times; set --rate HZ"):
        choose(found, Choice(channels={"fr": "a_x"}, units={"fr": "g"}))


def test_segments_of_labview_follow_their_clocks(tmp_path):
    (channel,) = read(tmp_path, lvm_segments("10:00:05.0"), "x.lvm").channels
    np.testing.assert_allclose(channel.axis, [0.0, 0.01, 0.02, 0.03, 5.0, 5.01, 5.02, 5.03], atol=1e-9)
    np.testing.assert_allclose(channel.values, [0.5, 1.5, 2.5, 3.5, 10.5, 11.5, 12.5, 13.5])
    with pytest.raises(DataError, match=r"segment 2 begins 0\.03 s before the end of segment 1"):
        read(tmp_path, lvm_segments("10:00:00.0"), "x.lvm")
    (channel,) = read(tmp_path, lvm_segments("10:00:05.0", "No"), "x.lvm").channels
    assert channel.axis is not None and channel.axis[4] == pytest.approx(5.0)


def test_packets_of_labview_without_times_between_them_have_no_rate(tmp_path):
    (one, _) = read(tmp_path, LVM.replace("Samples\t6\t6", "Samples\t3\t3"), "x.lvm").channels
    assert one.rate is None and "packets of 3 samples" in one.remark and "set --rate 25600" in one.remark
    (one, _) = read(tmp_path, LVM.replace("3,906250E-5", "0,000977"), "x.lvm").channels
    assert one.rate == 1024.0 and "the sampling rate is assumed to" in one.remark
    (one, _) = read(tmp_path, LVM.replace("3,906250E-5", "0,000500"), "x.lvm").channels
    assert one.rate == 2000.0 and "the sampling rate is 2000 Hz +- 0.1 %" in one.remark


DAMAGED = {
    "x.lvm": (LVM, [
        ("Channels\t2", "Channels\t5", "2 names for 5 channels"),
        ("X_Columns\tNo", "X_Columns\tTwo", "X_Columns is 'Two'"),
        ("0,500000", "0.500000", "decimal points and decimal commas"),
        ("***End_of_Header***\t\t\t", "", "no rows of numbers"),
        ("1,000000\t3,000000", "1,000000", "2 cells for 3 columns"),
    ]),
    "x.vbo": (VBO, [
        ("235959.90", "237959.90", r"x.vbo:26: 237959.9 "),
        ("235959.90", "inf", r"x.vbo:26: inf "),
        ("[data]", "[dat]", "0 rows"),
        (" +0.1000 +1.00", "", "7 cells, .* 9"),
    ]),
}  # fmt: skip


@pytest.mark.parametrize(
    ("name", "text", "old", "new", "said"),
    [(name, text, *row) for name, (text, rows) in DAMAGED.items() for row in rows],
)
def test_damaged_files_are_refused(tmp_path, name, text, old, new, said):
    assert old in text
    with pytest.raises(DataError, match=said):
        read(tmp_path, text.replace(old, new), name)


def test_vbox_over_midnight(tmp_path):
    found = read(tmp_path, VBO, "x.vbo", "cp1252")
    heads = {one.name: (one.unit, one.si_unit) for one in found.channels}
    assert heads["velocity"] == ("kmh", "m/s") and heads["longacc"] == ("g", "m/s2")
    assert heads["Yaw_Rate"] == ("deg/s", "rad/s") and heads["lat"] == ("arcmin", "rad") and heads["sats"] == ("", "")
    speed = next(one for one in found.channels if one.name == "velocity")
    np.testing.assert_allclose(speed.axis, 0.1 * np.arange(5), atol=1e-9)
    np.testing.assert_allclose(speed.si_values, (36.0 + np.arange(5)) / 3.6)
    assert found.start == "31/07/2006 23:59:59.80 UTC" and "passes midnight" in " ".join(found.notices)
    longitude = next(one for one in found.channels if one.name == "long")
    assert longitude.remark == "positive to the west" and longitude.si_values[0] == pytest.approx(
        math.radians(58.49277 / 60.0)
    )


def test_units_of_vbox_that_fit_no_columns_are_not_used(tmp_path):
    found = read(tmp_path, VBO.replace("g\ndeg/s\n", "g\n\ndeg/s\nV\n").replace("long accel g", "x"), "x.vbo")
    assert next(one for one in found.channels if one.name == "Yaw_Rate").unit == ""
    assert "cannot be assigned, so no unit is used: g, -, deg/s, V; set --unit" in " ".join(found.notices)
