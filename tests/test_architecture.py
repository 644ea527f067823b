"""The house: which room may import which, where MJCF and heavy packages may be named, how long a file may be."""

import ast
import re
import sys
from functools import cache
from pathlib import Path

import pytest

from tests.patience import process
from vehicle.commands import OLDER

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "vehicle"

EVERYWHERE = {"arrays", "digits", "errors", "leftovers", "mapped_table", "names", "settings", "stored", "wording"}
"""May be used by every room."""

WINGS = {
    "core": (),
    "signals": ("analysis", "formats", "records", "excitation", "inputs"),
    "model": ("parameters", "laws", "flexbody", "shapes", "assembly", "templates", "vehicles"),
    "engines": ("simulation", "kinematics", "linear", "reduced", "steady"),
    "drawing": ("rendering", "notebook"),
    "runs": ("car", "figures", "comparison", "output", "targets", "report"),
    "handover": ("fmu", "page", "bench"),
    "studies": (
        "tables",
        *("design", "mounts", "dampers", "diagnosis", "replication", "sweeps"),
        "tuning",
        "optimisation",
    ),
    "commands": (),
}
"""Wings, and the rooms of each, lowest first: imports go to lower wings, and to earlier rooms of the same wing."""

DATA = {"inputs", "templates", "vehicles"}  # rooms that hold no modules

BELOW = EVERYWHERE | {"handed_down", "machine", "replacement", "threads", "version"}
"""Modules that stand below all wings."""

ROOMS: dict[str, set[str]] = {
    "arrays": set(),
    "digits": set(),
    "errors": set(),
    "handed_down": set(),
    "leftovers": set(),
    "names": set(),
    "machine": set(),
    "mapped_table": set(),
    "replacement": set(),
    "settings": set(),
    "stored": set(),
    "threads": set(),
    "version": set(),
    "wording": set(),
    "core": {"replacement"},
    "analysis": {"threads"},
    "formats": {"analysis"},
    "records": {"analysis", "formats"},
    "excitation": {"analysis", "formats", "machine", "records", "replacement"},
    "parameters": {"core", "formats"},
    "laws": {"core", "formats", "parameters"},
    "flexbody": {"analysis", "formats", "parameters", "replacement"},
    "shapes": set(),
    "assembly": {"flexbody", "laws", "parameters", "shapes"},
    "simulation": {"assembly", "core", "excitation", "flexbody", "laws", "machine", "parameters"},
    "kinematics": {"assembly", "flexbody", "laws", "parameters", "simulation"},
    "linear": {"assembly", "excitation", "flexbody", "laws", "parameters", "simulation"},
    "reduced": {"analysis", "core", "excitation", "laws", "linear", "parameters", "simulation", "threads"},
    "steady": {"excitation", "laws", "linear", "parameters", "reduced", "simulation"},
    "rendering": {"analysis", "assembly", "kinematics", "parameters", "shapes", "simulation", "threads"},
    "notebook": {"analysis", "records", "rendering", "simulation"},
    "car": {"handed_down", "analysis", "excitation", "flexbody", "kinematics", "laws", "linear", "notebook"}
    | {"parameters", "records", "reduced", "rendering", "simulation", "steady", "threads"},
    "figures": {"analysis", "car", "parameters"},
    "comparison": {"analysis", "car", "excitation", "formats", "linear", "records", "rendering", "threads"},
    "output": {"analysis", "car", "comparison", "excitation", "figures", "flexbody", "formats", "linear", "machine"}
    | {"parameters", "records", "rendering", "replacement", "simulation"},
    "targets": {"car", "figures", "parameters", "records", "simulation"},
    "report": {"analysis", "car", "figures", "flexbody", "formats", "linear", "output", "parameters", "records"}
    | {"rendering", "simulation", "targets", "version"},
    "fmu": {"car", "core", "linear", "parameters", "reduced", "version"},
    "page": {"analysis", "car", "excitation", "figures", "fmu", "formats", "laws", "linear", "output", "parameters"}
    | {"records", "reduced", "rendering", "report", "simulation", "steady", "targets"},
    "bench": {"analysis", "car", "excitation", "figures", "formats", "linear", "output", "page"}
    | {"parameters", "reduced", "rendering", "report", "shapes", "threads"},
    "tables": {"formats"},
    "design": {"car", "flexbody", "kinematics", "parameters", "simulation", "tables", "threads"},
    "mounts": {"formats", "parameters"},
    "dampers": {"car", "core", "formats", "laws", "parameters", "records", "rendering", "report", "threads"},
    "diagnosis": {"analysis", "car", "excitation", "formats", "laws", "linear", "output", "parameters", "records"}
    | {"reduced", "rendering", "report", "threads"},
    "replication": {"car", "excitation", "formats", "output", "records", "reduced", "rendering", "threads"},
    "sweeps": {"analysis", "car", "excitation", "figures", "flexbody", "formats", "machine", "notebook"}
    | {"output", "parameters", "reduced", "rendering", "report", "simulation", "threads"},
    "tuning": {"analysis", "car", "comparison", "excitation", "flexbody", "formats", "output", "parameters"}
    | {"records", "reduced", "rendering", "report", "threads"},
    "optimisation": {"analysis", "car", "excitation", "figures", "formats", "output", "parameters", "rendering"}
    | {"replacement", "sweeps", "targets"},
    "commands": {"analysis", "assembly", "bench", "car", "comparison", "core", "dampers", "design", "diagnosis"}
    | {"excitation", "flexbody", "fmu", "formats", "kinematics", "linear", "mounts", "optimisation", "output"}
    | {"page", "parameters", "records", "rendering", "replication", "report", "sweeps", "tables", "threads"}
    | {"tuning", "version"},
    "__init__": {"car", "comparison", "dampers", "diagnosis", "excitation", "figures", "fmu", "formats", "handed_down"}
    | {"laws", "mounts", "optimisation", "output", "page", "parameters", "records", "replication", "sweeps", "tuning"},
    "__main__": {"commands", "core", "version"},
    **{name: {"commands"} for name in OLDER},
}
"""What each room, and each module above the rooms, imports of the package: this and no more, and all of it."""

