"""Packed arrays of HDF5 and netCDF: factor, offset, fill values, valid range, time coordinate."""

import numpy as np
import pytest

from tests.failing_inputs import comfort_of_seat, made
from tests.validation import validated
from vehicle.errors import DataError
from vehicle.signals.formats.reader import read_record
from vehicle.signals.records.choice import Choice, choose
from vehicle.signals.records.record_comfort import evaluate_comfort

h5py = pytest.importorskip("h5py")

NAN = np.nan
S = {"scale_factor": 0.05}
PACKED = np.array([-200, -100, 0, 100, 200, 300], dtype=np.int16)


def array(tmp_path, values=PACKED, fillvalue=None, **attributes):
    """Return the only channel of a file with one array, and its notices."""
    path = tmp_path / "packed.h5"
    with h5py.File(path, "w") as file:
        dataset = file.create_dataset("z", data=values, fillvalue=fillvalue)
        dataset.attrs.update({"units": "m/s2", **attributes})
    found = read_record(path)
    (channel,) = found.channels
    return channel, found.notices


def test_factor_and_offset_of_a_netcdf_file(tmp_path):
    choice = Choice(channels={"z": "seat_z", "time": "time"})
    found = evaluate_comfort(made("packed.nc", tmp_path), choice=choice)
    validated(
        "File readers", "weighted RMS along z of a packed netCDF array", found.weighted_rms["z"],
        comfort_of_seat(tmp_path), rel=1e-9, unit="m/s2",
        source="second derivation: the record from which the array was packed",
    )  # fmt: skip
    assert any("integers are converted by its factor 0.05 and offset 0" in text for text in found.notices)


@pytest.mark.parametrize(
    ("values", "attributes", "expected"),
    [
        (PACKED, {**S, "add_offset": 2.0}, 0.05 * PACKED + 2.0),
        (PACKED, {"add_offset": np.array([2.0])}, PACKED + 2.0),
        (PACKED, {"conversion": 1e-3, "offset": -1.0}, 1e-3 * PACKED - 1.0),
        (PACKED.astype(np.float32), {"scale_factor": np.float32(0.5)}, 0.5 * PACKED),
        (np.array([-1, 0, 5], np.int8), {"_Unsigned": "true", "scale_factor": 0.1}, [25.5, 0.0, 0.5]),
        (PACKED, {**S, "_FillValue": np.int16(300)}, [-10, -5, 0, 5, 10, NAN]),
        (PACKED, {**S, "missing_value": np.array([0, 300], np.int16)}, [-10, -5, NAN, 5, 10, NAN]),
        (PACKED, {**S, "missing_value": 300.0}, [-10, -5, 0, 5, 10, NAN]),
        (PACKED, {**S, "valid_range": np.array([-150, 250], np.int16)}, [NAN, -5, 0, 5, 10, NAN]),
        (PACKED, {**S, "valid_min": np.int16(-100)}, [NAN, -5, 0, 5, 10, 15]),
        (PACKED, {**S, "valid_max": 7.0}, [-10, -5, 0, 5, NAN, NAN]),  # of the unpacked type
        (PACKED.astype(float), {"_FillValue": -200.0}, [NAN, -100, 0, 100, 200, 300]),
        (np.array([1.0, 9.969209968386869e36], np.float32), {"fillvalue": 9.969209968386869e36}, [1.0, NAN]),
        (np.array([-1, 0, -6, -5], np.int16), {"_Unsigned": "true", "_FillValue": np.int16(-1),
                                               "valid_range": np.array([0, -6], np.int16)}, [NAN, 0, 65530, NAN]),
        (PACKED, {"scale_factor": -1.0, "valid_range": np.array([250, -150], np.int16)},
         [NAN, 100, 0, -100, -200, NAN]),
        (PACKED, {"gain": 1.0}, PACKED),
    ],
)  # fmt: skip
def test_attributes_that_pack(tmp_path, values, attributes, expected):
    channel, _ = array(tmp_path, values, **attributes)
    np.testing.assert_allclose(channel.values, expected, rtol=1e-7)
    assert channel.unit == "m/s2"


@pytest.mark.parametrize(
    "attributes", [{"gain": 0.05}, {"Calibration": np.array([0.05])}, {"scale_factor": np.array([0.1, 0.2])}, {"sensitivity": "100 mV/g"}]  # noqa: E501
)  # fmt: skip
def test_a_factor_of_unknown_sense_takes_the_unit_away(tmp_path, attributes):
    channel, _ = array(tmp_path, **attributes)
    assert (channel.unit, channel.values[0]) == ("", -200.0) and "the unit 'm/s2' is ignored" in channel.remark
    with pytest.raises(DataError, match=r"z has .*the unit 'm/s2' is ignored; set --unit z=UNIT|is ignored"):
        choose(read_record(tmp_path / "packed.h5"), Choice(channels={"z": "z"}, rate=100.0))


def test_missing_values_are_counted_and_not_evaluated(tmp_path):
    channel, notices = array(tmp_path, _FillValue=np.int16(300))
    assert "array 'z': 1 values are marked as missing" in notices
    with pytest.raises(DataError, match="1 missing values"):
        choose(read_record(tmp_path / "packed.h5"), Choice(channels={"z": "z"}, rate=100.0))
    assert channel.values.size == 6


@pytest.mark.parametrize(
    ("values", "attributes", "begin", "rate"),
    [
        (0.5 + 0.01 * np.arange(6), {"units": "s"}, 0.5, 100.0),
        (10 * np.arange(6), {"units": "ms"}, 0.0, 100.0),
        (1.7e9 + np.arange(6), {"units": "seconds since 1970-01-01 00:00:00"}, 0.0, 1.0),
        (np.arange(6, dtype=np.int16), {"units": "hours since 2026-01-01", "scale_factor": 0.5}, 0.0, 1.0 / 1800.0),
    ],
)
def test_times_of_a_netcdf_dimension(tmp_path, values, attributes, begin, rate):
    path = tmp_path / "record.nc"
    with h5py.File(path, "w") as file:
        file["time"] = values
        file["time"].attrs.update(attributes)
        file["time"].make_scale("time")
        file["z"] = PACKED
        file["z"].dims[0].attach_scale(file["time"])
    channel = next(one for one in read_record(path).channels if one.name == "z")
    assert channel.axis is not None and channel.axis[0] == begin and channel.rate == pytest.approx(rate)
