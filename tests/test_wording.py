"""Errors in Python name arguments, those of a command its options; each message is written once."""

import inspect
import subprocess
import sys
from types import SimpleNamespace
from typing import Any

import pytest

import vehicle
from tests.patience import HANG
from vehicle import Car, Choice, VehicleError, compare, evaluate_comfort, optimise, road, save_run, sweep
from vehicle.commands.shaker import main as shaker
from vehicle.errors import ConfigurationError
from vehicle.studies.design.ride_solution import RideProblem, Target
from vehicle.wording import ARGUMENTS, SWITCHES, in_words

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
        (
            "set --delay fl_acc_z=12.3ms or --delay fr_acc_z=5us",
            'set delay={"fl_acc_z": 0.0123} or delay={"fr_acc_z": 5e-06}',
        ),
        ("set --delay -0.25, or --delay GROUP=TIME", 'set delay=-0.25, or delay={"GROUP": TIME}'),
        ("--delay nil=...: must be", 'delay={"nil": ...}: must be'),
        ("--channel fl='acc front right' --highpass 0.5", 'channels={"fl": "acc front right"} highpass=0.5'),
        ("set --map 'fl=acc front' --map fr=3 --rate 9", 'set channels={"fl": "acc front", "fr": "3"} rate=9'),
        ("--unit speed=km/h or speed=m/s", 'units={"speed": "km/h"} or units={"speed": "m/s"}'),
        (
            "--channel x=NAME, y=NAME or z=NAME",
            'channels={"x": "NAME"}, channels={"y": "NAME"} or channels={"z": "NAME"}',
        ),
        ("set --map POINT=NODE for", 'set mapping={"POINT": "NODE"} for'),
        ("set --channel POINT, one of seat_rail", "set point=POINT, one of seat_rail"),
        ("--place feet: has", 'contact="feet": has'),
        ("--positive compression: if not, --positive extension", "compression=True: if not, compression=False"),
        ("--condition current=0.5: has", 'conditions={"current": "0.5"}: has'),
        ("if so, set --turn seat_acc_z --turn fl_acc_z", 'if so, set inverted=["seat_acc_z", "fl_acc_z"]'),
        ("--dbc bus.dbc: has no", 'databases=["bus.dbc"]: has no'),
        ("--limit travel<=0.06: has", 'limits=["travel<=0.06"]: has'),
        ("--tolerance mass=5%: has", 'tolerances={"mass": "5%"}: has'),
        ("--drift 200000: at most 100000 ppm", "drift=200000e-6: at most 100000 ppm"),
        ("--each 120 %: must be", "share=1.2: must be"),
        ("--each 200 mm: must be", "shift=0.2: must be"),
        ("set --from 2 --to 3.5", "set first=2 last=3.5"),
        ("between --from and --to", "between first and last"),
    ],
)
def test_options_become_arguments(option, argument, python):
    assert in_words(option) == argument and in_words(argument) == argument


@pytest.mark.parametrize(
    "text",
    [
        "(python -m vehicle trust --list)",
        "--from sedan: needs two axles",
        "continue with --resume",
        "or run without --video",
        "check with report --targets, or search",
        "shaker --remove-mean",
        "fewer --levels, another --reference, add --frf FILE, or --posterior",
        "set --input FILE",
        "set --rpm 700:3000, or --speed 20:80:5",
        "--executor dask://host:1: has no",
        "input 'a --to 3.csv' is missing",
        'folder "b --skip 2" is missing',
        "/data/--rate 5/a.csv: is missing",
    ],
)
def test_what_python_lacks_and_names_of_the_user_stay(text, python):
    assert in_words(text) == text


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


def test_an_impossible_iterate_is_explained_by_its_target_in_python_too(python):
    targets: Any = [Target(name=f"damping_ratio_{word}", value=0.3, paths=()) for word in ("front", "rear")]
    problem: Any = SimpleNamespace(targets=targets, unreachable_error=targets.__getitem__)
    error: Any = ConfigurationError("--damping-ratio-rear --skip 2")
    assert RideProblem.explained_error(problem, error) == targets[1]


def test_each_argument_is_one_of_a_public_function():
    public = (getattr(vehicle, name) for name in vehicle.__all__)
    functions: list[Any] = [each for each in public if inspect.isfunction(each)] + [
        Choice,
        road,
        Car.run,
        Car.modes,
        Car.with_,
    ]
    switches = {name.replace("-", "_") for name in SWITCHES}
    known = {name for each in functions for name in inspect.signature(each).parameters}
    assert {*ARGUMENTS.values(), *switches, "mapping", "point", "share", "shift", "overrides"} <= known
