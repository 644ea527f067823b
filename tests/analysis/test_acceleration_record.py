import numpy as np
import pytest

from vehicle.analysis.acceleration_record import read_acceleration
from vehicle.errors import ConfigurationError, DataError

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
    assert record.time_step == pytest.approx(1e-3, rel=1e-12)
    assert record.xyz == pytest.approx(np.array([[0.1, -0.1, 0.2, 0.3], [0.2, 0.4, -0.2, 0.1], [0.3, 0.5, 0.1, -0.4]]))


@pytest.mark.parametrize(
    "text",
    [
        pytest.param("\ufeff" + lines(*ROWS), id="byte order mark"),
        pytest.param(lines(*ROWS).replace("\n", "\r\n"), id="CRLF"),
        pytest.param(lines(*ROWS).replace(",", " , "), id="blanks"),
        pytest.param(lines(*ROWS).rstrip(), id="no last line end"),
    ],
)
def test_harmless_oddities_change_nothing(write, text):
    plain = read_acceleration(write(lines(*ROWS)))
    assert read_acceleration(write(text)).xyz == pytest.approx(plain.xyz, rel=1e-15)


def test_columns_may_stand_in_any_order_and_units(write):
    rows = [",".join((c[3], c[0], c[2], c[1])) for c in (row.split(",") for row in ROWS)]
    record = read_acceleration(write(lines(*rows, header="z [g],time [s],y [m/s^2],x [m/s²]")))
    plain = read_acceleration(write(lines(*ROWS)))
    assert record.xyz[:2] == pytest.approx(plain.xyz[:2])
    assert record.xyz[2] == pytest.approx(9.80665 * plain.xyz[2])


NEEDED = r"needed are time \[s\], x \[m/s2\], y \[m/s2\], z \[m/s2\] \(or \[g\]\)"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", r"ride.csv: empty; needed are a header and samples"),
        ("# nothing\n\n", r"ride.csv: empty"),
        (lines(), r"ride.csv: 0 samples after the header, at least 3 are needed"),
        (lines(*ROWS, header=""), rf"ride.csv:2: unknown column '0'; found 0, 0.1, 0.2, 0.3; {NEEDED}"),
        (
            lines(*ROWS, header=HEADER.replace("z", "w")),
            rf"ride.csv:1: unknown column 'w \[m/s2\]'; found time .*{NEEDED}",
        ),
        (lines(*ROWS, header="time [s],x [m/s2],y [m/s2]"), rf"ride.csv:1: no column z; found .*{NEEDED}"),
        (lines(*ROWS, header=HEADER.replace("y", "x")), r"ride.csv:1: column 'x' appears twice"),
        (lines(*ROWS, header="time,x,y,z"), r"ride.csv:1: column 'time' has the unit '', allowed are \[s\]; write the"),
        (lines(*ROWS, header=HEADER.replace("x [m/s2]", "x [mm/s2]")), r"column 'x' has the unit 'mm/s2', allowed are"),
        (lines(*ROWS).replace(",", ";"), r"ride.csv:1: columns are separated by semicolons; save the file with commas"),
        (lines(*ROWS).replace(",", "\t"), r"ride.csv:1: columns are separated by tabs"),
        (
            lines(*ROWS[:2], "0,002,0.2,-0.2,0.1", ROWS[3]),
            r"ride.csv:4: 5 values, the header names 4 columns; a decimal",
        ),
        (lines(*ROWS[:2], "0.002,0.2,-0.2", ROWS[3]), r"ride.csv:4: 3 values, the header names 4 columns"),
        (
            lines(*ROWS[:2], "0.002,0.2,nan,0.1", ROWS[3]),
            r"ride.csv:4: column 'y' holds 'nan', needed is a finite number",
        ),
        (lines(*ROWS[:2], "0.002,inf,0.2,0.1", ROWS[3]), r"ride.csv:4: column 'x' holds 'inf'"),
        (lines(*ROWS[:2], "0.002,,0.2,0.1", ROWS[3]), r"ride.csv:4: column 'x' holds ''"),
        (lines(*ROWS[:2], "0.002,#N/A,0.2,0.1", ROWS[3]), r"ride.csv:4: column 'x' holds '#N/A'"),
        (lines(*ROWS[:2], "0.002,1e400,0.2,0.1", ROWS[3]), r"ride.csv:4: column 'x' holds '1e400'"),
        (lines(*ROWS[:2], "0.002,1_0,0.2,0.1", ROWS[3]), r"ride.csv:4: column 'x' holds '1_0'"),
        (lines(*ROWS, ROWS[0]), r"ride.csv:6: time 0 s does not come after 0.003 s; two records in one file\?"),
        (lines(*ROWS, ROWS[3]), r"ride.csv:6: time 0.003 s does not come after 0.003 s"),
        (lines(*ROWS, "0.0041,0,0,0"), r"ride.csv:6: time step 0.0011 s, the median is 0.001 s; allowed is a relative"),
        (
            lines(*ROWS, "0.004,0,0,980"),
            r"column 'z' swings by 783\.9 m/s2 about its mean, allowed are 50; looks like mm",
        ),
        (b"time [s]\xff", r"ride.csv:1: byte 0xff is not UTF-8; save the file as UTF-8"),
        (b"time [s]\n\0", r"ride.csv:2: a NUL byte; needed is a CSV file in UTF-8"),
        (HEADER + "\n" + "1" * 1_000_001, r"ride.csv:2: a line of 1000001 characters, allowed are 1000000"),
    ],
)
def test_a_damaged_file_is_refused_with_the_place(write, text, message):
    with pytest.raises(DataError, match=message):
        read_acceleration(write(text))


def test_a_missing_file_and_a_folder_are_refused(tmp_path):
    with pytest.raises(ConfigurationError, match=r"nix.csv: no such file"):
        read_acceleration(tmp_path / "nix.csv")
    with pytest.raises(ConfigurationError, match="not a file; give a CSV file"):
        read_acceleration(tmp_path)


def test_a_dead_axis_and_aliased_content_are_noticed(write):
    time = np.arange(2000) * 1e-3
    rows = [f"{t:.3f},0.5,{np.sin(2 * np.pi * 450 * t):.6f},{np.sin(2 * np.pi * 8 * t):.6f}" for t in time]
    assert read_acceleration(write(lines(*rows))).notices == (
        "x: constant at 0.5 m/s2 (no sensor?)",
        "y: 100 % of the variance lies above 400 Hz (0.8 of Nyquist); the record may be aliased",
    )


def test_a_file_beyond_the_limit_is_refused_before_it_is_read(tmp_path):
    path = tmp_path / "huge.csv"
    with path.open("wb") as file:
        file.truncate(300 * 1024 * 1024)  # sparse: takes no room
    with pytest.raises(DataError, match=r"huge.csv: 314572800 bytes, allowed are 268435456; cut the record into parts"):
        read_acceleration(path)
