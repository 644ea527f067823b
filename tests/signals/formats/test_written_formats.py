"""A run in the formats of other programs: read back by this one and by the foreign libraries."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from vehicle.commands.inspect import main as inspect
from vehicle.commands.shaker import main as shaker
from vehicle.errors import DataError
from vehicle.signals.excitation.signal_file import read_signal
from vehicle.signals.formats import hdf_format, matlab_format
from vehicle.signals.formats.channel import Channel, uniform_axis
from vehicle.signals.formats.frf_file import read_frf
from vehicle.signals.formats.geometry import Geometry
from vehicle.signals.formats.reader import read_columns, read_record
from vehicle.signals.formats.uff_writer import write

TIME = uniform_axis(2048, 1.0 / 2048.0)
SINE = np.sin(2.0 * np.pi * 5.0 * TIME)
LINES = uniform_axis(40, 0.25, 1.0)


def channels():
    response = SINE[:40] + 1j * SINE[40:80]
    response[:3] = np.nan  # where the input is not
    point: dict[str, Any] = {"place": "knuckle", "direction": "-Z", "reference": "plate+Z"}
    lines: dict[str, Any] = {"axis": LINES, "kind": "frequency"}
    return (
        Channel(name="plate", values=1e-3 * SINE, unit="m", axis=TIME, place="plate", direction="+Z"),
        Channel(name="H", values=response, unit="(m/s2)/(m)", function="frequency response", **lines, **point),
        Channel(name="gamma2", values=np.where(np.isnan(response), np.nan, 0.9), function="coherence", **lines,
                **point),
    )  # fmt: skip


GEOMETRY = Geometry(points={"plate": (0.0, 0.7, 0.0), "knuckle": (0.01, 0.65, 0.3)}, lines=[["plate", "knuckle"]])


def test_a_universal_file_comes_back(tmp_path):
    path = tmp_path / "ours.uff"
    write(path, channels(), "test", GEOMETRY)
    found = read_record(path)
    plate, response, coherence = found.channels
    assert found.program == "vehicle-on-shaker" and found.notices == ("2 nodes, 1 lines and elements",)
    assert (plate.name, plate.unit, plate.rate, plate.place, plate.direction) == ("plate", "m", 2048.0, "1", "+Z")
    np.testing.assert_array_equal(plate.values, 1e-3 * SINE)
    assert (response.name, response.si_unit, response.place, response.direction) == ("H", "(m/s2)/(m)", "2", "-Z")
    assert (response.function, coherence.function, response.reference) == ("frequency response", "coherence", "1+Z")
    np.testing.assert_array_equal(response.values, channels()[1].values[3:])
    assert response.axis is not None
    np.testing.assert_allclose(response.axis, LINES[3:])
    assert not np.iscomplexobj(coherence.values) and coherence.values.size == 37
    # Dataset 164 says SI: what is in mm/s is written in m/s.
    write(path, (Channel(name="v", values=SINE, unit="mm/s", axis=TIME),), "test")
    (speed,) = read_record(path).channels
    assert speed.unit == "m/s"
    np.testing.assert_allclose(speed.values, 1e-3 * SINE, rtol=1e-15)
    gap = Channel(name="gap", values=np.where(TIME > 0.5, np.nan, SINE), axis=TIME)
    with pytest.raises(DataError, match="gap has a missing value, which UFF cannot store; leave"):
        write(path, (gap,), "test")


def test_the_foreign_library_reads_it(tmp_path):
    pyuff = pytest.importorskip("pyuff")
    path = tmp_path / "ours.uff"
    write(path, channels(), "test", GEOMETRY)
    file = pyuff.UFF(str(path))
    assert [int(kind) for kind in file.get_set_types()] == [151, 164, 15, 82, 58, 58, 58]
    assert (file.read_sets(1)["length"], file.read_sets(1)["units_code"]) == (1.0, 1)
    nodes = file.read_sets(2)
    np.testing.assert_allclose([nodes["x"], nodes["y"], nodes["z"]], np.array(list(GEOMETRY.points.values())).T)
    np.testing.assert_array_equal(file.read_sets(3)["nodes"], [1, 2])
    plate, response = file.read_sets(4), file.read_sets(5)
    assert (plate["rsp_node"], plate["rsp_dir"], plate["ordinate_axis_units_lab"]) == (1, 3, "m")
    np.testing.assert_array_equal(plate["data"][:2048], 1e-3 * SINE)
    assert (response["rsp_dir"], response["ref_node"], response["ref_dir"], response["func_type"]) == (-3, 1, 3, 4)
    np.testing.assert_array_equal(response["data"][:37], channels()[1].values[3:])


@pytest.mark.parametrize("form", ["uff", "mat", "hdf5"])
def test_frequencies_that_are_not_even_come_back(tmp_path, form):
    """As those of a run: lines of 1/60 Hz, every third up to a frequency and every sixth above."""
    lines = np.concatenate([np.arange(60, 120, 3), np.arange(120, 181, 6)]) / 60.0
    given = tuple(replace(one, axis=lines, values=one.values[: lines.size]) for one in channels()[1:])
    path = tmp_path / "ours"
    if form == "hdf5":
        pytest.importorskip("h5py")
    {"uff": write, "mat": matlab_format.write, "hdf5": hdf_format.write}[form](path, given, "test")
    for ours, found in zip(given, read_record(path).channels, strict=True):
        start = 3 if form == "uff" else 0  # UFF knows no missing value
        assert found.axis is not None and (found.kind, found.function) == ("frequency", ours.function)
        np.testing.assert_allclose(found.axis, lines[start:], rtol=1e-5 if form == "uff" else 1e-15)
        np.testing.assert_allclose(found.values, ours.values[start:], rtol=1e-11)
    if form == "uff":
        pyuff = pytest.importorskip("pyuff")
        np.testing.assert_allclose(pyuff.UFF(str(path)).read_sets(2)["x"], lines[3:], rtol=1e-5)


def test_a_run_is_written_in_all_formats(tmp_path, capsys):
    pytest.importorskip("asammdf")
    source = tmp_path / "short.csv"
    time = np.arange(4000) / 500.0
    z = 1e-3 * np.sin(2.0 * np.pi * (2.0 * time + time**2)) * np.minimum(1.0, time)
    rows = "\n".join(f"{t:.3f},{value:.9e}" for t, value in zip(time, z, strict=True))
    source.write_text(f"time [s],displacement [m]\n{rows}\n")
    output = tmp_path / "run"
    formats = [word for form in ("csv", "mat", "uff", "rpc", "mf4") for word in ("--format", form)]
    arguments = ["--input", str(source), "--engine", "reduced", "--output", str(output), "--quiet", *formats]
    assert shaker(arguments) == 0, capsys.readouterr().err
    held, response = read_columns(output / "time.npz"), read_frf(output / "frf.csv")
    for form, digits in (("csv", 1e-8), ("mat", 1e-15), ("uff", 1e-15), ("rpc", 1e-7), ("mf4", 1e-15)):
        found = {one.name: one for one in read_record(output / f"time.{form}").channels}
        for name, values in held.channels.items():
            np.testing.assert_allclose(found[name].si_values, values, rtol=digits, atol=1e-12, err_msg=name)
            assert found[name].unit == held.units[name] and found[name].rate == pytest.approx(1.0 / held.step, rel=1e-6)
        if form in ("mat", "uff"):
            one = found["knuckle_fl_acc_z / plate_fl"]
            row = response.response[response.channels.index("knuckle_fl_acc_z")]
            defined = np.isfinite(row)
            np.testing.assert_allclose(one.values[np.isfinite(one.values)], row[defined], rtol=1e-7)
            assert one.axis is not None
            np.testing.assert_allclose(one.axis[np.isfinite(one.values)], response.frequency[defined], rtol=1e-5)
            assert one.si_unit == "(m/s2)/(m)" and f"{one.name} coherence" in found
    # What a run writes drives the next one.
    again = read_signal(output / "time.uff")
    assert again.wheels == ("fl",)
    assert inspect([str(output / "frf.csv")]) == 0 and "(m/s2)/m" in capsys.readouterr().out
