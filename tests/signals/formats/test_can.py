"""Frames of CAN buses: one decoder for every container, sources apart, no line dropped without a word."""

import random
import re

import numpy as np
import pytest

from tests.failing_inputs import SEAT as SEAT_Z
from tests.failing_inputs import WITH_VALUES, comfort_of_seat, made
from tests.signals.formats.can_logs import CONTAINERS, Frame, asc, mf4, write_log
from tests.signals.formats.channel_times import times
from tests.validation import validated
from vehicle.commands.comfort import main as comfort
from vehicle.errors import DataError
from vehicle.signals.formats.can_decoder import load_database, raw_values
from vehicle.signals.formats.reader import read_record
from vehicle.signals.records.choice import Choice
from vehicle.signals.records.record_comfort import evaluate_comfort

pytest.importorskip("asammdf")

SEAT = {"x": "Seat_X", "y": "Seat_Y", "z": "Seat_Z"}

DBC = """VERSION ""
BU_: ECU
BO_ 256 IMU: 8 ECU
 SG_ Z : 0|16@1- (0.05,-1) [-1000|1000] "m/s2" ECU
 SG_ State : 16|4@1+ (1,0) [0|15] "" ECU
 SG_ Y : 39|12@0- (0.01,0) [0|0] "m/s2" ECU
BO_ 2147484160 Wide: 24 ECU
 SG_ Far : 160|16@1+ (0.5,0) [0|0] "mm" ECU
VAL_ 256 Z 32767 "SNA" 7 "NoError" 0 "standstill" -20001 "Overrun" ;
VAL_ 256 State 0 "off" 1 "error" ;
"""


def weighted(path, channels):
    choice = Choice(channels=channels, databases=(path.parent / "car.dbc",))
    return evaluate_comfort(path, choice=choice).weighted_rms


def test_a_value_table_names_raw_values_and_keeps_factor_and_offset(tmp_path):
    path = made("one_bus.log", tmp_path)
    plain = weighted(path, SEAT)
    (tmp_path / "car.dbc").write_text(WITH_VALUES)
    with_table = weighted(path, SEAT)
    assert with_table == plain
    validated(
        "File readers", "weighted RMS along z of a CAN log whose database has a value table", with_table["z"],
        comfort_of_seat(tmp_path), rel=1e-9, unit="m/s2",
        source="second derivation: the record from which the log was made",
    )  # fmt: skip


def test_two_buses_are_two_channels(tmp_path, capsys):
    path = made("two_buses.log", tmp_path)
    first = weighted(path, {axis: f"{name} can0" for axis, name in SEAT.items()})
    assert first["z"] == pytest.approx(comfort_of_seat(tmp_path), rel=1e-9)
    channels = {one.name: one for one in read_record(path, [tmp_path / "car.dbc"]).channels}
    for factor, bus in ((1, "can0"), (10, "can1")):
        np.testing.assert_allclose(channels[f"Seat_Z {bus}"].values, factor * SEAT_Z, atol=1e-12)
    assert comfort(["--input", str(path), "--dbc", str(tmp_path / "car.dbc"), "--channel", "z=Seat_Z"]) == 3
    assert "'Seat_Z can0'" in (said := capsys.readouterr().err) and "'Seat_Z can1'" in said


def test_frames_of_can_fd_are_read(tmp_path):
    found = read_record(made("fd.log", tmp_path), [tmp_path / "car.dbc"])
    channels = {one.name: one for one in found.channels}
    np.testing.assert_array_equal(channels["Seat_Z"].values, channels["Seat_X"].values)
    assert channels["Seat_Z"].values.size == 750 and channels["Seat_Z"].rate == pytest.approx(100.0)
    assert "log of a CAN bus: 1500 frames, 1500 decoded by car.dbc" in found.notices


def frames(classic):
    """Frames of two buses, Rx and Tx; classic: without CAN FD."""
    made = []
    for n in range(40):
        z, y = (n - 20) * 7, (n - 20) * 5
        for bus, way, factor in ((1, "Rx", 1), (2, "Rx", 10), (1, "Tx", -1)):
            bits = (factor * y & 0xFFF) << 12  # 12 bits from bit 7 of byte 4
            data = (factor * z & 0xFFFF).to_bytes(2, "little") + bytes([n % 3, 0]) + bits.to_bytes(3, "big") + b"\0"
            made.append(Frame(0.01 * n + 0.001 * bus, bus, way, 0x100, False, data))
        if not classic:
            data = bytes(20) + (2 * n).to_bytes(2, "little") + bytes(2)
            made.append(Frame(0.01 * n + 0.005, 1, "Rx", 0x200, True, data))
    return sorted(made)


