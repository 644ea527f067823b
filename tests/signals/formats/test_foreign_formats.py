"""MAT, WAV and RPC III: files of the foreign libraries and of this one, and damaged ones."""

import struct

import numpy as np
import pytest
from scipy.io import savemat, wavfile

from tests.validation import foreign, validated
from vehicle.commands.options import read
from vehicle.commands.shaker import parser
from vehicle.errors import DataError
from vehicle.signals.excitation.signal_file import read_signal
from vehicle.signals.formats import matlab_format, rpc_format
from vehicle.signals.formats.channel import Channel, uniform_axis
from vehicle.signals.formats.reader import read_record
from vehicle.signals.records.record_settings import RecordSettings

RATE = 2048.0
TIME = uniform_axis(5000, 1.0 / RATE)
SINE = 2.5 * np.sin(2.0 * np.pi * 6.0 * TIME)
CHANNELS = (
    Channel(name="Shaker FR", values=SINE, unit="mm", axis=TIME),
    Channel(name="Acc 1", values=0.1 * SINE, unit="g", axis=TIME),
)


def signal(path, *options):
    record = read(parser().parse_args(["--input", "x", *options]), RecordSettings)
    return read_signal(path, wheel="fr", choice=record.choice("fr"))


def exported(**quantity):
    """A structure as Testlab exports it."""
    return {
        "x_values": {
            "start_value": 0.0,
            "increment": 1.0 / RATE,
            "number_of_values": 5000.0,
            "quantity": {"label": "s"},
        },
        "y_values": {"values": SINE, "quantity": quantity},
        "function_record": {"name": "Shaker FR"},
    }


def test_structures_of_testlab(tmp_path):
    path = tmp_path / "export.dat"
    with path.open("wb") as file:
        savemat(file, {"Signal": exported(label="mm"), "Fs": RATE})
    found = read_record(path)
    (channel,) = found.channels
    assert (found.format, channel.name, channel.unit, channel.rate) == ("mat", "Shaker FR", "mm", RATE)
    assert "single numbers: Fs = 2048" in found.notices
    validated(
        "File readers", "structure of Testlab in a MAT file, mm", signal(path).displacement["fr"][-2000:],
        1e-3 * SINE[-2000:], rel=1e-12, abs=1e-15, unit="m", source=foreign("scipy", "savemat"),
    )  # fmt: skip
    with path.open("wb") as file:
        savemat(file, {"Signal": exported(label="g", unit_transformation={"factor": 1.0})})
    (channel,) = read_record(path).channels
    assert channel.unit == "" and channel.remark.endswith("its stated factor to SI, 1, contradict each other")


@pytest.mark.parametrize("version", ["4", "5"])
def test_plain_arrays_of_matlab_have_no_unit_and_no_time(tmp_path, version):
    path = tmp_path / "plain.mat"
    savemat(path, {"t": TIME, "data": np.column_stack([SINE, 2.0 * SINE])}, format=version)
    found = read_record(path)
    assert [one.name for one in found.channels] == ["t", "data(:,1)", "data(:,2)"]
    with pytest.raises(DataError, match=r"has no unit; set --unit fr=UNIT"):
        signal(path, "--channel", "fr=data(:,1)", "--rate", "2048")
    with pytest.raises(DataError, match="has no times; set --rate HZ, or the channel of the times with"):
        signal(path, "--channel", "fr=data(:,1)", "--unit", "fr=mm")
    options = ["--channel", "fr=data(:,2)", "--unit", "fr=mm", "--channel", "time=t", "--unit", "time=s"]
    found = signal(path, *options)
    validated(
        "File readers", f"array of a MAT file of version {version}, mm", found.displacement["fr"][-2000:],
        2e-3 * SINE[-2000:], rel=1e-9, abs=1e-14, unit="m", source=foreign("scipy", "savemat"),
    )  # fmt: skip


def test_matlab_4_of_the_other_byte_order(tmp_path):
    path = tmp_path / "old.mat"
    path.write_bytes(struct.pack(">5i", 1000, 4, 1, 0, 2) + b"x\0" + np.arange(4.0).astype(">f8").tobytes())
    (channel,) = read_record(path).channels
    np.testing.assert_array_equal(channel.values, np.arange(4.0))


