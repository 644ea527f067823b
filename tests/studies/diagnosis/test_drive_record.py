"""Parts of a record that a diagnosis uses: steady, straight on, without single obstacles."""

from dataclasses import replace

import numpy as np
import pytest
import scipy

from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.records.choice import Choice
from vehicle.studies.diagnosis.drive_record import DriveRecord, read_drive, usable_parts

RATE = 200.0
CHANNELS = ("seat_rail_acc_x", "seat_rail_acc_z")


def record(seconds=40.0, **changes):
    rng = np.random.default_rng(5)
    samples = scipy.signal.sosfilt(
        scipy.signal.butter(2, 30.0, fs=RATE, output="sos"), rng.standard_normal((2, int(seconds * RATE)))
    )
    whole = DriveRecord(name="drive", channels=CHANNELS, samples=samples, rate=RATE, highest=80.0, speeds=(20.0, 20.0))
    return replace(whole, **changes)


def test_a_steady_drive_is_used_whole():
    parts = usable_parts(record())
    assert parts.seconds == pytest.approx(40.0)
    assert not parts.left_out


def test_no_more_than_a_minute_is_used():
    assert usable_parts(record(100.0)).seconds == pytest.approx(60.0, abs=0.01)


def changed(change):
    samples = record().samples.copy()
    change(samples, np.arange(samples.shape[1]) / RATE)
    return record(samples=samples)


def braking(samples, time):
    samples[0] -= 3.0 * ((time > 20.0) & (time < 24.0))


def obstacle(samples, time, height=12.0):
    samples += height * np.exp(-(((time - 10.0) / 0.03) ** 2)) * np.cos(2.0 * np.pi * 12.0 * (time - 10.0))


def small_obstacle(samples, time):
    # Its peak is 7 times the RMS of its window, but the RMS of its second only 1.6 times the median.
    obstacle(samples, time, 4.5)


def standstill(samples, time):
    samples[:, time > 30.0] *= 0.02


@pytest.mark.parametrize(
    ("change", "reason", "least", "most"),
    [(braking, "braking or cornering", 4.0, 8.0), (obstacle, "single obstacles", 0.5, 5.0),
     (small_obstacle, "single obstacles", 0.5, 5.0),
     (standstill, "standstill", 8.5, 10.5)],
)  # fmt: skip
def test_other_parts_are_left_out_by_name(change, reason, least, most):
    parts = usable_parts(changed(change))
    assert least <= parts.left_out[reason] <= most
    assert parts.seconds == pytest.approx(40.0 - sum(parts.left_out.values()), abs=4.0)


def test_the_usual_speed_is_that_of_the_longest_time():
    speed = np.where(np.arange(int(40 * RATE)) < 10 * RATE, 14.0, 22.0)
    parts = usable_parts(record(speed=speed))
    assert parts.speeds == pytest.approx((22.0, 22.0))
    assert parts.left_out["another speed"] == pytest.approx(10.0)


def test_a_short_record_is_refused():
    with pytest.raises(DataError, match=r"12 s can be used, but a diagnosis needs 16 s"):
        usable_parts(record(12.0))


def test_files_give_accelerations_and_speed(tmp_path):
    time = np.arange(4000) / RATE
    table = np.column_stack([time, *record(20.0).samples, np.full(4000, 79.2)])
    file = tmp_path / "drive.csv"
    head = "time [s],seat_rail_acc_x [m/s2],seat_rail_acc_z [m/s2],v [km/h]"
    np.savetxt(file, table, delimiter=",", header=head, comments="")
    found = read_drive(file, CHANNELS, "channel:v", Choice())
    assert found.channels == CHANNELS
    assert found.rate == pytest.approx(RATE)
    assert found.speed == pytest.approx(np.full(4000, 22.0))
    assert read_drive(file, CHANNELS, (70.0, 90.0), Choice()).speeds == pytest.approx((70.0 / 3.6, 25.0))
    with pytest.raises(ConfigurationError, match="speed 5 to 5 km/h"):
        read_drive(file, CHANNELS, 5.0, Choice())
    with pytest.raises(DataError, match="no velocity but acceleration"):
        read_drive(file, CHANNELS, "channel:seat_rail_acc_x", Choice())


def test_positions_give_the_speed_and_empty_rows_are_skipped(tmp_path):
    time = np.arange(4000) / RATE
    # A circle of 400 m radius at 22 m/s around 48 deg north: degrees of the meridian and of the parallel there.
    angle = 22.0 * time / 400.0
    latitude, longitude = 48.0 + 400.0 * np.sin(angle) / 111_200.0, 11.0 + 400.0 * np.cos(angle) / 74_630.0
    # A fix each second, rounded to 1e-6 deg (0.1 m).
    cells = [
        f"{a:.6f},{b:.6f}" if k % 200 == 0 else "," for k, (a, b) in enumerate(zip(latitude, longitude, strict=True))
    ]
    file = tmp_path / "phone.csv"
    rows = [
        f"{t:.3f},{x:.6f},{z:.6f},{fix}" for t, (x, z), fix in zip(time, record(20.0).samples.T, cells, strict=True)
    ]
    head = "time [s],seat_rail_acc_x [m/s2],seat_rail_acc_z [m/s2],Latitude [deg],Longitude [deg]"
    file.write_text("\n".join([head, *rows]), encoding="utf-8")
    found = read_drive(file, CHANNELS, "position:Latitude,Longitude", Choice())
    # Chords over 4 s of the circle are shorter by (0.22)^2/24 x 3/5, and a slope errs by 0.03 m / sqrt(10) s.
    assert found.speed == pytest.approx(np.full(4000, 22.0), rel=0.005)
    assert "speed from 20 positions: 79" in found.notices[-1]
    noisy = np.random.default_rng(3).normal(0.0, 5.0 / 111_200.0, 20)
    with pytest.raises(DataError, match=r"the speed is uncertain by 5.\d %, but at most 2 % are allowed"):
        text = file.read_text(encoding="utf-8")
        for fix, error in zip(cells[::200], noisy, strict=True):
            text = text.replace(fix, f"{float(fix.partition(',')[0]) + error:.6f},{fix.partition(',')[2]}")
        file.write_text(text, encoding="utf-8")
        read_drive(file, CHANNELS, "position:Latitude,Longitude", Choice())
    with pytest.raises(DataError, match="is no angle but acceleration"):
        read_drive(file, CHANNELS, "position:Latitude,seat_rail_acc_x", Choice())
    with pytest.raises(ConfigurationError, match="must name two channels"):
        read_drive(file, CHANNELS, "position:Latitude", Choice())