@pytest.mark.parametrize("name", CONTAINERS)
def test_every_container_gives_the_same_channels(tmp_path, name):
    """Two buses, Rx and Tx, bits across bytes, a value table, CAN FD where the container has it."""
    database = tmp_path / "car.dbc"
    database.write_text(DBC)
    classic = name in ("1.0.trc", "1.1.trc", "1.3.trc")
    buses = ("can0", "can1") if "log" in name else ("CAN1", "CAN2")
    sent = frames(classic)
    if name in ("1.0.trc", "1.1.trc", "2.0.trc"):  # without bus
        sent = [one for one in sent if one.bus == 1]
    if name == "1.0.trc":  # without direction
        sent = [one for one in sent if one.way == "Rx"]
    found = read_record(write_log(tmp_path, name, sent), [database])
    channels = {one.name: one for one in found.channels}
    z, y, first = 0.35 * (np.arange(40) - 20), 0.05 * (np.arange(40) - 20), {"raw.mf4": 0.001}.get(name, 0.0)
    suffixes = {"1.0.trc": {"": 1}, "1.1.trc": {" Rx": 1, " Tx": -1}, "2.0.trc": {" Rx": 1, " Tx": -1}}.get(
        name, {f" {buses[0]} Rx": 1, f" {buses[0]} Tx": -1, f" {buses[1]} Rx": 10}
    )
    for suffix, factor in suffixes.items():
        np.testing.assert_allclose(channels[f"Z{suffix}"].values, factor * z - 1.0, atol=1e-12)
        np.testing.assert_allclose(channels[f"Y{suffix}"].values, factor * y, atol=1e-12)
        begin = first + 0.001 * (factor == 10)
        np.testing.assert_allclose(times(channels[f"Z{suffix}"]), begin + 0.01 * np.arange(40), atol=2e-6)
    if not classic:
        np.testing.assert_allclose(channels["Far"].values, np.arange(40.0))
    assert len(channels) == 3 * len(suffixes) + (not classic)
    assert f"log of a CAN bus: {len(sent)} frames, {len(sent)} decoded by car.dbc" in found.notices


def test_fields_of_frames_that_are_constant(tmp_path):
    """A logger stores a constant bus or direction as a virtual channel: a count of the frames with a conversion."""
    database, path = tmp_path / "car.dbc", tmp_path / "raw.mf4"
    database.write_text(DBC)
    sent = [one for one in frames(True) if (one.bus, one.way) == (1, "Rx")]
    mf4(path, sent, constant=("BusChannel", "Dir", "IDE"))
    channels = {one.name: one for one in read_record(path, [database]).channels}
    assert channels["Z"].values.size == len(sent)


