"""Files that are right and were refused, and files whose refusal or advice said something untrue."""

import zipfile

import numpy as np
import pytest

from tests.advice import advised
from vehicle.errors import ConfigurationError, DataError
from vehicle.runs.car import Car
from vehicle.signals.excitation.measured_road import read_road
from vehicle.signals.formats import rpc_format
from vehicle.signals.formats.channel import Channel, uniform_axis
from vehicle.signals.formats.clock import clock_of_rounded
from vehicle.signals.formats.reader import read
from vehicle.signals.formats.units import find_ratio, find_unit
from vehicle.signals.records.choice import Choice
from vehicle.signals.records.measured_frf import measured_frfs

TIME = uniform_axis(4096, 1.0 / 204.8)


@pytest.mark.parametrize(
    ("capitals", "plain"),
    [
        *(("MM", "mm"), ("M", "m"), ("M/S2", "m/s2"), ("M/S^2", "m/s2"), ("M/S**2", "m/s2"), ("MM/S2", "mm/s2")),
        *(("KN", "kN"), ("HZ", "Hz"), ("SEC", "s"), ("S", "s"), ("MS", "ms"), ("KM/H", "km/h"), ("DEG/S", "deg/s")),
        *(("MPA", "MPa"), ("[MM]", "mm"), ("(M/S2)", "m/s2"), ("UM", "um"), ("KNM", "kNm"), ("DEGC", "degC")),
    ],
)
def test_units_in_capitals(capitals, plain):
    assert find_unit(capitals) == find_unit(plain) != None  # noqa: E711
    assert find_ratio("(M/S2)/N") == find_ratio("(m/s2)/N")


def test_capitals_of_two_units_are_no_unit():
    assert find_unit("NM") is None and find_unit("H") is None and find_unit("mPA") is None


@pytest.mark.parametrize("rate", [1668.0, 1668.3, 1666.7, 1651.61, 511.97])
@pytest.mark.parametrize("cut", [np.round, lambda t, d: np.floor(t * 10.0**d) / 10.0**d], ids=["rounded", "cut"])
@pytest.mark.parametrize("start", [0.0, 0.3, 1.7e9])
def test_times_in_whole_microseconds_have_a_clock(rate, cut, start):
    """The stored number of a time since 1970 is a multiple of 0.24 us."""
    time = start + cut(np.arange(20000) / rate, 6)
    found = clock_of_rounded(time - time[0])
    assert found is not None and found[1] <= 6
    assert found[0] == pytest.approx(rate, rel=2e-6 / (20000 / rate))


def rsp(path, limits):
    """A file of a writer that states these limits, (lower, upper) for each channel."""
    shapes = [("Plate FL", "mm", 10.0), ("Hub FL z", "g", 0.5)]
    channels = tuple(
        Channel(name=name, unit=unit, values=level * np.sin(7.0 * TIME), axis=TIME) for name, unit, level in shapes
    )
    rpc_format.write(path, channels, "")
    data = bytearray(path.read_bytes())
    for number, pair in enumerate(limits, 1):
        for key, value in zip(("LOWER_LIMIT", "UPPER_LIMIT"), pair, strict=True):
            at = data.index(f"{key}.CHAN_{number}".encode()) + 32
            data[at : at + 96] = f"{value}".encode().ljust(96, b"\0")
    path.write_bytes(bytes(data))
    return path


@pytest.mark.parametrize("limits", [((-1, 1), (-1, 1)), ((-2, 2), (-2, 2)), ((-1.0, 1.0), (-1.0, 1.0))])
def test_limits_that_are_a_constant_of_the_writer(tmp_path, limits):
    found = read(rsp(tmp_path / "a.rsp", limits))
    assert np.abs(found["Plate FL"].values).max() == pytest.approx(10.0, rel=1e-3)
    (notice,) = found.notices
    assert "channel 1 reaches 10" in notice and f"limit {limits[0][1]:g} " in notice


def test_limits_of_each_channel_find_a_damaged_scale(tmp_path):
    with pytest.raises(DataError, match=r"channel 1 reaches 10, .* 2; .*SCALE"):
        read(rsp(tmp_path / "a.rsp", ((-2, 2), (-0.5, 0.5))))


@pytest.mark.parametrize("unit", ["m/m", "mm/mm", "(m)/(m)", "M/M", "um/um", "(mm)/(mm)"])
def test_a_transmissibility_in_any_spelling(tmp_path, unit):
    """H of displacements; the acceleration per displacement is -w^2 H."""
    frequency = np.linspace(1.0, 40.0, 50)
    ratio = 1.0 / (1.0 - (frequency / 15.0) ** 2 + 0.1j)
    table = np.column_stack([frequency, ratio.real, ratio.imag])
    heads = f"Frequency [Hz],H real [{unit}],H imag [{unit}]"
    np.savetxt(tmp_path / "h.csv", table, "%.9g", ",", header=heads, comments="")
    data, _ = measured_frfs(read(tmp_path / "h.csv"), {"seat_rail_acc_z": "H"}, Choice())
    assert np.allclose(data.response[0], -((2.0 * np.pi * frequency) ** 2) * ratio, rtol=1e-6)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("data.tdm", "TDM of DIAdem, in a ZIP archive"),
        ("content.xml", "spreadsheet of OpenDocument"),
        ("modelDescription.xml", "FMU, which is a model"),
        ("ride.csv", "ZIP archive of ride.csv, not supported; unpack it"),
    ],
)
def test_a_zip_archive_is_named_by_its_content(tmp_path, name, words):
    with zipfile.ZipFile(tmp_path / "file", "w") as archive:
        archive.writestr(name, "<xml>")
    with pytest.raises(DataError, match=words):
        read(tmp_path / "file")


