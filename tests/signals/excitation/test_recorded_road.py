"""Roads of files: profiles over distance, OpenCRG and ERD; and roads over time together with a speed."""

import struct

import numpy as np
import pytest

from vehicle.commands.input_options import input_of
from vehicle.commands.shaker import parser
from vehicle.errors import ConfigurationError, DataError
from vehicle.model.parameters.shipped import vehicle_file
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.car.road import road_of
from vehicle.signals.excitation.input_settings import DriveInput
from vehicle.signals.excitation.iso_road import Side
from vehicle.signals.excitation.measured_road import read_road
from vehicle.signals.excitation.recorded_road import RecordedDrive, delayed
from vehicle.signals.excitation.road_drive import RoadDrive
from vehicle.signals.formats.crg_format import read_surface, road_words
from vehicle.signals.formats.reader import read_record
from vehicle.signals.records.choice import Choice

BASE = 2.6
"""Wheelbase [m]."""

WHEELS: tuple[tuple[str, float, Side], ...] = (
    ("fr", 0.0, "right"),
    ("fl", 0.0, "left"),
    ("rr", BASE, "right"),
    ("rl", BASE, "left"),
)


def height(place, side="right"):
    """A road whose height is known at every place [m]."""
    phase = 0.0 if side == "right" else 0.7
    return 0.01 * np.sin(2 * np.pi * place / 7.0 + phase) + 0.002 * np.sin(2 * np.pi * place / 1.3 + 2 * phase)


def distance_at(time):
    """Exact distance [m] of the speed 12 + 5 sin(0.5 t) + 0.3 t [m/s]."""
    return 12.0 * time + 10.0 * (1.0 - np.cos(0.5 * time)) + 0.15 * time**2


def recorded(path, *, rate=1000.0, seconds=12.0, sides=("left", "right"), unit="m/s", factor=1.0):
    time = np.arange(int(seconds * rate)) / rate
    speed = (12.0 + 5.0 * np.sin(0.5 * time) + 0.3 * time) * factor
    columns = [height(distance_at(time), side) for side in sides]
    heads = ",".join(["time [s]", f"v [{unit}]", *(f"{side} [m]" for side in sides)])
    np.savetxt(path, np.column_stack([time, speed, *columns]), fmt="%.10g", delimiter=",", header=heads, comments="")
    return path


def drive(path, channel="v", **options):
    return RecordedDrive(road=path, channel=channel, wheels=WHEELS, **options)


def test_the_rear_plate_is_the_front_plate_at_the_same_place(tmp_path):
    signal = drive(recorded(tmp_path / "road.csv")).signal()
    time = signal.time
    place = distance_at(time)
    for side, front, rear in (("right", "fr", "rr"), ("left", "fl", "rl")):
        start = height(0.0, side)
        driven = time > 1.0  # the rise from rest
        np.testing.assert_allclose(
            signal.displacement[front][driven], height(place[driven], side) - start, rtol=0, atol=1e-9
        )
        behind = place - BASE > distance_at(1.0)
        # trapezoidal rule h^2/12 [v'] T: 2e-7 m of distance, on a slope of 0.02; linear inverse: 1e-7 s at 0.3 m/s
        np.testing.assert_allclose(
            signal.displacement[rear][behind], height(place[behind] - BASE, side) - start, rtol=0, atol=5e-8
        )
        assert not signal.displacement[rear][place < BASE].any()
    assert "12 s rise" not in signal.source and "km/h" in signal.source


