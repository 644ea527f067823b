"""Results are written through one door: new files and folders become visible when they are complete.

Every call that opens a file for writing, makes, renames or removes one is in a list with its reason.
"""

import ast
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

METHODS = {"write_text", "write_bytes", "mkdir", "rename", "unlink", "rmdir", "rmtree", "touch", "symlink_to"}
METHODS |= {"copyfile", "copytree", "copy", "copy2", "mkdtemp", "mkstemp", "truncate", "ftruncate", "savez"}
METHODS |= {"savefig", "savemat", "NamedTemporaryFile", "TemporaryDirectory", "savetxt", "tofile", "save", "makedirs"}
NO_FILES = {"copy", "save", "rename"}
"""Methods of other objects too."""

DOOR = {
    "replacement.py": "the door: synchronised files, one rename",
    "runs/output/work_folder.py": "the door: hidden folders and their journal",
    "runs/output/written_files.py": "the door: list of the files of a folder",
    "runs/output/locks.py": "the door: lock files",
    "runs/output/folder.py": "the door: makes the folder of a file",
}

GIVEN = "writes the path that the door gives to it"
APPENDS = "appends finished rows; half a row is left out when they are read again"
PRIVATE = "a private folder, or a cache, which holds no results"

ELSEWHERE = {
    "handover/page/shaken_run.py": GIVEN,
    "drawing/rendering/figure.py": GIVEN,
    "drawing/rendering/film.py": GIVEN,
    "model/flexbody/superelement_file.py": GIVEN,
    "model/flexbody/superelement_npz.py": "makes the bytes in memory",
    "runs/output/model_files.py": GIVEN + "; removes meshes of an earlier model after the new files are in place",
    "runs/output/own_files.py": GIVEN + "; makes the folder of a saved car",
    "runs/output/run_files.py": GIVEN,
    "signals/formats/hdf_format.py": GIVEN,
    "signals/formats/matlab_format.py": GIVEN,
    "signals/formats/npz_format.py": GIVEN,
    "signals/formats/rpc_format.py": GIVEN,
    "signals/formats/csv_table.py": GIVEN,
    "signals/formats/uff_writer.py": GIVEN,
    "studies/sweeps/case_file.py": GIVEN,
    "studies/sweeps/effects.py": GIVEN,
    "studies/sweeps/sobol_sweep.py": GIVEN,
    "studies/sweeps/table_files.py": GIVEN,
    "studies/optimisation/car_table.py": APPENDS,
    "studies/sweeps/store.py": APPENDS,
    "core/cache_folder.py": PRIVATE,
    "core/library.py": PRIVATE,
    "core/trusted_code.py": GIVEN + "; makes the folder of the user's list",
    "drawing/rendering/backend.py": PRIVATE,
    "handover/bench/results.py": PRIVATE,
    "runs/car/run.py": PRIVATE,
    "runs/report/film_section.py": PRIVATE,
    "runs/report/svg_figure.py": PRIVATE,
    "model/laws/controller_fmu.py": PRIVATE,
    "handover/fmu/fmu_file.py": GIVEN,
    "studies/optimisation/car_search.py": PRIVATE,
    "studies/sweeps/worker.py": "opens the null device",
    "commands/command_line.py": "opens the null device",
}


def writes(tree: ast.AST) -> list[int]:
    """Return the lines of calls that change the file system."""
    lines = []
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call):
            continue
        function = node.func
        name = function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")
        if name == "write_text" and isinstance(function, ast.Name):
            continue  # that of the door
        texts = [
            item.value for item in (*node.args, *(k.value for k in node.keywords)) if isinstance(item, ast.Constant)
        ]
        if name in {"open", "fdopen", "ZipFile", "File"}:
            flags = {item.attr for item in ast.walk(node) if isinstance(item, ast.Attribute)}
            mode = any(isinstance(text, str) and len(text) <= 3 and set(text) & set("wax+") for text in texts)
            if mode or flags & {"O_CREAT", "O_WRONLY", "O_RDWR"}:
                lines.append(node.lineno)
        elif name == "replace":
            # Path.replace has one argument, str.replace two, dataclasses.replace only names.
            if len(node.args) == 1 and not node.keywords and not isinstance(node.args[0], ast.Starred):
                lines.append(node.lineno)
        elif name in METHODS - NO_FILES or (name == "rename" and len(node.args) == 1):
            lines.append(node.lineno)
    return lines


def test_every_write_goes_through_the_door():
    found = {}
    for path in sorted((ROOT / "vehicle").rglob("*.py")):
        if lines := writes(ast.parse(path.read_text(encoding="utf-8"))):
            found[path.relative_to(ROOT / "vehicle").as_posix()] = lines
    known = DOOR.keys() | ELSEWHERE.keys()
    unknown = {name: lines for name, lines in found.items() if name not in known}
    assert not unknown, "writes outside the door: use write_whole, whole_files, output_folder or study_folder"
    assert known == found.keys(), "a file of the list writes nothing any more"


def test_the_search_finds_writes():
    source = "p.open('w')\nopen(p, 'ab')\np.write_text('a')\nq.replace(p)\nos.open(p, os.O_CREAT)\nshutil.rmtree(p)\n"
    assert writes(ast.parse(source)) == [1, 2, 3, 4, 5, 6]
    assert writes(ast.parse("p.open()\nopen(p, 'rb')\n'a'.replace('a', 'b')\ndataclasses.replace(a, b=1)\n")) == []