STUDIES = {"analysis", "assembly", "car", "commands", "excitation", "figures", "flexbody", "formats", "laws"} | {
    *("linear", "output", "parameters", "records", "reduced", "rendering", "simulation", "sweeps", "threads")
}
"""What `scenarios` imports of the package; the package imports nothing of `scenarios`."""

HEAVY = {
    "mujoco": {"assembly", "simulation", "kinematics", "linear", "rendering"},
    "trimesh": {"shapes", "assembly"},
    "mediapy": {"rendering"},
    "matplotlib": {"rendering"},
    "imageio_ffmpeg": {"rendering"},
    "jinja2": {"report"},
}

MAKERS = {
    *("add_actuator", "add_body", "add_equality", "add_exclude", "add_freejoint", "add_geom"),
    *("add_joint", "add_mesh", "add_numeric", "add_sensor", "add_site", "add_tendon"),
}
"""Methods of MjSpec that make elements of a model of the car."""

SCENERY = {("drawing/rendering/stage.py", "add_geom")}
"""The floor under the car in a film: no part of the car, and not in its model files."""


def modules():
    found = sorted(PACKAGE.rglob("*.py"))
    assert len(found) > 100, "the package was not found"
    return found


def unit_of(path):
    """Room or top-level module that a file belongs to; a wing for the file of the wing itself."""
    return unit_named(".".join(["vehicle", *path.relative_to(PACKAGE).with_suffix("").parts]))


def unit_named(name):
    """Room, or top-level module, of the dotted name of a module of the package."""
    parts = [part for part in name.split(".")[1:] if part != "__init__"] or ["__init__"]
    return parts[1] if WINGS.get(parts[0]) and len(parts) > 1 else parts[0]


@cache
def tree_of(path):
    """Parsed text of a file."""
    return ast.parse(path.read_text(encoding="utf-8"), filename=str(path))


