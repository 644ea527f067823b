"""Files of kinds that once gave wrong numbers without a word; each test that reads one makes it.

All contain the same made-up seat acceleration, in counts of 0.05 m/s2 where a file stores integers.
"""

from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
import pytest

from vehicle.signals.records.choice import Choice
from vehicle.signals.records.record_comfort import evaluate_comfort

RATE = 100.0
TIME = np.arange(3000) / RATE
COUNTS = np.round(
    np.random.default_rng(57).normal(0.0, 0.2, (3000, 3)) / 0.05
    + 12.0 * np.sin(2.0 * np.pi * np.outer(TIME, (1.3, 2.9, 4.7)))
).astype(np.int16)
"""Seat acceleration along x, y and z in counts, (3000, 3)."""

SEAT = 0.05 * COUNTS[:, 2]
"""Seat acceleration along z [m/s2], (3000,)."""

LONGER = 1e-4 * np.sin(2.0 * np.pi * np.outer(np.arange(3025) / RATE, (0.7, 2.3, 5.9, 11.0))).sum(axis=1)
PLATE = LONGER[:3000]
"""Displacement of a plate [m], (3000,)."""

IMU = """VERSION ""
BU_: ECU
BO_ 256 IMU: 6 ECU
 SG_ Seat_X : 0|16@1- (0.05,0) [-30|30] "m/s2" ECU
 SG_ Seat_Y : 16|16@1- (0.05,0) [-30|30] "m/s2" ECU
 SG_ Seat_Z : 32|16@1- (0.05,0) [-30|30] "m/s2" ECU
"""
WITH_VALUES = IMU + 'VAL_ 256 Seat_Z 32767 "SNA" ;\n'
FD = """VERSION ""
BU_: ECU
BO_ 256 A: 8 ECU
 SG_ Seat_X : 0|16@1- (0.05,0) [-30|30] "m/s2" ECU
BO_ 512 B: 16 ECU
 SG_ Seat_Z : 64|16@1- (0.05,0) [-30|30] "m/s2" ECU
"""


def _table(path: Path, heads: str, columns: list[np.ndarray], form: str = "%.5f") -> None:
    np.savetxt(path, np.column_stack(columns), form, ",", header=heads, comments="")


def _frames(path: Path, factors: Iterable[int]) -> None:
    """Frames of a bus for each factor of the counts, 5 ms apart."""
    lines = [
        (1.7e9 + time + 0.005 * bus, f"can{bus} 100#{(factor * counts).astype('<i2').tobytes().hex().upper()}")
        for bus, factor in enumerate(factors)
        for time, counts in zip(TIME, COUNTS, strict=True)
    ]
    path.write_text("".join(f"({time:.6f}) {text}\n" for time, text in sorted(lines)))


def _fd(path: Path) -> None:
    """A classic frame and one of CAN FD with the same number, 750 times."""
    numbers = [int(value).to_bytes(2, "little", signed=True).hex().upper() for value in COUNTS[:750, 2]]
    path.write_text(
        "".join(
            f"({1.7e9 + time:.6f}) can0 100#{number}{'00' * 6}\n"
            f"({1.7e9 + time + 0.001:.6f}) can0 200##1{'00' * 8}{number}{'00' * 6}\n"
            for time, number in zip(TIME, numbers, strict=False)
        )
    )


def _packed(path: Path) -> None:
    with pytest.importorskip("h5py").File(path, "w") as file:
        file["time"], file["seat_z"] = TIME, COUNTS[:, 2]
        file["time"].attrs["units"] = "s"
        file["seat_z"].attrs.update({"units": "m/s2", "scale_factor": 0.05, "add_offset": 0.0})


def _start_apart(path: Path) -> None:
    """The second channel is the second difference of the plate, from a quarter of a second on."""
    nptdms, begin = pytest.importorskip("nptdms"), np.datetime64("2026-11-26T10:00:00")
    acceleration = np.gradient(np.gradient(LONGER, 0.01), 0.01)[25:]
    channels = (("Plate FL", 0, "m", PLATE), ("Plate FL acceleration", 250, "m/s^2", acceleration))
    with nptdms.TdmsWriter(path) as writer:
        writer.write_segment([
            nptdms.ChannelObject("g", name, values,
                                 properties={"wf_start_time": begin + np.timedelta64(later, "ms"), "wf_increment": 0.01,
                                             "wf_start_offset": 0.0, "unit_string": unit})
            for name, later, unit, values in channels
        ])  # fmt: skip


def _distance(path: Path) -> None:
    """An MDF 4 group whose master is a distance, 0.02 m apart."""
    asammdf = pytest.importorskip("asammdf")
    with asammdf.MDF(version="4.10") as file:
        over = asammdf.Signal(
            PLATE, 0.02 * np.arange(3000), name="height_left", unit="m", master_metadata=("distance", 3)
        )
        file.append([over])
        file.groups[0].channels[0].unit = "m"
        file.save(path, overwrite=True)