@pytest.mark.parametrize("kind", [np.uint8, np.int16, np.int32, np.float32])
def test_wav_is_shares_of_full_scale(tmp_path, kind):
    path = tmp_path / "recorder.bin"
    share = SINE / 5.0  # half of full scale
    data = share if kind is np.float32 else share * 128 + 128 if kind is np.uint8 else share * np.iinfo(kind).max
    wavfile.write(path, int(RATE), data.astype(kind))
    with pytest.raises(DataError, match=r"no unit, values are fractions of full scale; .*--unit"):
        signal(path)
    found = signal(path, "--unit", "12.5 mm")
    step = {np.uint8: 1.0 / 128, np.int16: 2.0**-15}.get(kind, 1e-7)
    validated(
        "File readers", f"WAV file of {kind.__name__}", found.displacement["fr"][-2000:], 12.5e-3 * share[-2000:],
        abs=20e-3 * step, unit="m", source=foreign("scipy", "wavfile"),
    )  # fmt: skip
    path.write_bytes(path.read_bytes()[:-200])
    with pytest.raises(DataError, match=r"chunk 'data' states \d+ bytes of data, but the file has"):
        read_record(path)


def test_wav_of_24_bits(tmp_path):
    path = tmp_path / "recorder.wav"
    numbers = np.array([0, 2**22, -(2**23), 2**23 - 1])
    body = b"".join(int(n).to_bytes(3, "little", signed=True) for n in numbers)
    head = struct.pack("<4sIHHIIHH", b"fmt ", 16, 1, 1, 2048, 6144, 3, 24)
    path.write_bytes(b"RIFF" + struct.pack("<I", 36 + 12) + b"WAVE" + head + b"data" + struct.pack("<I", 12) + body)
    np.testing.assert_allclose(read_record(path).channels[0].values, [0.0, 0.5, -1.0, 1.0 - 2.0**-23], rtol=1e-12)


def rpc(tmp_path, **changes):
    """A file in integers of three groups of two frames; a change of None leaves the keyword out."""
    head = {
        "FORMAT": "BINARY_IEEE_LITTLE_END", "NUM_HEADER_BLOCKS": "0", "NUM_PARAMS": "0", "FILE_TYPE": "TIME_HISTORY",
        "DATA_TYPE": "SHORT_INTEGER", "CHANNELS": "2", "DELTA_T": "4.88281E-04", "PTS_PER_FRAME": "4",
        "PTS_PER_GROUP": "8", "FRAMES": "5", "SAMPLES": "18", "INT_FULL_SCALE": "32752",
        "DESC.CHAN_1": "Shaker FR", "UNITS.CHAN_1": "mm", "SCALE.CHAN_1": "0.01",
        "DESC.CHAN_2": "Load", "UNITS.CHAN_2": "kN", "SCALE.CHAN_2": "0.5",
    }  # fmt: skip
    head = {key: value for key, value in (head | changes).items() if value is not None}
    blocks = -(-len(head) * 128 // 512)
    head["NUM_HEADER_BLOCKS"] = changes.get("NUM_HEADER_BLOCKS", str(blocks))
    head["NUM_PARAMS"] = changes.get("NUM_PARAMS", str(len(head)))
    text = b"".join(key.encode().ljust(32, b"\0") + value.encode().ljust(96, b"\0") for key, value in head.items())
    order = ">" if "BIG" in head["FORMAT"] else "<"
    first = np.arange(24).reshape(3, 1, 8)
    data = np.concatenate([first, 1000 + first], axis=1).astype(f"{order}i2")
    path = tmp_path / "rig.any"
    path.write_bytes(text.ljust(blocks * 512, b"\0") + data.tobytes())
    return path


@pytest.mark.parametrize("order", ["BINARY_IEEE_LITTLE_END", "BINARY_IEEE_BIG_END"])
def test_rpc_in_integers_and_groups(tmp_path, order):
    found = read_record(rpc(tmp_path, FORMAT=order))
    one, two = found.channels
    assert (found.format, one.name, one.unit, two.si_unit, one.rate) == ("rpc", "Shaker FR", "mm", "N", 2048.0)
    np.testing.assert_allclose(one.values, 0.01 * np.arange(18))
    np.testing.assert_allclose(two.si_values, 500.0 * (1000 + np.arange(18)))
    found = read_record(rpc(tmp_path, SAMPLES=None, INT_FULL_SCALE=None))
    assert found.channels[0].values.size == 20 and "SAMPLES is missing in the header" in found.notices[0]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"FRAMES": "5000"}, "FRAMES 5000 states 80000 bytes of data, but the file has only 96"),
        ({"SAMPLES": "21"}, "SAMPLES is 21 but must be 1 to 20"),
        ({"CHANNELS": "nan"}, "CHANNELS is 'nan' but must be a number"),
        ({"CHANNELS": None}, r"rig\.any: CHANNELS is missing"),
        ({"PTS_PER_GROUP": "7"}, "7 samples per group and 4 per frame"),
        ({"DELTA_T": "0"}, "DELTA_T 0 s"),
        ({"SCALE.CHAN_2": "x"}, "SCALE.CHAN_2 is 'x'"),
        ({"FORMAT": "ASCII"}, "FORMAT is 'ASCII' but must be one of BINARY"),
        ({"NUM_PARAMS": "90000"}, "NUM_PARAMS states 11520000"),
        ({"UPPER_LIMIT.CHAN_1": "0.001", "LOWER_LIMIT.CHAN_1": "0"}, r"channel 1 reaches 0\.17, but its limit in"),
        ({"DATA_TYPE": "FLOATING_POINT"}, "FRAMES 5 states 192 bytes"),
    ],
)
def test_damaged_rpc_is_refused(tmp_path, changes, message):
    with pytest.raises(DataError, match=message):
        read_record(rpc(tmp_path, **changes))