@cache
def imported(path):
    """(module, line) of every import of a file, wherever it stands; relative ones made absolute."""
    tree = tree_of(path)
    package = ["vehicle", *path.relative_to(PACKAGE).parts[:-1]]
    found = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found += [(alias.name, node.lineno) for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else []
            name = ".".join([*base, *([node.module] if node.module else [])])
            if name == "vehicle" or name.removeprefix("vehicle.") in WINGS:
                found += [(f"{name}.{alias.name}", node.lineno) for alias in node.names]
            else:
                found.append((name, node.lineno))
    return found


def of_package(name):
    return name.partition(".")[0] == "vehicle"


def dotted(path):
    return ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")


NAMES = {dotted(path) for path in modules()}
"""Dotted names of the package and of all its modules."""


@cache
def named(path, text=None):
    """Return the modules that a file names in strings, and may import: whole names, as in a table, and patterns.

    Of a pattern, as f"vehicle.model.laws.{name}", the file has the names; if it has none, all modules match.
    """
    tree = ast.parse(text) if text else tree_of(path)
    texts = {node.value for node in ast.walk(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str)}
    found = {text for text in texts if text in NAMES and text.count(".") > 1}
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and getattr(node.func, "attr", getattr(node.func, "id", "")) in IMPORTERS:
            found |= NAMES & {str(word.value) for word in node.args[:1] if isinstance(word, ast.Constant)}
        if isinstance(node, ast.JoinedStr):
            pattern = "".join(_part(part, path) for part in node.values)
            matching = (
                {name for name in NAMES if re.fullmatch(pattern, name)} if pattern.startswith("vehicle") else set()
            )
            listed = {name for name in matching if {(last := name.rpartition(".")[2]), last.replace("_", "-")} & texts}
            found |= listed or matching
    return found


IMPORTERS = {"import_module", "__import__", "find_spec", "run_module"}


def _part(part, path):
    """Return a regular expression for a part of an f-string."""
    if isinstance(part, ast.Constant):
        return re.escape(str(part.value))
    return re.escape(dotted(path.parent)) if "__package__" in ast.dump(part) else r"\w+"


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ('TABLE = {"tune": "vehicle.studies.tuning.car_fit"}', {"vehicle.studies.tuning.car_fit"}),
        ('import_module("vehicle").save_run', {"vehicle"}),
        ('"fit-mount", "fmu", f"vehicle.commands.{name}"', {"vehicle.commands.fit_mount", "vehicle.commands.fmu"}),
        ('f"vehicle.engines.{name}"', {f"vehicle.engines.{room}" for room in WINGS["engines"]}),
        ('"wave_format", f"{__package__}.{name}"', {"vehicle.signals.formats.wave_format"}),
        ('"vehicle", f"the vehicle.{x}", "vehicle.toml", "python -m vehicle.shaker"', set()),
    ],
)
def test_names_in_strings_are_seen(text, names):
    assert named(PACKAGE / "signals" / "formats" / "example.py", text) == names


def test_imports_are_those_of_the_table():
    found: dict[str, set[str]] = {}
    for path in modules():
        names = {name for name, _ in imported(path)} | named(path)
        targets = {unit_named(name) for name in names if of_package(name)}
        found.setdefault(unit_of(path), set()).update(targets - {unit_of(path)} - EVERYWHERE)
    assert all(not found.pop(wing) for wing, rooms in WINGS.items() if rooms), "a wing itself imports nothing"
    assert set(found) == set(ROOMS), "a new room needs its line in this table and in design"
    for unit, targets in found.items():
        assert targets == ROOMS[unit], f"{unit}: new {targets - ROOMS[unit]}, unused {ROOMS[unit] - targets}"


def test_studies_stand_above_the_package():
    studies = [path for path in sorted((ROOT / "scenarios").rglob("*.py")) if path.name != "__main__.py"]
    assert len(studies) > 20, "the studies were not found"
    names = {name for path in studies for name in [*modules_of(path), *named(path)]}
    found = {unit_named(name) for name in names if of_package(name)}
    assert found - EVERYWHERE == STUDIES, f"new {found - EVERYWHERE - STUDIES}, unused {STUDIES - found}"
    below = {path for path in modules() if any(name.split(".")[0] == "scenarios" for name, _ in imported(path))}
    assert not below


def modules_of(path):
    """Modules that a study imports, wherever the import stands."""
    tree = tree_of(path)
    named = [node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) and node.module]
    return [*named, *(one.name for node in ast.walk(tree) if isinstance(node, ast.Import) for one in node.names)]


def folders_of(place):
    """Names of the folders that hold files, other than what Python left there."""
    files = (path.relative_to(place).parts for path in place.rglob("*") if path.is_file())
    return {parts[0] for parts in files if len(parts) > 1 and "__pycache__" not in parts}


def test_every_room_stands_in_its_wing():
    assert folders_of(PACKAGE) == set(WINGS)
    for wing, rooms in WINGS.items():
        if rooms:
            assert folders_of(PACKAGE / wing) == set(rooms), wing
            assert [path.name for path in (PACKAGE / wing).glob("*.py")] == ["__init__.py"], wing
    for path in (ROOT / "tests").rglob("test_*.py"):
        folders = path.relative_to(ROOT / "tests").parts[:-1]
        assert all(folders[0] == wing for wing, rooms in WINGS.items() if set(folders) & set(rooms)), path


def test_imports_go_down_from_wing_to_wing_and_from_room_to_room():
    """The order of the table is that of the floors: it leaves no room for a cycle."""
    rooms = [room for wing, inside in WINGS.items() for room in inside or (wing,)]
    floor = {**dict.fromkeys(BELOW, -1), **{room: number for number, room in enumerate(rooms)}}
    floor |= dict.fromkeys(set(ROOMS) - set(floor), len(rooms))
    assert set(floor) == set(ROOMS) | DATA
    upwards = {(unit, one) for unit, needed in ROOMS.items() for one in needed if floor[one] >= floor[unit]}
    assert not upwards