def _height(path: Path) -> None:
    """The altitude of a receiver beside its velocity."""
    heads = ("satellites", "time", "latitude", "longitude", "velocity kmh", "heading", "height")
    stamps = [f"1010{second // 20:02d}.{50 * (second % 20):03d}" for second in range(1199)]
    rows = [
        f"012 {stamp} +03119.09973 +00058.31256 {80.0 + 0.1 * np.sin(0.02 * n):07.3f} 180.00 {120.5 + PLATE[n]:+08.2f}"
        for n, stamp in enumerate(stamps)
    ]
    names = "sats time lat long velocity heading height"
    path.write_text("\n".join(["File created on 26/11/2026 at 10:10:00", "", "[header]", *heads, "", "[comments]", "",
                               "[column names]", names, "", "[data]", *rows, ""]))  # fmt: skip


def _events(path: Path, *marks: str) -> None:
    """Rows with a column of events that only a few rows have."""
    remarks = dict(zip((0, 893), marks, strict=False))
    head = ["Header Size:  7", "Version:  2", "Sampling Interval:  0.01", "Sampling Rate:  100", "Sample Count:  1500",
            "Device Serial Number:  0", "Sample Number, Date/Time, Seat Z (m/s2), Plate (mm), Events"]  # fmt: skip
    rows = [
        f"{n + 1:10d},   04/29/2026 11:59:{TIME[n]:06.3f} AM, {SEAT[n]:.4f}, {1e3 * PLATE[n]:.4f}"
        + (f", {remarks[n]}" if n in remarks else "")
        for n in range(1500)
    ]
    path.write_text("\n".join([*head, *rows, ""]))


def _testlab(path: Path) -> None:
    from scipy.io import savemat

    quantity = {"label": "g", "unit_transformation": {"factor": 0.1019716213, "offset": 0.0, "log_reference": 1.0}}
    clock = {"start_value": 0.0, "increment": 0.01, "number_of_values": 3000.0, "quantity": {"label": "s"}}
    record = {"name": "Seat:+Z", "type": "Time"}
    values = {"values": SEAT[:, None], "quantity": quantity}
    savemat(path, {"Signal": {"x_values": clock, "y_values": values, "function_record": record}})


def _simulink(path: Path) -> None:
    from scipy.io import savemat

    signals = {"values": np.column_stack([SEAT, PLATE]), "dimensions": 2.0, "label": "Seat z, plate"}
    savemat(path, {"ScopeData": {"time": TIME, "signals": signals}})


def _formula(path: Path) -> None:
    book = pytest.importorskip("openpyxl").Workbook()
    book.active.append(["t [s]", "raw", "Seat z [m/s2]"])
    for n in range(1500):
        book.active.append([TIME[n], SEAT[n], f"=B{n + 2}*9.81"])
    book.save(path)


def _long_name(path: Path) -> None:
    """A point of 15 letters, which shifts the columns of its record."""
    rows = [" ".join(f"{value:12.5e}" for value in SEAT[n : n + 6]) for n in range(0, 1500, 6)]
    head = ["    -1", "    58", "SeatZ", "NONE", "26-Nov-26 10:00:00", "id4", "NONE",
            "    1         0    1         0 PF-I-0301z+seat        12   3 NONE               0   0",
            "         2      1500         1  0.00000e+00  1.00000e-02  0.00000e+00",
            "        17    0    0    0 Time                 s                   ",
            "        12    0    0    0 Acceleration         m/s2                ",
            *["         0    0    0    0 NONE                 NONE                "] * 2]  # fmt: skip
    path.write_text("\n".join([*head, *(f" {row}" for row in rows), "    -1", ""]))


MAKERS: dict[str, Callable[[Path], None]] = {
    "one_bus.log": lambda path: _frames(path, (1,)),
    "two_buses.log": lambda path: _frames(path, (1, 10)),
    "fd.log": _fd,
    "packed.nc": _packed,
    "channels_start_apart.tdms": _start_apart,
    "master_distance.mf4": _distance,
    "gps_height.vbo": _height,
    "events_column.txt": lambda path: _events(path, "DAQ Start"),
    "events_column_marker.txt": lambda path: _events(path, "DAQ Start", "Marker"),
    "testlab_g.mat": _testlab,
    "simulink_two_columns.mat": _simulink,
    "formula_without_value.xlsx": _formula,
    "long_entity_name.unv": _long_name,
    "stamps_alternate.csv": lambda path: _table(
        path, "Time [s],Seat Z [m/s2]", [np.repeat(TIME[::2], 2) + np.tile([0.0, 0.016], 1500), SEAT], "%.3f"
    ),
    "stamps_in_batches.csv": lambda path: _table(
        path, "Time [s],Seat Z [m/s2]", [np.repeat(TIME[::20], 20), SEAT], "%.3f"
    ),
}
"""Name of a file to the function that makes it."""

DATABASES = {"one_bus.log": IMU, "two_buses.log": IMU, "fd.log": FD}
"""Log of a bus to its database."""


def made(name: str, folder: Path) -> Path:
    """Make a file of `MAKERS` in a folder, with the database `car.dbc` of a log, and return its path."""
    path = folder / name
    MAKERS[name](path)
    if name in DATABASES:
        (folder / "car.dbc").write_text(DATABASES[name])
    return path


def comfort_of_seat(folder: Path) -> float:
    """Return the weighted RMS of `SEAT` along z [m/s2], from a plain text file."""
    path = folder / "seat.csv"
    _table(path, "time [s],z [m/s2]", [TIME, SEAT])
    return evaluate_comfort(path, choice=Choice(channels={"z": "z"})).weighted_rms["z"]