@pytest.mark.parametrize(("unit", "words"), [("(m/s2)^2/Hz", "without a phase"), ("(m/s2)/N", "a response to a force")])
def test_no_comparison_is_advised_for_a_density_or_a_force(tmp_path, unit, words):
    frequency = np.linspace(1.0, 40.0, 50)
    heads = f"Frequency [Hz],S [{unit}]" if "^" in unit else f"Frequency [Hz],S real [{unit}],S imag [{unit}]"
    columns = [frequency] * (2 if "^" in unit else 3)
    np.savetxt(tmp_path / "s.csv", np.column_stack(columns), "%.6g", ",", header=heads, comments="")
    _, text = advised(tmp_path / "s.csv")
    assert words in text and "compare RUN" not in text


def crg(path, heights=(0.0, 0.0), mods=""):
    """A surface of two sections, 400 m long, of which the first and then the second half have a height."""
    rows = "".join(f"{heights[n > 200]:10.7f}" * 2 + "\n" for n in range(401))
    modifiers = f"$ROAD_CRG_MODS\n{mods}\n$\n" if mods else ""
    path.write_text(
        f"$ROAD_CRG\nREFERENCE_LINE_START_U = 0\nREFERENCE_LINE_END_U = 400\nREFERENCE_LINE_INCREMENT = 1\n"
        f"LONG_SECTION_V_RIGHT = -2\nLONG_SECTION_V_LEFT = 2\nLONG_SECTION_V_INCREMENT = 4\n$\n{modifiers}"
        f"$KD_DEFINITION\n#:LRFI\nD:long section 1,m\nD:long section 2,m\n$\n$$$$$$$$\n{rows}"
    )
    return path


MOVES = ("REFPOINT_X = 100.0", "REFPOINT_Y = -3", "REFPOINT_PHI = 0.3", "REFPOINT_Z = 20", "REFLINE_OFFSET_X = 5",
         "REFLINE_OFFSET_PHI = 1.57", "REFLINE_ROTCENTER_Y = 2", "REFPOINT_U_FRACTION = 0.5", "REFPOINT_V = 1",
         "SCALE_Z_GRID = 1.0", "REFLINE_OFFSET_Z = -2", "REFPOINT_X = 1\nREFPOINT_Y = 2\nREFPOINT_PHI = 3")  # fmt: skip


@pytest.mark.parametrize("mods", MOVES)
def test_modifiers_that_move_a_road_as_a_whole(tmp_path, mods):
    plain = read_road(crg(tmp_path / "a.crg", (0.0, 0.02)), 1.5)
    moved = read_road(crg(tmp_path / "b.crg", (0.0, 0.02), mods), 1.5)
    assert np.array_equal(moved.left, plain.left) and np.array_equal(moved.right, plain.right)


@pytest.mark.parametrize("mods", ["SCALE_Z_GRID = 2", "SCALE_LENGTH = 0.5", "GRID_NAN_MODE = 1", "SCALE_BANKING = -1"])
def test_modifiers_of_the_surface_are_refused(tmp_path, mods):
    with pytest.raises(DataError, match=f"modifier {mods.split()[0].lower()} = .* changes the surface"):
        read_road(crg(tmp_path / "a.crg", (0.0, 0.02), mods), 1.5)


def test_a_road_is_parsed_once_for_a_drive_and_again_when_it_changes(tmp_path, monkeypatch):
    from vehicle import road
    from vehicle.signals.excitation import measured_road

    read, path, car = [], tmp_path / "road.csv", Car.load("focus_road").vehicle
    table = vars(measured_road)["read_table"]

    def counted(*given):
        read.append(given)
        return table(*given)

    monkeypatch.setattr(measured_road, "read_table", counted)
    for times, height in enumerate((0.01, 0.02), start=1):
        rows = [f"{0.1 * k:.1f},{height * (k % 7):.3f},0.0" for k in range(1000)]
        path.write_text("\n".join(["distance [m],left [m],right [m]", *rows]))
        signal = road(path, 80.0).under(car).signal()
        assert len(read) == times
        assert max(np.max(heights) for heights in signal.displacement.values()) > 4.0 * height


def test_a_level_surface_is_a_level_road(tmp_path):
    """Without a force it moves nothing, so no command is advised; a car with a force drives over it."""
    from vehicle import road

    path = crg(tmp_path / "flat.crg", (0.3, 0.3))
    commands, text = advised(path)
    assert not commands and "is level, moves no plate, and focus_road has no force that shakes it" in text
    with pytest.raises(ConfigurationError, match="is level, moves no plate"):
        road(path, 80.0).under(Car.load("focus_road").vehicle)
    unbalanced = Car.load("focus_road", ["front.imbalance.mass=0.02", "front.imbalance.radius=0.2"])
    signal = road(path, 80.0).under(unbalanced.vehicle).signal()
    assert not any(np.ptp(each) for each in signal.displacement.values())
