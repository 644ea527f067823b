"""A car from somebody else runs no native code: FMUs with their own permission, laws by address, sources of a core."""

import ctypes
import hashlib
import shutil
import subprocess
import zipfile
from pathlib import Path

import pytest

from tests.faults.table import has_compiler
from tests.faults.user import in_fork
from tests.model.laws.controller_files import controller_fmu
from tests.system.test_hostile_folder import tree
from vehicle.__main__ import main
from vehicle.commands import COMMANDS
from vehicle.commands.command_line import FAULT
from vehicle.core.trusted_code import trusted_list

pytestmark = pytest.mark.skipif(not has_compiler(), reason="the native code needs Linux and a C compiler")

NATIVE = """
#include <stdio.h>
__attribute__((constructor)) static void loaded(void) { FILE *file = fopen("%s", "a"); if (file) fclose(file); }
"""
"""Source of a library that makes a file as soon as it is loaded."""

CARS = {
    "controller": 'control.law = "fmu"\ncontrol.minimum_damping = 300.0\ncontrol.maximum_damping = 4000.0\n'
    'control.control_period = 0.002\ncontrol.fmu = "controller.fmu"\ncontrol.fmu_sha256 = "{digest}"',
    "law": 'function = "evil"',
    "friction": 'friction_function = "evil"',
}
"""What the damper of each car runs."""

SHORT = ("--engine", "reduced", "--input", "short.csv", "--quiet")

WORDS = {
    "shaker": (*SHORT, "--vehicle", "CAR", "--no-figures", "--output", "out"),
    "modes": ("--vehicle", "CAR"),
    "sweep": (*SHORT, "--vehicle", "CAR", "--vary", "rear.damper.viscous=1500,1600", "--output", "out"),
    "comfort": ("--input", "RUN/time.npz", "--channel", "seat_rail"),
    "mjcf": ("--vehicle", "CAR", "--output", "out"),
    "show": ("CAR", "--output", "out"),
    "levels": ("CAR", "--frequency", "5,8", "--level", "0.1,1", "--output", "out"),
    "kinematics": ("--vehicle", "CAR", "--axle", "front", "--travel", "0:10:10", "--output", "out"),
    "road": ("--vehicle", "CAR", "--class", "C", "--speed", "80", "--duration", "2", "--output", "out/road.csv"),
    "inspect": ("controller.fmu",),
    "loads": ("RUN", "--output", "out"),
    "spectra": ("RUN", "--output", "out"),
    "orders": ("--vehicle", "CAR", "--set", "front.imbalance.mass=0.01", "--set", "front.imbalance.radius=0.2",
               "--speed", "100", "--duration", "4", "--output", "out"),
    "body": ("participation", "--vehicle", "CAR", "--output", "out"),
    "compare": ("RUN", "--measured", "RUN/time.npz", "--map", "seat_rail_acc_z=seat_rail_acc_z", "--no-figures",
                "--output", "out"),
    "report": ("RUN", "--output", "out/report.html"),
    "drive": ("--vehicle", "CAR", "--target", "RUN/time.npz", "--channel", "knuckle_fl_acc_z=knuckle_fl_acc_z",
              "--band", "2:20", "--iterations", "3", "--wheel", "front_left", "--output", "out"),
    "optimise": (*SHORT, "--vehicle", "CAR", "--vary", "rear.damper.viscous=1500:1600", "--minimise", "weighted",
                 "--cars", "8", "--population", "8", "--output", "out/search"),
    "tune": ("CAR", "--parameters", "rear.damper.viscous=300:4000", "--engine", "reduced", "--channels",
             "knuckle_fl_acc_z", "--record", "RUN/time.npz", "--output", "out"),
    "diagnose": ("RUN/time.npz", "--vehicle", "CAR", "--speed", "80", "--drives", "160", "--output", "out"),
    "fit-mount": ("controller.fmu", "--output", "out"),
    "fit-damper": ("controller.fmu", "--output", "out"),
    "new": ("out", "--from", "CAR", "--kerb-mass", "1450", "--wheelbase", "2.65", "--front-axle-load", "800",
            "--wheel-rate-front", "24000", "--tyre-stiffness-front", "210000"),
    "fmu": ("CAR", "--output", "out/car.fmu"),
    "trust": ("--list",),
}  # fmt: skip
"""Words of each command that does not wait for somebody; RUN is a run whose vehicle file was exchanged for the car."""


