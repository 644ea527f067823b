"""Errors in Python name arguments, those of a command its options; each message is written once."""

import inspect
import subprocess
import sys

import pytest

import vehicle
from tests.patience import HANG
from vehicle import Car, Choice, VehicleError, compare, evaluate_comfort, optimise, road, save_run, sweep
from vehicle.commands.shaker import main as shaker
from vehicle.wording import ARGUMENTS, in_words

VARY = {"front.damper.viscous": (800.0, 4000.0)}


@pytest.fixture
def python(monkeypatch):
    """Read messages as Python does."""
    monkeypatch.setattr("vehicle.wording._commands", 0)


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    """A saved run."""
    car = Car.load("focus")
    return save_run(car.run("bump_1p5mm.csv", "reduced"), tmp_path_factory.mktemp("saved") / "run", figures=False)


CALLS = {
    "skip=70 ": lambda folder: Car.load().run("low.csv", skip=70.0),
    "damper.viscos=1": lambda folder: Car.load(None, ["damper.viscos=1"]),
    "damper.viscos": lambda folder: Car.load().with_({"damper.viscos": 1}),
    "drift=200000": lambda folder: compare(folder, folder / "frf.csv", drift=0.2),
    "cars=4": lambda folder: optimise(Car.load(), VARY, "low.csv", ["unweighted"], cars=4),
    "measure.*'travl'": lambda folder: sweep(Car.load(), {"damper.viscous": [9.0]}, "low.csv", measure="travl"),
    "force=True": lambda folder: save_run(vehicle.load_run(folder), folder),
    "first=2 last=1": lambda folder: Choice(first=2.0, last=1.0),
    'units={"": "furlong"}': lambda folder: Choice(units={"z": "furlong"}),
    "channels": lambda folder: evaluate_comfort(folder / "time.npz", choice=Choice(channels={"q": "3"})),
    'tyre="standing"': lambda folder: Car.load("sedan", {"driving.speed": 9}).run(road("B", 80, tyre="standing")),
}


@pytest.mark.parametrize("words", CALLS)
def test_an_error_in_python_names_the_argument_and_its_value(words, saved, python):
    with pytest.raises(VehicleError, match=words.replace("{", r"\{")) as caught:
        CALLS[words](saved)
    assert "--" not in str(caught.value)


@pytest.mark.parametrize(
    ("option", "argument"),
    [
        ("give --force, or another --output", "give force=True, or another folder"),
        ("--output runs/x: exists", "runs/x: exists"),
        ("set --set front.damper.viscous=3", "set front.damper.viscous=3"),
        ("set --unit z=m/s2 or --unit z=g if", 'set units={"z": "m/s2"} or units={"z": "g"} if'),
        ("add --vary PATH=LOW:HIGH, once", 'add vary={"PATH": (LOW, HIGH)}, once'),
        ("--road nowhere.csv: unknown", 'road="nowhere.csv": unknown'),
        ("--band 3:45", "band=(3, 45)"),
        ("use --vehicle focus_road, or", 'use Car.load("focus_road"), or'),
        ("(python -m vehicle trust --list)", "(python -m vehicle trust --list)"),
    ],
)
def test_options_become_arguments(option, argument, python):
    assert in_words(option) == argument and in_words(argument) == argument


def test_a_command_keeps_its_options(python, capsys, tmp_path):
    code = shaker(["--input", "low.csv", "--set", "damper.viscos=1", "--output", str(tmp_path / "run")])
    assert code == 2 and "--set damper.viscos=1" in capsys.readouterr().err


def test_workers_of_a_command_keep_them_too():
    code = (
        "from vehicle.studies.sweeps.executors import process_pool\n"
        "from vehicle.wording import in_words, speak_options\n"
        "if __name__ == '__main__':\n"
        "    for _ in range(2):\n"
        "        with process_pool(1) as pool: print(pool.submit(in_words, '--skip 2').result())\n"
        "        speak_options()\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=HANG)
    assert done.stdout.split() == ["skip=2", "--skip", "2"], done.stderr


def test_arguments_of_other_names_exist():
    functions = (vehicle.sweep, optimise, compare, vehicle.read, Choice, road, save_run, vehicle.parameter_effects)
    assert set(ARGUMENTS.values()) <= {name for each in functions for name in inspect.signature(each).parameters}