def test_tyres_roll_at_the_mean_speed_and_the_evaluation_begins_behind_the_rise(tmp_path):
    path = recorded(tmp_path / "road.csv")
    rolling = drive(path, driving=np.nan)
    (text,) = rolling.overrides
    # The mean of a sampled speed is its integral over the record, but for a sample of 1 ms; two digits are kept.
    assert float(text.removeprefix("driving.speed=")) == pytest.approx(distance_at(12.0) / 12.0, abs=6e-3)
    assert any("mean speed" in notice for notice in rolling.signal().notices)
    assert drive(path, driving=0.0).overrides == ("driving.speed=0.0",) and drive(path).overrides == ()
    assert not any("mean speed" in notice for notice in drive(path).signal().notices)
    # 2 s after the start all wheels are over the rise and 0.5 s more; with a long wheelbase it takes longer.
    assert rolling.skip == 2.0
    far = RecordedDrive(road=path, channel="v", wheels=(WHEELS[0], ("rr", 50.0, "right")))
    assert distance_at(far.skip - 0.1) < distance_at(1.5) + 50.0 <= distance_at(far.skip)


def test_the_speed_may_be_slower_and_in_another_unit(tmp_path):
    first = drive(recorded(tmp_path / "a.csv")).signal()
    wrong = recorded(tmp_path / "b.csv", unit="V", factor=3.6)
    with pytest.raises(DataError, match="a voltage, but must be a velocity"):
        drive(wrong).signal()
    second = drive(wrong, choice=Choice(units={"speed": "km/h"})).signal()
    np.testing.assert_allclose(second.displacement["rl"], first.displacement["rl"], atol=1e-9)
    with pytest.raises(DataError, match="is the unit right"):
        drive(recorded(tmp_path / "c.csv", factor=10.0)).signal()


def test_a_slow_record_and_one_track(tmp_path):
    path = recorded(tmp_path / "slow.csv", rate=100.0, sides=("height",))
    signal = drive(path).signal()
    assert signal.highest == pytest.approx(40.0)
    assert any("one track, 'height'" in text for text in signal.notices)
    np.testing.assert_array_equal(signal.displacement["fr"], signal.displacement["fl"])
    late = distance_at(signal.time) - BASE
    inner = (late > distance_at(1.0)) & (signal.time < 11.0)
    expected = height(late[inner], "left") - height(0.0, "left")
    # 20 m/s over waves of 1.3 m: 15 Hz of 100; its spline keeps 99.9 %, the speed is taken as linear over 10 ms
    off = signal.displacement["rl"][inner] - expected
    # the filter rounds off the first sample, from which heights are counted: an offset, 1 % of the level
    assert np.abs(off - off.mean()).max() < 2e-5 and abs(off.mean()) < 1.5e-4


def test_a_car_that_stands_goes_on_from_its_place():
    time = np.arange(0.0, 10.0, 1e-3)
    speed = np.where((time > 3.0) & (time < 6.0), 0.0, 5.0)
    distance = np.concatenate([[0.0], np.cumsum(0.5e-3 * (speed[1:] + speed[:-1]))])
    late = delayed(time, distance, time, BASE)
    assert np.isnan(late[: int(1000 * BASE / 5.0) - 2]).all()
    met = np.isfinite(late)
    np.testing.assert_allclose(np.interp(late[met], time, distance), distance[met] - BASE, atol=1e-9)
    assert delayed(time, distance, time, 0.0) is time


def test_what_is_no_speed_is_refused(tmp_path):
    path = recorded(tmp_path / "road.csv")
    for options, error, message in (
        ({"channel": "left"}, DataError, "a displacement, but must be a velocity"),
        ({"duration": 30.0}, ConfigurationError, r"--duration 30 s: .* 11\.99"),
        ({"choice": Choice(channels={"fr": "left"})}, ConfigurationError, "--channel fr=.*left, right or height"),
    ):
        with pytest.raises(error, match=message):
            drive(path, **options).signal()
    source = input_of(parser().parse_args(["--road", "C", "--speed", "channel:v"]))
    assert isinstance(source, DriveInput)
    with pytest.raises(ConfigurationError, match="belongs to a recorded road"):
        road_of(source).under(load_vehicle(vehicle_file("focus_road")))