def test_raw_numbers_of_any_position_size_and_byte_order(tmp_path):
    """Against integers of the whole payload: start bit and size cut a number out of it."""
    rng = random.Random(5)
    lines, expected, payloads = ['VERSION ""', "BU_: ECU"], [], []
    for number in range(200):
        size, little, signed = rng.choice((6, 8, 16)), rng.random() < 0.5, rng.random() < 0.5
        bits = rng.randint(1, min(64, 8 * size))
        first = rng.randint(0, 8 * size - bits)
        start = first if little else 8 * (first // 8) + 7 - first % 8
        data = bytes(rng.randrange(256) for _ in range(size))
        whole = int.from_bytes(data, "little" if little else "big")
        value = (whole >> first if little else whole >> (8 * size - first - bits)) & (1 << bits) - 1
        expected.append(value - (1 << bits) if signed and value >> bits - 1 else value)
        payloads.append(data)
        lines += [f"BO_ {number + 1} M{number}: {size} ECU",
                  f' SG_ S : {start}|{bits}@{int(little)}{"-" if signed else "+"} (1,0) [0|0] "" ECU']  # fmt: skip
    path = tmp_path / "random.dbc"
    path.write_text("\n".join(lines) + "\n")
    database = load_database(path)
    found = [int(raw_values(message.signals[0], np.frombuffer(data, np.uint8)[np.newaxis])[0])
             for message, data in zip(database.frames, payloads, strict=True)]  # fmt: skip
    validated(
        "File readers", "numbers of 1 to 64 bits in payloads of CAN, Intel and Motorola, 200 random positions",
        sum(one != other for one, other in zip(found, expected, strict=True)), 0, abs=0.0, unit="errors",
        source="second derivation: shift of the payload as one integer",
    )  # fmt: skip


def decode(tmp_path, database, sent, name="log.log"):
    (tmp_path / "car.dbc").write_text(database)
    path = tmp_path / name
    write_log(tmp_path, "candump.log", sent).rename(path)
    return read_record(path, [tmp_path / "car.dbc"])


def test_named_values_that_are_no_measured_values_are_missing(tmp_path):
    raw = [5, 32767, 0, 45535, 7]  # SNA; standstill, a value; Overrun, outside of the stated range
    sent = [Frame(0.01 * n, 1, "Rx", 0x100, False, value.to_bytes(2, "little") + bytes([1]) + bytes(5))
            for n, value in enumerate(raw)]  # fmt: skip
    found = decode(tmp_path, DBC, sent)
    channels = {one.name: one for one in found.channels}
    np.testing.assert_allclose(channels["Z"].values, [-0.75, np.nan, -1.0, np.nan, -0.65])
    np.testing.assert_array_equal(channels["State"].values, np.ones(5))  # a state is its number
    assert "IMU.Z: values named 'SNA' are read as missing: 1" in found.notices
    assert "IMU.Z: values named 'Overrun' are read as missing: 1" in found.notices


J1939 = f"""VERSION ""
BU_: ECU
BO_ {0x80000000 | 0x18FF00FE} EEC: 8 ECU
 SG_ Speed : 24|16@1+ (0.125,0) [0|8031.875] "rpm" ECU
BO_ {0x80000000 | 0x18EF25FE} Ask: 8 ECU
 SG_ Torque : 0|8@1+ (1,-125) [-125|125] "%" ECU
BA_DEF_ "ProtocolType" STRING ;
BA_DEF_DEF_ "ProtocolType" "";
BA_ "ProtocolType" "J1939";
"""
"""PGN 0xFF00 (PDU2) and 0xEF00 (PDU1, to a destination), for any source address (0xFE)."""


def test_messages_of_j1939_are_found_by_their_group(tmp_path):
    (tmp_path / "car.dbc").write_text(J1939)
    groups = {message.name: message.arbitration_id.id for message in load_database(tmp_path / "car.dbc").frames}
    assert {name: f"{number:X}" for name, number in groups.items()} == {"EEC": "18FF00FE", "Ask": "18EF25FE"}
    word = [bytes(3) + value.to_bytes(2, "little") + bytes(3) for value in (800, 0xFFFF, 1600)]
    sent = [Frame(0.01 * n, 1, "Rx", 0x0CFF0021, True, data) for n, data in enumerate(word)]
    found = decode(tmp_path, J1939, sent)
    (speed,) = found.channels
    np.testing.assert_allclose(speed.values, [100.0, np.nan, 200.0])
    assert (speed.name, speed.place) == ("Speed", "EEC 0xCFF0021")
    assert "EEC.Speed: values above the valid range of J1939 are read as missing: 1" in found.notices
    sent += [Frame(0.02 + 0.01 * n, 1, "Rx", 0x0CFF0022, True, data) for n, data in enumerate(word)]
    sent += [Frame(0.1, 1, "Rx", 0x18EF9933, True, bytes([130]) + bytes(7))]  # to another destination
    sent += [Frame(0.2, 1, "Rx", 0x18FE0133, True, bytes(8))]
    found = decode(tmp_path, J1939, sent)
    assert [one.name for one in found.channels] == ["Speed 0xCFF0021", "Speed 0xCFF0022", "Torque"]
    assert found.channels[2].values.tolist() == [5.0]
    assert "car.dbc does not describe 1 frames of 1 messages, which are left out: 0x18FE0133" in found.notices
    plain = J1939.replace('BA_ "ProtocolType" "J1939";', "")
    with pytest.raises(DataError, match="none of the messages"):  # other extended identifiers are exact
        decode(tmp_path, plain, sent)


MULTIPLEXED = """VERSION ""
BU_: ECU
BO_ 256 Mux: 4 ECU
 SG_ Page M : 0|8@1+ (1,0) [0|255] "" ECU
 SG_ A m0 : 8|8@1+ (0.5,0) [0|0] "m" ECU
 SG_ B m1 : 8|8@1+ (2,0) [0|0] "m" ECU
 SG_ C m1 : 24|8@1+ (1,0) [0|0] "m" ECU
SG_MUL_VAL_ 256 A Page 0-0, 4-5 ;
"""


def test_a_multiplexed_signal_has_the_frames_of_all_its_pages(tmp_path):
    pages = [0, 1, 4, 5, 6, 1]
    sent = [Frame(0.01 * n, 1, "Rx", 0x100, False, bytes([page, 10 * n])) for n, page in enumerate(pages)]
    found = decode(tmp_path, MULTIPLEXED, sent)
    channels = {one.name: one for one in found.channels}
    np.testing.assert_allclose(channels["A"].values, [0.0, 10.0, 15.0])
    np.testing.assert_allclose(times(channels["A"]), [0.0, 0.02, 0.03], atol=1e-6)
    np.testing.assert_allclose(channels["B"].values, [20.0, 100.0])
    assert "C" not in channels  # its byte is in no frame


def test_short_frames_are_counted_and_not_padded(tmp_path):
    sent = [Frame(0.01 * n, 1, "Rx", 0x100, False, bytes([20, 0, 1] + [0] * (0 if n == 2 else 5))) for n in range(4)]
    found = decode(tmp_path, DBC, sent)
    channels = {one.name: one for one in found.channels}
    assert (channels["Z"].values.size, channels["Y"].values.size) == (4, 3)
    assert "frames of IMU too short for Y: 1" in found.notices


def test_lines_without_a_data_frame_are_counted_by_form(tmp_path):
    (tmp_path / "car.dbc").write_text(DBC)
    sent = [Frame(0.01 * n, 1, "Rx", 0x100, False, bytes(8)) for n in range(3)]
    other = ["   0.011000 1  ErrorFrame", "   0.012000 1  100             Rx   r 8", "   0.013000 CAN 1 Status:chip",
             "   0.014000 1  Statistic: D 0 R 0 XD 0", "   0.015000 1  100             TxRq d 1 00",
             "   0.016000 1  IMU_data        Rx   d 1 00", "   0.017000 1  100             Rx   d 8 00 01"]  # fmt: skip
    path = tmp_path / "bus.asc"
    path.write_text(asc(sent).replace("End TriggerBlock", "\n".join(other)))
    found = read_record(path, [tmp_path / "car.dbc"])
    (notice,) = [text for text in found.notices if "without a data frame" in text]
    assert notice.startswith("7 lines without a data frame are left out")
    for form in ("error frame", "remote frame", "CAN", "Statistic:", "TxRq", "frame with a symbolic name",
                 "data frame with too few bytes"):  # fmt: skip
        assert f"'{form}' 1" in notice
    dump = tmp_path / "bus.log"
    dump.write_text("(1.000000) can0 123#R\n(1.100000) can0 20000080#0000000000000000\n(1.2) can0 1F#00\n")
    with pytest.raises(DataError, match=r"'remote frame' 1, 'error frame' 1, '\(1.2\) can0"):
        read_record(dump, [tmp_path / "car.dbc"])


def test_relative_times_count_from_any_event(tmp_path):
    (tmp_path / "car.dbc").write_text(DBC)
    sent = [Frame(0.02 * n, 1, "Rx", 0x100, False, bytes(8)) for n in range(5)]
    text = re.sub(
        r"(?m)^   0\.020000 1  ", "   0.010000 1  Statistic: D 0\n   0.010000 1  ", asc(sent, times="relative")
    )
    path = tmp_path / "bus.asc"
    path.write_text(text)
    channels = {one.name: one for one in read_record(path, [tmp_path / "car.dbc"]).channels}
    np.testing.assert_allclose(times(channels["Z"]), 0.02 * np.arange(5), atol=1e-9)