def test_rpc_of_ncode_has_limits_of_one_and_its_extremes_elsewhere(tmp_path):
    limits = {"UPPER_LIMIT.CHAN_2": "1.0", "LOWER_LIMIT.CHAN_2": "-1.0"}
    found = read_record(rpc(tmp_path, **limits, NCODE_STAT1_CHAN_2="508.5,500.0,504.25,2.6,504.3"))
    np.testing.assert_allclose(found.channels[1].values, 0.5 * (1000 + np.arange(18)))
    with pytest.raises(DataError, match=r"channel 2 reaches 508\.5, but its limit in the header is 1; the keyword"):
        read_record(rpc(tmp_path, **limits, NCODE_STAT1_CHAN_2="5.085,5.0,5.04,0.026,5.04"))


def test_rpc_of_and_for_the_foreign_library(tmp_path):
    rpc3 = pytest.importorskip("rpc3")
    path = tmp_path / "ours.rsp"
    rpc_format.write(path, CHANNELS, "test")
    theirs, _ = rpc3.read(str(path))
    for ours, one in zip(CHANNELS, theirs, strict=True):
        assert (one.name, one.unit) == (ours.name, ours.unit) and one.dt == pytest.approx(1.0 / RATE)
        validated(
            "File readers", f"RPC III file that we write, read by a foreign library, {ours.name}",
            one.data[: SINE.size], ours.values, rel=1e-7, unit=ours.unit, source=foreign("rpc3-file"),
        )  # fmt: skip
    for kind, digits in ((int, 2.5 / 32752), (float, 1e-6)):
        made = [rpc3.Channel(name=c.name, unit=c.unit, dt=1.0 / RATE, data=c.values) for c in CHANNELS]
        rpc3.write(str(path), made, datatype=kind, overwrite=True)
        for ours, found in zip(CHANNELS, read_record(path).channels, strict=True):
            assert (found.name, found.unit, found.rate) == (ours.name, ours.unit, RATE)
            validated(
                "File readers", f"RPC III file of {kind.__name__} of a foreign library, {ours.name}", found.values,
                ours.values, abs=digits, unit=ours.unit, source=foreign("rpc3-file"),
            )  # fmt: skip


@pytest.mark.parametrize("module", [rpc_format, matlab_format])
def test_what_is_written_comes_back(tmp_path, module):
    path = tmp_path / "ours"
    module.write(path, CHANNELS, "test")
    for ours, found in zip(CHANNELS, read_record(path).channels, strict=True):
        assert (found.name, found.unit, found.rate) == (ours.name, ours.unit, RATE)
        np.testing.assert_allclose(found.values, ours.values, rtol=6e-8 if module is rpc_format else 1e-15, atol=1e-30)