def test_the_command_makes_the_drive(tmp_path):
    path = recorded(tmp_path / "road.csv")
    words = ["--road", str(path), "--speed", "channel:v", "--channel", "height=left", "--unit", "speed=m/s"]
    source = input_of(parser().parse_args(words))
    assert isinstance(source, DriveInput)
    found = road_of(source).under(load_vehicle(vehicle_file("focus_road")))
    assert isinstance(found, RecordedDrive) and found.choice.channels == {"height": "left"}
    assert [name for name, *_ in found.wheels] == ["fr", "fl", "rr", "rl"] and hash(found) is not None
    signal = found.signal()
    np.testing.assert_array_equal(signal.displacement["fr"], signal.displacement["fl"])
    with pytest.raises(ConfigurationError, match="no --channel"):
        source.record.choice("height")
    # A unit of another name belongs to the measurement beside the run.
    beside = input_of(parser().parse_args([*words, "--unit", "knuckle_fr_acc_z=g"]))
    assert isinstance(beside, DriveInput)
    assert road_of(beside, others=True) == road_of(source)
    with pytest.raises(ConfigurationError, match="no --channel"):
        road_of(beside)


def profile(path, length=50.0):
    place = np.arange(0.0, length + 0.05, 0.05)
    table = np.column_stack([place, height(place, "left"), height(place)])
    np.savetxt(path, table, fmt="%.10g", delimiter=",", header="distance [m],left [m],right [m]", comments="")
    return path


def test_a_profile_is_driven_to_its_end(tmp_path):
    path = profile(tmp_path / "profile.csv")
    signal = RoadDrive(road=path, speed=80.0, wheels=WHEELS, track=1.5, patch=0.0).signal()
    assert signal.duration == pytest.approx(50.0 / (80.0 / 3.6), abs=1e-3)
    late = signal.time * 80.0 / 3.6 - BASE
    inner = late > 80.0 / 3.6
    # a cubic spline through points 0.05 m apart, waves of 1.3 m
    assert np.abs(signal.displacement["rr"][inner] - height(late[inner])).max() < 1e-6
    with pytest.raises(DataError, match=r"the road is 50 m long, .* shorter --duration"):
        RoadDrive(road=path, speed=80.0, wheels=WHEELS, track=1.5, duration=3.0).signal()


HEADER = """$CT
a road; $$$$ in a comment is no end of the header
$ROAD_CRG ! parameters
REFERENCE_LINE_START_U = 100.0
REFERENCE_LINE_END_U = {end}
REFERENCE_LINE_INCREMENT = 0.5
LONG_SECTION_V_RIGHT = -1.0
LONG_SECTION_V_LEFT = 1.0
LONG_SECTION_V_INCREMENT = 1.0
$KD_Definition
#:{form}
U:reference line u,m,0,0.5
{more}D:long section 1,m
D:long section 2,m
D:long section 3,m
$
$$$$$$$$
"""


def crg(path, form, grid, slope=None):
    rows = grid.shape[0]
    head = HEADER.format(
        end=100.0 + 0.5 * (rows - 1), form=form, more="" if slope is None else "D:reference line slope,m/m\n"
    )
    table = grid if slope is None else np.column_stack([slope, grid])
    if form in ("KRBI", "KDBI"):
        data = struct.pack(f">{table.size}{'f' if form == 'KRBI' else 'd'}", *table.ravel())
        path.write_bytes(head.encode() + data + b"\0" * (-len(data) % 80))
        return path
    width = 10 if form == "LRFI" else 20
    lines = []
    for row in table:
        cells = ["*missing*".rjust(width) if np.isnan(value) else f"{value:{width}.7f}" for value in row]
        each = 80 // width
        lines += ["".join(cells[n : n + each]) for n in range(0, len(cells), each)]
    path.write_text(head + "\n".join(lines) + "\n")
    return path


@pytest.mark.parametrize(("turn", "curved"), [(0.01, True), (-0.01, True), (0.0, False)])
def test_a_reference_line_that_turns_to_either_side_is_named(tmp_path, turn, curved):
    path = crg(tmp_path / "road.crg", "LRFI", np.zeros((20, 3)), 0.3 + turn * np.arange(20))
    path.write_text(path.read_text().replace("reference line slope,m/m", "reference line phi,rad"))
    assert ("curved reference line" in road_words(read_surface(path))) == curved