def needed_modules(path, names):
    """Return the modules of the package that a file imports, wherever the import is; also those for types only."""
    tree = tree_of(path)
    pairs = [(node.module or "", alias.name) for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)
             for alias in node.names]  # fmt: skip
    single = [alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names]
    return names & {*single, *(f"{base}.{name}" if f"{base}.{name}" in names else base for base, name in pairs)}


@cache
def needs():
    """Return each module with those that it imports, also by name."""
    return {dotted(path): (needed_modules(path, NAMES) | named(path)) - {dotted(path)} for path in modules()}


def reached_from(starts, needed):
    """Return the modules that these import, and those that they import in turn."""
    waiting = list(starts)
    reached: set[str] = set()
    while waiting:
        fresh = needed[waiting.pop()] - reached
        reached |= fresh
        waiting += fresh
    return reached


def test_a_command_or_a_public_name_reaches_every_module():
    """What only studies use belongs to `scenarios`."""
    starts = {"vehicle", "vehicle.__main__", *(f"vehicle.{name}" for name in OLDER)}
    reached = starts | reached_from(starts, needs())
    packages = {dotted(path) for path in modules() if path.name == "__init__.py"}
    assert NAMES - reached - packages == set()


def test_no_import_circle_is_larger_than_two_modules():
    needed = needs()
    reached = {name: reached_from([name], needed) for name in needed}
    circles = {frozenset(other for other in reached[name] if name in reached[other]) for name in needed}
    assert [sorted(circle) for circle in circles if len(circle) > 2] == []


@pytest.mark.parametrize("package", HEAVY)
def test_heavy_packages_stay_in_their_rooms(package):
    where = {unit_of(path) for path in modules() for name, _ in imported(path) if name.split(".")[0] == package}
    assert where <= HEAVY[package]


def test_only_assembly_makes_elements_of_the_car():
    found: dict[str, list[str]] = {}
    for path in modules():
        for node in ast.walk(tree_of(path)):
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
    assert not {str(path.relative_to(ROOT)): n for path in files if (n := len(path.read_text().splitlines())) > 400}


def test_nothing_heavy_is_loaded_before_it_is_used(tmp_path):
    code = (
        "import sys, vehicle, vehicle.__main__, vehicle.shaker, vehicle.modes, vehicle.comfort\n"
        "print(sorted({name.split('.')[0] for name in sys.modules} & "
        "{'mujoco', 'numpy', 'scipy', 'matplotlib', 'trimesh', 'mediapy', 'OpenGL'}))"
    )
    done = process(sys.executable, "-c", code, cwd=ROOT)
    assert done.returncode == 0 and done.stdout.strip() == "[]", done.stdout + done.stderr
    # Most of the time of an import would be scipy.signal: written scipy.signal.welch, it is loaded where it is used.
    late = {"scipy.signal", "scipy.stats", "scipy.fft", "scipy.interpolate", "scipy.optimize", "matplotlib"}
    code = f"import sys, vehicle.runs.car; print({late} & set(sys.modules))"
    done = process(sys.executable, "-c", code, cwd=ROOT)
    assert done.stdout.strip() == "set()", done.stdout + done.stderr
    # Those of a whole run with its pictures: their imports would take a fifth of its time.
    late = late - {"matplotlib"} | {"matplotlib.pyplot"}
    words = f"--input bump_7p5mm.csv --engine reduced --quiet --output {tmp_path / 'run'}".split()
    code = f"import sys; from vehicle.shaker import main; main({words}); print({late} & set(sys.modules))"
    done = process(sys.executable, "-c", code, cwd=ROOT)
    assert done.stdout.strip().splitlines()[-1:] == ["set()"], done.stdout + done.stderr
    assert (tmp_path / "run" / "frf.png").is_file()
    code = "import sys, vehicle; print('vehicle.shaker' in sys.modules)"
    done = process(sys.executable, "-c", code, cwd=ROOT)
    assert done.stdout.strip() == "False", done.stderr


def test_only_commands_print():
    printing = set()
    for path in modules():
        for node in ast.walk(tree_of(path)):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "print":
                printing.add(path.relative_to(PACKAGE).as_posix())
    assert {name for name in printing if not name.startswith("commands/")} == {"__main__.py"}
    assert "commands/console.py" in printing
