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


NEEDED = r"needed are time \[s\], x \[m/s2\], y \[m/s2\], z \[m/s2\] \(or \[g\]\)"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", r"ride.csv: the file is empty; must have a header line with units and one row per sample"),
        (
            "# nothing\n\n",
            rf"ride.csv: contains only comments; {NEEDED.replace('needed are', 'must have the columns')}",
        ),
        (lines(), r"ride.csv:1: the file ends after the header"),
        (lines(*ROWS[:2]), r"ride.csv: contains 2 samples, must be at least 3"),
        (
            lines(*ROWS, header=""),
            rf"ride.csv:2: column 'time \[s\]' is missing; found '0', '0.1', '0.2', '0.3'; {NEEDED}",
        ),
        (
            lines(*ROWS, header=HEADER.replace("z", "w")),
            rf"ride.csv: column z is missing; found x, y, w; {NEEDED}",
        ),
        (lines(*ROWS, header="time [s],x [m/s2],y [m/s2]"), r"ride\.csv:2:4: the row has 4 cells, but the header"),
        (lines(*ROWS, header=HEADER.replace("y", "x")), r"ride.csv:1: column 'x \[m/s2\]' appears twice"),
        (lines(*ROWS, header=HEADER.replace("y [m/s2]", "x [g]")), r"ride.csv:1: column 'x' appears twice"),
        (
            lines(*ROWS, header="time,x,y,z"),
            rf"ride.csv:1: column 'time \[s\]' is missing; found 'time', 'x', 'y', 'z'; {NEEDED}",
        ),
        (lines(*ROWS, header=HEADER.replace("x [m/s2]", "x [mm/s2]")), r"'x' has the unit 'mm/s2', must be one of"),
        (
            lines(*ROWS[:2], "0,002,0.2,-0.2,0.1", ROWS[3]),
            (
                "ride\\.csv:4:5: the row has 5 cells, but the header 4; with decimal commas, separate "
                "the columns by ';', in the header too, because"
            ),
        ),
        (lines(*ROWS[:2], "0.002,0.2,-0.2", ROWS[3]), r"ride\.csv:4:3: the row has 3 cells, but the header"),
        (
            lines(*ROWS[:2], "0.002,0.2,nan,0.1", ROWS[3]),
            r"ride.csv:4:3: column 'y \[m/s2\]' is 'nan', must be a finite number; repair",
        ),
        (lines(*ROWS[:2], "0.002,inf,0.2,0.1", ROWS[3]), r"ride\.csv:4:2: column 'x \[m/s2\]' is 'inf', must be"),
        (lines(*ROWS[:2], "0.002,,0.2,0.1", ROWS[3]), r"ride\.csv:4:2: column 'x \[m/s2\]' is '', must be"),
        (lines(*ROWS[:2], "0.002,#N/A,0.2,0.1", ROWS[3]), r"ride\.csv:4:2: column 'x \[m/s2\]' is '#N/A', must be"),
        (lines(*ROWS[:2], "0.002,1e400,0.2,0.1", ROWS[3]), r"ride\.csv:4:2: column 'x \[m/s2\]' is '1e400', must be"),
        (lines(*ROWS[:2], "0.002,1_0,0.2,0.1", ROWS[3]), r"ride\.csv:4:2: column 'x \[m/s2\]' is '1_0', must be"),
        (lines(*ROWS, ROWS[0]), r"ride.csv:6: time 0 s is before the time 0.003 s of line 5; .* two logs"),
        (lines(*ROWS, ROWS[3]), r"ride.csv:6: time 0.003 s repeats the time 0.003 s of line 5"),
        (
            lines(*ROWS, "0.0043,0,0,0"),
            (
                "ride\\.csv:6: time steps are not uniform: a step of 0\\.0013 s deviates from the median "
                "0\\.001 s by the factor 0\\.3"
            ),
        ),
        (
            lines(*ROWS, "0.004,0,0,980"),
            r"column 'z' deviates by 783\.9 m/s2 from its mean, must be at most 50; is the unit mm",
        ),
        (b"time [s]\xff", r"ride\.csv:1: column 'time \[s\]' is missing; found 'time \[s\]ÿ"),
        (b"time [s]\n\0", r"ride\.csv:2:1: contains a NUL character, so this is a"),
        (HEADER + "\n" + "1" * 1_000_001, r"ride\.csv:2: the line is longer than 1000000 characters"),
    ],
)
def test_a_damaged_file_is_refused_with_the_place(write, text, message):
    with pytest.raises(DataError, match=message):
        read_acceleration(write(text))


def test_a_missing_file_and_a_folder_are_refused(tmp_path):
    with pytest.raises(ConfigurationError, match=r"nix\.csv: the file does not"):
        read_acceleration(tmp_path / "nix.csv")
    with pytest.raises(ConfigurationError, match="the file does not exist"):
        read_acceleration(tmp_path)


def test_a_dead_axis_and_aliased_content_are_noticed(write):
    time = np.arange(2000) * 1e-3
    rows = [f"{t:.3f},0.5,{np.sin(2 * np.pi * 450 * t):.6f},{np.sin(2 * np.pi * 8 * t):.6f}" for t in time]
    assert read_acceleration(write(lines(*rows))).notices == (
        "x: constant at 0.5 m/s2; is the sensor missing?",
        (
            "y: 100 % of the variance lies above 400 Hz (0.8 of half the sampling rate); was it recorded without an "
            "anti-alias filter?"
        ),
    )