@pytest.mark.parametrize("form", ["LRFI", "LDFI", "KRBI", "KDBI"])
def test_a_surface_is_read(tmp_path, form):
    rng = np.random.default_rng(3)
    grid = np.round(2.0 + 0.01 * rng.standard_normal((9, 3)), 7)
    grid[4, 0] = np.nan
    slope = np.full(9, 0.02)
    path = crg(tmp_path / "road.crg", form, grid, slope)
    surface = read_surface(path)
    line = 0.02 * 0.5 * np.arange(9)
    np.testing.assert_allclose(surface.z, grid + line[:, None], atol=2e-7)  # single precision
    np.testing.assert_array_equal(surface.v, [-1.0, 0.0, 1.0])
    np.testing.assert_allclose(surface.u, 100.0 + 0.5 * np.arange(9))
    np.testing.assert_allclose(surface.height(0.25), (0.75 * grid[:, 1] + 0.25 * grid[:, 2]) + line, atol=2e-7)
    assert np.isnan(surface.height(1.2)).all()
    channels = read_record(path).channels
    assert [one.name for one in channels] == ["distance", "v = -1.000 m", "v = 0.000 m", "v = 1.000 m"]
    # v goes to the left: the right track would need the missing point
    with pytest.raises(DataError, match=r"the right wheels .*-0\.75 m.* at 1 of 9 points"):
        read_road(path, 1.5)
    grid[4, 0] = 2.0
    road = read_road(crg(path, form, grid), 1.5)
    np.testing.assert_allclose(road.right, 0.75 * grid[:, 0] + 0.25 * grid[:, 1], atol=2e-7)
    np.testing.assert_allclose(road.left, 0.75 * grid[:, 2] + 0.25 * grid[:, 1], atol=2e-7)
    assert "3 sections across (v to the left)" in road.notices[0]


def test_a_damaged_surface_is_refused(tmp_path):
    grid = 2.0 + 0.01 * np.random.default_rng(3).standard_normal((40, 3))
    path = tmp_path / "road.crg"
    whole = crg(path, "KRBI", grid).read_bytes()
    start = whole.index(b"$$$$$$$$\n") + 9
    # Lost bytes within a number: "2.002 2.014" became 6805 m in a surface of 2 m.
    lost = grid.copy()
    lost[20, 1] = 68.05
    for data, message in (
        (whole[:-100], "states 480"),
        (whole[:start] + whole[start + 1 :] + b"\0", r"height of 3.* m, .* 10000 m"),
        (whole.replace(b"$KD_Def", b"$ROAD_CRG_MODS\nSCALE_Z_GRID = 2\n$KD_Def"), r"scale_z_grid = 2 .*ROAD_CRG_MODS"),
        (crg(path, "LRFI", lost).read_bytes(), r" 66.* m between rows 20 and 21 .* 0.5 m apart"),
        (crg(path, "LRFI", grid).read_bytes().rsplit(b"\n", 3)[0], "truncated or damaged"),
    ):
        path.write_bytes(data)
        with pytest.raises(DataError, match=message):
            read_road(path, 1.5)


