import numpy as np
import pytest

from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.records.acceleration import read_acceleration


def xyz_of(record):
    return np.array([record.channels[axis] for axis in "xyz"])


HEADER = "time [s],x [m/s2],y [m/s2],z [m/s2]"
ROWS = ["0,0.1,0.2,0.3", "0.001,-0.1,0.4,0.5", "0.002,0.2,-0.2,0.1", "0.003,0.3,0.1,-0.4"]


@pytest.fixture
def write(tmp_path):
    def written(text):
        path = tmp_path / "ride.csv"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    return written


def lines(*rows, header=HEADER):
    return "\n".join((header, *rows)) + "\n"


def test_a_plain_record_is_read(write):
    record = read_acceleration(write("# measured in March\n\n" + lines(*ROWS[:2], "# a pause", *ROWS[2:])))
    assert record.step == pytest.approx(1e-3, rel=1e-12)
    assert xyz_of(record) == pytest.approx(
        np.array([[0.1, -0.1, 0.2, 0.3], [0.2, 0.4, -0.2, 0.1], [0.3, 0.5, 0.1, -0.4]])
    )


@pytest.mark.parametrize(
    "text",
    [
        pytest.param("\ufeff" + lines(*ROWS), id="byte order mark"),
        pytest.param(lines(*ROWS).replace("\n", "\r\n"), id="CRLF"),
        pytest.param(lines(*ROWS).replace(",", " , "), id="blanks"),
        pytest.param(lines(*ROWS).rstrip(), id="no last line end"),
        pytest.param(lines(*ROWS).replace(",", "\t"), id="tabs"),
        pytest.param(lines(*ROWS).replace(",", ";").replace(".", ","), id="semicolons and decimal commas"),
    ],
)
def test_harmless_oddities_change_nothing(write, text):
    plain = read_acceleration(write(lines(*ROWS)))
    assert xyz_of(read_acceleration(write(text))) == pytest.approx(xyz_of(plain), rel=1e-15)


def test_columns_may_stand_in_any_order_and_units(write):
    rows = [",".join((c[3], c[0], c[2], c[1])) for c in (row.split(",") for row in ROWS)]
    record = read_acceleration(write(lines(*rows, header="z [g],time [s],y [m/s^2],x [m/s²]")))
    plain = read_acceleration(write(lines(*ROWS)))
    assert xyz_of(record)[:2] == pytest.approx(xyz_of(plain)[:2])
    assert xyz_of(record)[2] == pytest.approx(9.80665 * xyz_of(plain)[2])


def third(row):
    """The rows with another third one."""
    return lines(*ROWS[:2], row, ROWS[3])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", r"ride\.csv: .*empty"),
        ("# nothing\n\n", r"ride\.csv: .*only comments.*x \[m/s2\], y \[m/s2\], z \[m/s2\] \(or \[g\]\)"),
        (lines(), r"ride\.csv:1: .*header"),
        (lines(*ROWS[:2]), r"ride\.csv: .* 2 samples, .* 3"),
        (lines(*ROWS, header=""), r"ride\.csv:2: column 'time \[s\]' .*x \[m/s2\].*'0', '0\.1', '0\.2', '0\.3'"),
        (lines(*ROWS, header=HEADER.replace("z", "w")), r"ride\.csv: column z .*z \[m/s2\].* x, y, w"),
        (lines(*ROWS, header="time [s],x [m/s2],y [m/s2]"), r"ride\.csv:2:4: .* 4 cells, .* 3"),
        (lines(*ROWS, header=HEADER.replace("y", "x")), r"ride\.csv:1: column 'x \[m/s2\]' .*twice"),
        (lines(*ROWS, header=HEADER.replace("y [m/s2]", "x [g]")), r"ride\.csv:1: column 'x' .*twice"),
        (lines(*ROWS, header="time,x,y,z"), r"ride\.csv:1: column 'time \[s\]' .*x \[m/s2\].* 'time', 'x', 'y', 'z'"),
        (lines(*ROWS, header=HEADER.replace("x [m/s2]", "x [mm/s2]")), r"'x' .* 'mm/s2' .*\[m/s2\]"),
        (third("0,002,0.2,-0.2,0.1"), r"ride\.csv:4:5: .* 5 cells, .* 4; .*';'"),
        (third("0.002,0.2,-0.2"), r"ride\.csv:4:3: .* 3 cells, .* 4"),
        (third("0.002,0.2,nan,0.1"), r"ride\.csv:4:3: column 'y \[m/s2\]' is 'nan'"),
        *(
            (third(f"0.002,{cell},0.2,0.1"), rf"ride\.csv:4:2: column 'x \[m/s2\]' is '{cell}'")
            for cell in ("inf", "", "#N/A", "1e400", "1_0")
        ),
        (lines(*ROWS, ROWS[0]), r"ride\.csv:6: time 0 s .* 0\.003 s of line 5.* two logs"),
        (lines(*ROWS, ROWS[3]), r"ride\.csv:6: time 0\.003 s repeats 0\.003 s of line 5"),
        (lines(*ROWS, "0.0043,0,0,0"), r"ride\.csv:6: .* 0\.0013 s .* 0\.001 s .* 0\.3"),
        (lines(*ROWS, "0.004,0,0,980"), r"'z' deviates by 784 m/s2 .* 50; .*mm/s2"),
        (b"time [s]\xff", r"ride\.csv:1: column 'time \[s\]' .* 'time \[s\]ÿ"),
        (b"time [s]\n\0", r"ride\.csv:2:1: .*NUL"),
        (HEADER + "\n" + "1" * 1_000_001, r"ride\.csv:2: .* 1000000 characters"),
    ],
)
def test_a_damaged_file_is_refused_with_the_place(write, text, message):
    with pytest.raises(DataError, match=message):
        read_acceleration(write(text))


def test_a_missing_file_and_a_folder_are_refused(tmp_path):
    for path in (tmp_path / "nix.csv", tmp_path):
        with pytest.raises(ConfigurationError, match=f"{path.name}: .*does not exist"):
            read_acceleration(path)


def test_a_dead_axis_and_aliased_content_are_noticed(write):
    time = np.arange(2000) * 1e-3
    rows = [f"{t:.3f},0.5,{np.sin(2 * np.pi * 450 * t):.6f},{np.sin(2 * np.pi * 8 * t):.6f}" for t in time]
    dead, aliased = read_acceleration(write(lines(*rows))).notices
    assert dead.startswith("x: constant at 0.5 m/s2") and aliased.startswith("y: 100 % ") and "400 Hz" in aliased
