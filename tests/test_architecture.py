"""The house: which room may import which, where MJCF and heavy packages may be named, how long a file may be."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "vehicle"

EVERYWHERE = {"errors", "names"}
"""May be used by every room."""

ROOMS = {
    "parameters": set(),
    "laws": {"parameters"},
    "excitation": {"parameters"},
    "flexbody": {"parameters"},
    "shapes": {"parameters"},
    "assembly": {"parameters", "flexbody", "shapes", "laws"},
    "simulation": {"parameters", "laws", "excitation", "assembly", "flexbody", "compiler_cache"},
    "linear": {"laws", "parameters", "simulation"},
    "reduced": {"parameters", "excitation", "linear", "simulation", "compiler_cache"},
    "analysis": set(),
    "lumped": {"parameters", "laws", "linear"},
    "rendering": {"simulation", "analysis", "assembly", "flexbody", "shapes", "excitation"},
}

# The facade and the thin command lines above the rooms.
OUTPUT = {"output_folder", "written_files"}
COMMAND = {"command_line"}
TOP = {
    "errors": set(),
    "names": set(),
    "output_folder": {"written_files"},
    "written_files": set(),
    "command_line": set(),
    "threads": set(),
    "compiler_cache": set(),
    "car": {"analysis", "excitation", "flexbody", "linear", "parameters", "reduced", "simulation"},
    "studies": set(ROOMS) | {"car"} | OUTPUT,
    "sweeps": {"analysis", "car", "excitation", "flexbody", "parameters", "threads"} | OUTPUT,
    "tuning": {"analysis", "car", "excitation", "linear", "parameters", "reduced", "rendering", "simulation"},
    "sweep": COMMAND | OUTPUT | {"car", "excitation", "parameters", "sweeps"},
    "shaker": COMMAND | OUTPUT | {"car", "excitation", "rendering", "studies"},
    "modes": COMMAND | {"car"},
    "mjcf": COMMAND | {"car", "assembly"},
    "comfort": COMMAND | {"analysis"},
    "__init__": set(),
}

ALLOWED = {**ROOMS, **TOP}

HEAVY = {
    "mujoco": {"assembly", "simulation", "linear", "rendering"},
    "trimesh": {"shapes", "assembly"},
    "mediapy": {"rendering"},
    "matplotlib": {"rendering"},
    "imageio_ffmpeg": {"rendering"},
}

MAKERS = {
    "add_actuator",
    "add_body",
    "add_equality",
    "add_exclude",
    "add_freejoint",
    "add_geom",
    "add_joint",
    "add_mesh",
    "add_numeric",
    "add_sensor",
    "add_site",
    "add_tendon",
}
"""Methods of MjSpec that make elements of a model of the car."""

SCENERY = {("rendering/stage.py", "add_geom")}
"""The floor under the car in a film: no part of the car, and not in its model files."""


def modules():
    found = sorted(PACKAGE.rglob("*.py"))
    assert len(found) > 100, "the package was not found"
    return found


def unit_of(path):
    """Room or top-level module that a file belongs to."""
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


def imported(path):
    """(module, line) of every import of a file, wherever it stands; relative ones made absolute."""
    tree = ast.parse(path.read_text(encoding="utf-8"), filename=str(path))
    package = ["vehicle", *path.relative_to(PACKAGE).parts[:-1]]
    found = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found += [(alias.name, node.lineno) for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else []
            name = ".".join([*base, *([node.module] if node.module else [])])
            if name == "vehicle":
                found += [(f"vehicle.{alias.name}", node.lineno) for alias in node.names]
            else:
                found.append((name, node.lineno))
    return found


def test_imports_follow_the_table():
    edges, bad = set(), []
    for path in modules():
        unit = unit_of(path)
        assert unit in ALLOWED, f"{unit}: a new room needs its line in this table and in design"
        for name, line in imported(path):
            if name.split(".")[0] != "vehicle":
                continue
            target = name.split(".")[1]
            edges.add((unit, target))
            if target not in {unit, *EVERYWHERE, *ALLOWED[unit]}:
                bad.append(f"{path.relative_to(ROOT)}:{line} imports {name}")
    assert not bad, "\n".join(bad)
    # The walk saw something: these edges make the car.
    assert {("assembly", "flexbody"), ("simulation", "assembly"), ("car", "simulation"), ("studies", "car")} <= edges


def test_the_table_has_no_cycle():
    done: set[str] = set()
    while len(done) < len(ALLOWED):
        ready = {unit for unit, needed in ALLOWED.items() if unit not in done and needed - done - EVERYWHERE == set()}
        assert ready, f"cycle among {sorted(set(ALLOWED) - done)}"
        done |= ready


def test_rooms_do_not_import_commands():
    for path in modules():
        for name, line in imported(path):
            assert name not in ("vehicle.shaker", "vehicle.modes"), f"{path}:{line}"
    assert not imported(PACKAGE / "__init__.py")


@pytest.mark.parametrize("package", HEAVY)
def test_heavy_packages_stay_in_their_rooms(package):
    where = {unit_of(path) for path in modules() for name, _ in imported(path) if name.split(".")[0] == package}
    assert where <= HEAVY[package]


def test_only_assembly_makes_elements_of_the_car():
    found: dict[str, list[str]] = {}
    for path in modules():
        tree = ast.parse(path.read_text(encoding="utf-8"))
        for node in ast.walk(tree):
            if isinstance(node, ast.Attribute) and node.attr in MAKERS:
                if (str(path.relative_to(PACKAGE)), node.attr) in SCENERY:
                    continue
                found.setdefault(unit_of(path), []).append(f"{path.relative_to(ROOT)}:{node.lineno} {node.attr}")
    assert len(found.pop("assembly", [])) >= 10
    assert not found, found


def test_files_are_named_for_what_they_hold():
    banned = {"utils", "helpers", "common", "util", "helper", "misc", "tools"}
    for path in [*modules(), *sorted((ROOT / "tests").rglob("*.py")), *sorted((ROOT / "scenarios").rglob("*.py"))]:
        assert path.stem not in banned, path


def test_no_file_is_longer_than_400_lines():
    files = [*modules(), *sorted((ROOT / "tests").rglob("*.py")), *sorted((ROOT / "scenarios").rglob("*.py"))]
    assert len(files) > 200
    long = {str(path.relative_to(ROOT)): n for path in files if (n := len(path.read_text().splitlines())) > 400}
    assert long == {}


def test_importing_the_package_loads_nothing_heavy():
    code = (
        "import sys, vehicle, vehicle.shaker, vehicle.modes\n"
        "print(sorted({name.split('.')[0] for name in sys.modules} & "
        "{'mujoco', 'numpy', 'scipy', 'matplotlib', 'trimesh', 'mediapy', 'OpenGL'}))"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and done.stdout.strip() == "[]", done.stdout + done.stderr
    code = "import sys, vehicle; print('vehicle.shaker' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=60)
    assert done.stdout.strip() == "False", done.stderr


def test_the_library_does_not_print():
    commands = {"shaker", "modes", "mjcf", "comfort", "command_line"}
    for path in modules():
        if unit_of(path) in commands:
            continue
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "print":
                inside_main = "__main__" in path.read_text()
                assert inside_main, f"{path.relative_to(ROOT)}:{node.lineno} prints"