@pytest.mark.parametrize("form", ["LRFI", "LDFI", "KRBI", "KDBI"])
def test_every_damage_is_named_with_the_file(tmp_path, form):
    grid = 2.0 + 0.01 * np.random.default_rng(4).standard_normal((40, 3))
    path = crg(tmp_path / "road.crg", form, grid)
    whole = path.read_bytes()
    start = whole.index(b"$$$$$$$$\n")

    def refused(data, message, track=1.5):
        path.write_bytes(data)
        with pytest.raises(DataError, match=message) as raised:
            read_road(path, track)
        assert str(path) in str(raised.value)

    # A header without end, cut off at any place, and numbers cut off at any place.
    refused(whole[:start] + whole[start + 9 :], "no line \\$\\$\\$\\$ before the numbers")
    for kept in (0, 30, start // 2, start):
        refused(whole[:kept], "no line \\$\\$\\$\\$|not|empty|no ")
    for share in (0.0, 0.1, 0.5, 0.9):
        refused(whole[: start + 9 + int(share * (len(whole) - start - 9))], "claims|truncated or damaged|damaged")
    # More or fewer rows, sections or a wider step than the header claims.
    refused(whole.replace(b"REFERENCE_LINE_END_U = 119.5", b"REFERENCE_LINE_END_U = 219.5"), "its header states")
    refused(whole.replace(b"REFERENCE_LINE_END_U = 119.5", b"REFERENCE_LINE_END_U = 102.5"), "its header states")
    refused(
        whole.replace(b"D:long section 3,m\n", b"D:long section 3,m\nD:long section 4,m\n"),
        "its header states|fewer than the 4 numbers of its header",
    )
    refused(
        whole.replace(b"D:long section 3,m\n", b""),
        "sections|according|its header states|more than the 2 numbers of its header",
    )
    refused(whole.replace(b"REFERENCE_LINE_INCREMENT = 0.5", b"REFERENCE_LINE_INCREMENT = 0"), "must be above 0")
    refused(whole.replace(b"LONG_SECTION_V_INCREMENT = 1.0", b"LONG_SECTION_V_INCREMENT = x"), "must be a number")
    refused(whole.replace(form.encode(), b"XXXX"), "the numbers have the format 'XXXX'; must be one of")
    # Missing numbers at the edge, which the right wheels would need; a narrow car drives beside them.
    grid[5:9, 0] = np.nan
    crg(path, form, grid)
    refused(path.read_bytes(), r"the right wheels .*-0\.75 m.* at 4 of 40 points, first after 102\.5 m")
    assert np.isfinite(read_surface(path).height(0.5)).all()
    refused(whole, " at 40 of 40 points", track=2.4)


def erd(path, samples=200, unit="mm", kind=5, count=2):
    place = 0.025 * np.arange(samples)
    factor = {"mm": 1e3, "in": 1.0 / 0.0254, "ft": 1.0 / 0.3048}[unit]
    lines = [
        "ERDFILEV2.00",
        f"      {count},   {samples},     -1,      1,      {kind},       0.0250,     -1,",
        "TITLE   Section 06B410SF: Run 1",
        "SHORTNAMLElev.  RElev.  ",
        f"UNITSNAM{unit:8}{unit:8}",
        "XLABEL  Distance",
        "XUNITS  m",
        "END",
        *(f" {factor * a:.5f} {factor * b:.5f}" for a, b in zip(height(place, "left"), height(place), strict=True)),
    ]
    path.write_text("\n".join(lines) + "\n")
    return path


@pytest.mark.parametrize("unit", ["mm", "in", "ft"])
def test_an_erd_profile_is_a_road(tmp_path, unit):
    path = erd(tmp_path / "section.erd", unit=unit)
    road = read_road(path, 1.5)
    place = 0.025 * np.arange(200)
    np.testing.assert_allclose(road.distance, place)
    np.testing.assert_allclose(road.left, height(place, "left"), atol=2e-6)
    np.testing.assert_allclose(road.right, height(place), atol=2e-6)
    found = read_record(path)
    assert [(one.name, one.unit) for one in found.channels] == [("distance", "m"), ("LElev.", unit), ("RElev.", unit)]
    assert found.program == "Section 06B410SF: Run 1"


def test_a_damaged_or_binary_erd_is_refused(tmp_path):
    path = tmp_path / "section.erd"
    whole = erd(path).read_text()
    for text, message in (
        (erd(path, kind=1).read_text(), "KEYNUM 1"),
        (whole.rsplit(" ", 2)[0], r"39[89] numbers, .* 200 samples of 2 channels"),
        (whole.replace("XUNITS  m", "XUNITS  s"), "XUNITS 's'|XUNITS s"),
    ):
        path.write_text(text)
        with pytest.raises(DataError, match=message):
            read_road(path, 1.5)
