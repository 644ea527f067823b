"""--accept-advice: each option once, a limited number of rounds, a single file."""

import numpy as np
import pytest

from vehicle.commands.accepted_advice import ROUNDS, retried
from vehicle.commands.comfort import main as comfort
from vehicle.commands.command_line import command
from vehicle.commands.compare import main as compare
from vehicle.commands.console import Console
from vehicle.commands.input_options import record_options
from vehicle.commands.options import command_parser, message_options
from vehicle.commands.spectra import main as spectra
from vehicle.signals.records.finding import Finding, FindingError

TURN = Finding("a: inverted", "sign", ("--turn", "a"))


def test_an_accepted_option_is_left_out():
    """A second --turn turned the channel back."""
    options = Console(words=("F", "--turn", "a"), accept_advice=True, accepted={("--turn", "a")}, quiet=True)
    level = Finding("b: in g", "unit", ("--unit", "b=g"))
    assert retried(FindingError("", [TURN, level]), options) == ["F", "--turn", "a", "--unit", "b=g"]
    assert retried(FindingError("", [TURN]), options) is None


def test_the_rounds_are_limited(capsys):
    """A finding with another option each time ended never."""
    rounds = []

    def parser():
        made = command_parser("test", "A test.")
        record_options(made, "")
        message_options(made, quiet=True)
        return made

    def job(options, console):
        rounds.append(options)
        raise FindingError("F", [Finding(f"finding {len(rounds)}", "constant", ("--from", f"{len(rounds)}"))])

    assert command(parser, lambda options: options, job)(["--accept-advice"]) == 3
    assert len(rounds) == ROUNDS + 1 and f"error: F: finding {ROUNDS + 1}" in capsys.readouterr().err


def written(path, mean):
    time = np.arange(3000) / 100.0
    rows = [f"{t:.2f},{mean + np.sin(20.0 * t):.6f}" for t in time]
    path.write_text("\n".join(["Time [s],Seat Z [m/s2]", *rows, ""]))
    return str(path)


@pytest.mark.parametrize("main", [comfort, spectra, compare])
def test_several_files_have_no_common_advice(tmp_path, capsys, main):
    files = [written(tmp_path / f"{name}.csv", 19.6133) for name in "ab"]
    option = {comfort: ["--input"], spectra: [], compare: ["run", "--measured"]}[main]
    assert main([*option, *files, "--accept-advice"]) == 2
    assert "--accept-advice needs a single file; run the command once for each file" in capsys.readouterr().err
    if main is comfort:  # an error of findings was a TypeError
        assert main([*option, *files, "--channel", "z=Seat Z"]) == 3
        assert "2 of 2 files have no result" in capsys.readouterr().err


def test_spectra_use_the_advice(tmp_path, capsys):
    file = written(tmp_path / "a.csv", 19.6133)
    words = [file, "--channel", "seat_acc_z=Seat Z", "--output", str(tmp_path / "s")]
    assert spectra(words) == 3
    assert spectra([*words, "--accept-advice"]) == 0
    assert "accepted: seat_acc_z: the mean is 19.6" in capsys.readouterr().err


def test_gravity_that_is_kept_is_mentioned(tmp_path, capsys):
    assert comfort(["--input", written(tmp_path / "a.csv", 9.80665), "--channel", "z=Seat Z", "--offset", "keep"]) == 0
    assert "gravity is included in the mean" in capsys.readouterr().err
