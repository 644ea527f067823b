"""File of an FMU: valid for FMPy, equal bytes, libraries of these sources, refusals of the command."""

import json
import zipfile
from pathlib import Path

import pytest

from tools.core import FMU_BINARIES, PRODUCTS, stamp_of
from vehicle.commands.fmu import main
from vehicle.errors import ConfigurationError
from vehicle.handover.fmu.fmu_file import PLATFORMS, write_fmu
from vehicle.runs.car import Car

LIBRARIES = {
    "2": {"linux64/car.so", "win64/car.dll", "darwin64/car.dylib"},
    "3": {"x86_64-linux/car.so", "x86_64-windows/car.dll", "x86_64-darwin/car.dylib", "aarch64-darwin/car.dylib"},
}


def test_the_libraries_are_built_from_these_sources():
    stamp = json.loads((FMU_BINARIES / "stamp.json").read_text())
    for name in ("fmu", "page"):
        assert stamp[name] == stamp_of(PRODUCTS[name]), "build the libraries again: make core"
    assert set(PRODUCTS["fmu"].platforms) == set(PLATFORMS)
    names = [*stamp["fmu"]["libraries"], *stamp["page"]["libraries"]]
    assert not any(b"/work" in (FMU_BINARIES / name).read_bytes() for name in names)


def test_fmpy_finds_nothing_wrong(focus_fmu):
    from fmpy.validation import validate_fmu

    assert validate_fmu(str(focus_fmu.path)) == []
    version = focus_fmu.description.fmiVersion[0]
    with zipfile.ZipFile(focus_fmu.path) as archive:
        names = {name.removeprefix("binaries/") for name in archive.namelist() if name.startswith("binaries/")}
    assert names == LIBRARIES[version]
    assert focus_fmu.path.stat().st_size < 400_000
    units = {entry.name: entry.unit for entry in focus_fmu.description.modelVariables}
    assert units["plate_fr_velocity"] == "m/s" and units["damper_fl_coulomb_friction"] == "N"
    assert units["seat_rail_acc_z"] == "m/s2" and units["damper_fr_curve_scale"] is None
    assert "END of a communication step" in focus_fmu.description.description


def test_equal_cars_give_equal_bytes(tmp_path: Path, car: Car):
    first, second = (write_fmu(car, tmp_path / name).path.read_bytes() for name in ("a.fmu", "b.fmu"))
    assert first == second
    stiffer = write_fmu(car.with_(["front.damper.viscous=800"]), tmp_path / "c.fmu").path
    tokens = [zipfile.ZipFile(path).read("resources/car.bin")[8:48] for path in (tmp_path / "a.fmu", stiffer)]
    assert tokens[0] != tokens[1]


def test_command(tmp_path, capsys):
    path = tmp_path / "my car.fmu"
    arguments = ["focus", "--output", str(path), "--fmi", "3", "--channels", "suspension_travel_fr", "--step", "0.2"]
    assert main(arguments) == 0
    text = capsys.readouterr().out
    assert "FMI 3.0 co-simulation, 8 inputs, 4 parameters, 79 outputs" in text and "aarch64-darwin" in text
    assert "internal step 0.2 ms; set displacement and velocity of each plate" in text
    assert main(arguments) == 2 and "exists" in capsys.readouterr().err
    assert main([*arguments, "--force", "--quiet"]) == 0 and capsys.readouterr().out == ""


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--step", "0.6"], "--step 0.6: must be 0.001 to 0.5"),
        (["--step", "nan"], "--step nan: must be 0.001 to 0.5"),
        (["--step", "-0.1"], "--step -0.1: must be 0.001 to 0.5"),
        (["--speed", "-5"], "--speed -5: must be 0 to 300 km/h"),
        (["--speed", "80"], "focus also stands on the ground without wheels"),
        (["--fmi", "1"], "--fmi '1': must be one of "),
        (["--channels", "seat"], "--channels: the car has no channel 'seat'"),
        (["--output", "car.zip"], "car.zip"),
    ],
)
def test_refusals(arguments, message, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["focus", *arguments]) == 2
    assert message in capsys.readouterr().err
    assert not any(tmp_path.iterdir())


def test_refusals_in_python(car: Car, tmp_path: Path):
    for options, message in (
        ({"fmi": "1"}, "fmi: must be one of 2, 3, not '1'"),
        ({"step": 1e-2}, "step: found 0.01 s, must be 1e-06 to 0.0005 s"),
        ({"channels": ["nothing"]}, "nothing"),
        ({"channels": ["plate_fr_displacement"]}, "contains only plate displacements"),
    ):
        with pytest.raises(ConfigurationError, match=message):
            write_fmu(car, tmp_path / "car.fmu", **options)
    with pytest.raises(ConfigurationError, match=r"the name of an FMU must end in \.fmu"):
        write_fmu(car, tmp_path / "car.zip")
