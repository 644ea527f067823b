"""What a command prints: nothing that steers a terminal, one line for what belongs together."""

import sys

import pytest

from vehicle.commands import inspect
from vehicle.commands.command_line import run_command
from vehicle.commands.console import ProgressLine, folded
from vehicle.commands.printable import PrintableStream, printable
from vehicle.errors import DataError


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("a\x1b[2Jb", "a\\x1b[2Jb"),
        ("a\u202eb\u200b", "a\\u202eb\\u200b"),
        ("\x9b31m\r\x07", "\\x9b31m\\r\\x07"),
        ("Prüfstand µm m/s²\u00a0\tx\n", "Prüfstand µm m/s²\u00a0\tx\n"),
    ],
)
def test_control_characters_are_shown_as_escapes(text, shown):
    assert printable(text) == shown


def test_names_of_a_file_are_printed_without_their_escapes(tmp_path, capsys):
    rows = "".join(f"{n / 1000},{n % 7}\n" for n in range(50))
    (tmp_path / "a.csv").write_text(f"time [s],Seat \x1b[2J Z [m/s2]\n{rows}", encoding="utf-8")
    assert inspect.main([str(tmp_path / "a.csv")]) == 0
    said = capsys.readouterr()
    assert "Seat \\x1b[2J Z" in said.out and "\x1b" not in said.out + said.err


def test_errors_and_nested_commands_are_printed_once_escaped(capsys):
    def inner() -> None:
        assert isinstance(sys.stdout, PrintableStream) and not isinstance(sys.stdout.stream, PrintableStream)
        raise DataError("bad \x1b name")

    assert run_command(lambda: print(run_command(inner))) == 0
    assert capsys.readouterr() == ("3\n", "error: bad \\x1b name\n")
    assert not isinstance(sys.stdout, PrintableStream)


def test_a_bar_still_returns_to_the_begin_of_its_line(capsys, monkeypatch):
    def job() -> None:
        assert isinstance(sys.stderr, PrintableStream)
        monkeypatch.setattr(sys.stderr.stream, "isatty", lambda: True, raising=False)
        line = ProgressLine("work")
        line(1.0)

    assert run_command(job) == 0
    assert "\rwork [" in capsys.readouterr().err


def test_chosen_channels_are_one_line():
    """Equal names are no news; the content of a file is that of `inspect`."""
    chosen = [f"a.csv: hub_{number}: channel {number} 'Hub {number}' [g]" for number in range(6)]
    others = ["a.uff: seat_acc_z/plate_fl: channel 9 'seat_acc_z / plate_fl'", "a.uff: 14 nodes, 2 lines and elements"]
    clipped = "a.csv: hub_1: channel 1 'Hub 1' [g]; clipped at 5 g"
    first, *rest = folded([*chosen[:3], clipped, *others, *chosen[3:]])
    assert rest == [clipped] and first.count(" is channel ") == 4 and first.endswith(" and 2 more")
    assert first.startswith("a.csv: hub_0 is channel 0 'Hub 0' [g], hub_1 is ") and folded(others) == []
