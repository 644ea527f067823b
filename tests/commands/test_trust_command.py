"""`vehicle trust`: the list of native code that a user allows, in a folder of his own."""

import hashlib
import json
import sys

import pytest

from vehicle.commands import trust
from vehicle.core.trusted_code import trusted_list


@pytest.fixture
def config(tmp_path, monkeypatch):
    folder = tmp_path / "config"
    monkeypatch.setenv("XDG_CONFIG_HOME", str(folder))
    monkeypatch.setenv("APPDATA", str(folder))
    return folder


def test_a_file_is_allowed_listed_and_removed(config, tmp_path, capsys):
    file = tmp_path / "a controller\n.fmu"
    file.write_bytes(b"native")
    digest = hashlib.sha256(b"native").hexdigest()
    assert trust.main([str(file)]) == 0 and trust.main([str(file)]) == 0
    capsys.readouterr()
    assert trust.main(["--list"]) == 0
    shown = str(file.resolve()).replace("\n", "?")
    assert capsys.readouterr().out == f"list        {trusted_list()}, 1 entry\n  {digest}  {shown}\n"
    assert trust.main(["--json"]) == 0
    assert json.loads(capsys.readouterr().out) == {"file": str(trusted_list()), "trusted": {digest: shown}}
    assert trust.main(["--remove", digest[:6].upper()]) == 0
    assert capsys.readouterr().out == f"removed     {digest}  {shown}\n"
    assert trust.main(["--list"]) == 0
    assert capsys.readouterr().out == f"list        {trusted_list()}, no entries\n"


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ([], "error: name an FMU to allow, or type --list or --remove DIGEST"),
        (["missing.fmu"], "error: missing.fmu: cannot be read (No such file or directory)"),
        (["--remove", "abc"], "error: --remove abc: no entries"),
        (["--remove", ""], "error: --remove : no entries"),
    ],
)
def test_what_cannot_be_done_is_one_message(config, words, message, capsys):
    assert trust.main(words) == 2
    said = capsys.readouterr()
    assert said.err.startswith(message) and said.err.count("\n") == 1 and said.out == ""
    assert not config.exists()


@pytest.mark.skipif(sys.platform == "win32", reason="permissions of POSIX")
def test_a_list_that_others_can_change_allows_nothing(config, tmp_path, capsys):
    (tmp_path / "a.fmu").write_bytes(b"native")
    assert trust.main([str(tmp_path / "a.fmu")]) == 0
    assert trusted_list().stat().st_mode & 0o077 == 0 and trusted_list().parent.stat().st_mode & 0o077 == 0
    trusted_list().chmod(0o666)
    capsys.readouterr()
    assert trust.main(["--list"]) == 2
    assert "yours alone: chmod 600" in capsys.readouterr().err


def test_lines_that_are_no_entries_count_for_nothing(config, capsys):
    trusted_list().parent.mkdir(parents=True)
    trusted_list().write_text("# note\n" + "0" * 63 + "  short\n" + "f" * 64 + "  good.fmu\n")
    trusted_list().chmod(0o600)
    assert trust.main(["--list"]) == 0
    assert capsys.readouterr().out.splitlines()[1:] == ["  " + "f" * 64 + "  good.fmu"]
