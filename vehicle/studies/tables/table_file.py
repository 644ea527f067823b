"""Statements of a file by its kind: tables, Adams models, URDF and tyre files; every other kind is refused by name."""

from pathlib import Path

from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.formats.teim_orbit import is_property_file
from vehicle.studies.tables.adams_model import read_adams_model
from vehicle.studies.tables.adams_subsystem import read_subsystem, subsystems
from vehicle.studies.tables.name_words import NameWords
from vehicle.studies.tables.robot_model import read_robot_model
from vehicle.studies.tables.statements import Number, Statements, statements
from vehicle.studies.tables.tyre_file import OF_THE_FILE, read_tyre_file

TABLES = (".csv", ".txt", ".tsv", ".dat", ".xlsx", ".xlsm", ".m", ".par")

REFUSED = {
    ".bin": "an Adams View database; export a .cmd or .adm file, or the hardpoints as CSV",
    ".mnf": "a flexible body; give its mass and stiffness matrices to `vehicle body import`",
    ".cpar": "a CarSim database; export a parameter file (.par)",
    ".spck": "a Simpack model; export its markers and masses as CSV",
    ".xls": "Excel before 2007; save it as XLSX or CSV",
    ".ods": "an OpenDocument sheet; save it as XLSX or CSV",
    ".xml": "an XML file; write points, values and units to a CSV",
    ".json": "JSON; write points, values and units to a CSV",
    ".mat": "a MATLAB file; write names, values and units to a CSV",
    ".xacro": "a xacro file; run `xacro FILE > car.urdf` and give its result",
    ".sdf": "SDF; convert it to URDF, or write its masses and points to a CSV",
    ".toml": "a TOML file; give a vehicle file with --from, numbers with --numbers",
    ".pdf": "a document; copy its table to a CSV",
}
"""Kind of a file by its ending, and the way to a file that is read."""

READ = "CSV, text, XLSX, .par, .sub, .adm, .cmd, .urdf, .tir"


def file_statements(path: Path) -> Statements:
    """Read the statements of a file on a car.

    Raises:
        ConfigurationError: the file is missing, or of a kind that is not read.
        DataError: its content cannot be understood.
    """
    ending = path.suffix.lower()
    if ending in REFUSED:
        raise ConfigurationError(f"--table {path}: is {REFUSED[ending]}; read are {READ}")
    if not path.is_file():
        raise ConfigurationError(f"--table {path}: the file does not exist; give the path of a table ({READ})")
    if ending in (".adm", ".cmd"):
        return read_adams_model(path)
    if ending == ".sub":
        return read_subsystem(path)
    if ending == ".asy":
        names = subsystems(path)
        raise ConfigurationError(f"--table {path}: is an Adams Car assembly, which contains no points; give its "
                                 f"subsystems: --table {' '.join(names) or 'FILE.sub ...'}")  # fmt: skip
    if ending == ".urdf":
        return read_robot_model(path)
    if ending == ".tir":
        return _tyre(path)
    if is_property_file(path):
        raise DataError(f"--table {path}: is a property file; name it in the vehicle file as curve = {path.name!r}")
    if ending not in TABLES:
        raise ConfigurationError(f"--table {path}: the ending {ending or 'is missing, it'} is none of {READ}; save "
                                 "names, values and units as CSV")  # fmt: skip
    return statements(path)


def _tyre(path: Path) -> Statements:
    """Return radius, vertical stiffness and damping of a tyre file as numbers of both axles."""
    tyre = read_tyre_file(path)
    content = Statements(file=path.name, tyre=tyre)
    for key, terms, value, unit in (
        ("UNLOADED_RADIUS", "tyre radius unloaded", tyre["UNLOADED_RADIUS"], "m"),
        (tyre.stiffness_origin, "tyre rate", tyre.vertical_stiffness, "N/m"),
        ("VERTICAL_DAMPING", "tyre damping", tyre["VERTICAL_DAMPING"], "N s/m"),
    ):
        if value:
            name = NameWords(text=key, terms=tuple(terms.split()), axle="", side="")
            content.numbers.append(Number(where=str(path), name=name, value=value, unit=unit))
    for block, names in tyre.unused.items():
        why = "not used" if block in OF_THE_FILE else "of large or combined slip, camber and moments"
        content.left_out.append(("", f"[{block}] {', '.join(names)}: {why}"))
    return content
