"""`python -m vehicle --version` and `--print-completion`: the script is run by bash itself."""

import subprocess
import tomllib
from pathlib import Path

import pytest

from tests.patience import HANG
from vehicle.__main__ import main
from vehicle.commands import COMMANDS
from vehicle.core.library import variant

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def script(tmp_path_factory):
    from vehicle.commands.completion import completion_script

    file = tmp_path_factory.mktemp("shell") / "vehicle.bash"
    file.write_text(completion_script("bash"))
    return file


def completed(script, line):
    """Words that bash offers at the end of a line."""
    words = line.split(" ")
    code = (
        f"source {script}; COMP_WORDS=({' '.join(repr(word) for word in words)}); COMP_CWORD={len(words) - 1}; "
        "_vehicle; printf '%s\\n' \"${COMPREPLY[@]}\""
    )
    done = subprocess.run(["bash", "--norc", "-c", code], capture_output=True, text=True, timeout=HANG, check=True)
    assert done.stderr == ""
    return done.stdout.split()


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("vehicle ", list(COMMANDS)),
        ("vehicle fit-mount --law ", ["auto", "rubber", "hydromount", "decoupler"]),
        ("vehicle s", [name for name in COMMANDS if name.startswith("s")]),
        ("vehicle --v", ["--version"]),
        ("vehicle --print-completion ", ["bash", "zsh"]),
        ("vehicle shaker --eng", ["--engine"]),
        ("vehicle shaker --engine ", ["mujoco", "reduced", "auto"]),
        ("vehicle shaker --engine r", ["reduced"]),
        ("vehicle shaker --input lo", ["low.csv"]),
        ("vehicle shaker --output ", []),
        ("vehicle shaker ", []),
        ("vehicle body ", ["import", "build", "rigid", "show", "compare", "participation"]),
        ("vehicle body import modes.uff --le", ["--length-unit"]),
        ("vehicle body import --length-unit ", ["m", "mm", "in"]),
        ("python -m vehicle mod", ["modes"]),
        ("/usr/bin/python3 -m vehicle.modes --dam", ["--damper"]),
        ("python -m vehicle.modes --damper ", ["stuck", "sliding"]),
        ("python -m venv ", []),
        ("python run", []),
    ],
)
def test_bash_completes(script, line, words):
    assert completed(script, line) == words


def test_the_script_is_registered(script):
    code = f"source {script}; complete -p vehicle python python3"
    done = subprocess.run(["bash", "--norc", "-c", code], capture_output=True, text=True, timeout=HANG, check=True)
    names = ("vehicle", "python", "python3")
    assert done.stdout.splitlines() == [f"complete -o default -F _vehicle {name}" for name in names]


def test_another_shell_is_refused(capsys):
    assert main(["--print-completion", "zsh"]) == 0 and "bashcompinit" in capsys.readouterr().out
    assert main(["--print-completion", "fish"]) == 2
    assert capsys.readouterr().err == "error: --print-completion fish: must be bash or zsh\n"


@pytest.mark.parametrize("words", [[], ["shaker"], ["sweep"], ["body"], ["body", "import"]])
def test_the_version_is_that_of_the_project(words, capsys):
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    if words:
        with pytest.raises(SystemExit) as end:
            main([*words, "--version"])
        assert end.value.code == 0
    else:
        assert main(["--version"]) == 0
    core = "" if words else f", core {variant()}"
    assert capsys.readouterr().out == f"{project['name']} {project['version']}{core}\n"


def test_an_installed_package_has_the_version_of_its_metadata(monkeypatch):
    from vehicle import version

    monkeypatch.setattr(version, "__file__", "/nowhere/vehicle/version.py")
    assert version.package_version().startswith("vehicle-on-shaker ")