def library_of(folder: Path, witness: Path) -> Path:
    source, library = folder / "native.c", folder / "native.so"
    source.write_text(NATIVE % witness)
    subprocess.run(["cc", "-shared", "-fPIC", "-o", str(library), str(source)], check=True)
    return library


@pytest.fixture(scope="module")
def native(tmp_path_factory):
    """A library, and the file that it makes."""
    folder = tmp_path_factory.mktemp("native")
    return library_of(folder, folder / "witness"), folder / "witness"


@pytest.fixture
def archive(native, short_signal, tmp_path, monkeypatch):
    """The working folder, in which an archive with cars, an FMU and sources of a core was unpacked."""
    library, _ = native
    monkeypatch.chdir(tmp_path)
    controller_fmu(tmp_path / "whole.fmu")
    with zipfile.ZipFile("whole.fmu") as whole, zipfile.ZipFile("controller.fmu", "w") as fmu:
        for name in whole.namelist():
            fmu.writestr(name, library.read_bytes() if name.endswith(".so") else whole.read(name))
    digest = hashlib.sha256(Path("controller.fmu").read_bytes()).hexdigest()
    assert main(["shaker", *SHORT, "--vehicle", "sedan", "--no-figures", "--channels", "loads", "--output", "run"]) == 0
    for name, damper in CARS.items():
        text = f'base = "sedan"\n\n[front.damper]\n{damper.format(digest=digest)}\n'
        Path(f"{name}.toml").write_text(text)
        shutil.copytree("run", f"run_{name}")
        Path(f"run_{name}", "vehicle.toml").write_text(text)
        shutil.copy("controller.fmu", f"run_{name}")
    Path("vehicle.trusted-code.txt").write_text(f"{digest}  controller.fmu\n")
    Path("trusted-code.txt").write_text(f"{digest}  controller.fmu\n")
    sources = tmp_path / "core" / "source"
    sources.mkdir(parents=True)
    shutil.copy(library.with_name("native.c"), sources / "march.c")
    for name in ("core.so", "core/core.so", "skyhook.so", "libmujoco.so", "evil.so"):
        shutil.copy(library, name)
    Path("Makefile").write_text("core:\n\tcc core/source/march.c\n")
    return tmp_path


def test_the_library_makes_its_file_when_it_is_loaded(native, tmp_path):
    library, witness = native
    assert not witness.exists()
    assert in_fork(lambda: ctypes.CDLL(str(library)) and 0, tmp_path / "said.txt") == (0, "")
    assert witness.exists()
    witness.unlink()


def test_every_command_that_ends_by_itself_has_its_words():
    assert {*WORDS, "bench"} == {*COMMANDS}


@pytest.mark.parametrize("car", CARS)
def test_no_command_runs_native_code_of_a_car(car, native, archive, capsys):
    _, witness = native
    before = tree(archive)
    codes = {}
    for name, words in WORDS.items():
        codes[name] = main([name, *(word.replace("CAR", f"{car}.toml").replace("RUN", f"run_{car}") for word in words)])
        said = capsys.readouterr()
        assert not witness.exists(), name
        assert "Traceback" not in said.err + said.out and FAULT not in said.err, (name, said.err)
        shutil.rmtree("out", ignore_errors=True)
        assert tree(archive) == before, name
    assert not trusted_list().exists() or "controller.fmu" not in trusted_list().read_text()
    run = {"shaker": 2, "orders": 2, "drive": 2, "tune": 2, "fmu": 2, "sweep": 4, "optimise": 4}
    assert run.items() <= codes.items() and codes["show"] == codes["modes"] == (0 if car == "controller" else 2)
