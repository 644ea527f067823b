"""The one way into measurement files: a file is recognised by what it holds, whatever it is called."""

from __future__ import annotations

import hashlib
import re
import struct
import zipfile
from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path
from typing import Any, cast

from vehicle.errors import ConfigurationError, DataError, MissingPartError
from vehicle.records.channel import Measurement

HEAD = 4096
"""Bytes at the beginning that tell the format."""

READERS = {
    "csv": "logger_format",
    "lvm": "lvm_format",
    "can": "can_format",
    "vbo": "vbo_format",
    "npz": "array_format",
    "uff": "uff_format",
    "mat": "matlab_format",
    "wav": "wave_format",
    "rpc": "rpc_format",
    "hdf5": "hdf_format",
    "mdf": "mdf_format",
    "tdms": "tdms_format",
    "xlsx": "sheet_format",
    "parquet": "parquet_format",
    "crg": "crg_format",
    "erd": "erd_format",
}
"""Name of a format and the module that reads it, imported when such a file is met."""

OTHERS = {
    b"|CF,": ("FAMOS", "UFF 58, MAT or CSV"),
    b"<usi:tdm": ("TDM", "TDMS or CSV"),
    b"DEWESOFT": ("Dewesoft", "UFF 58, MAT or MDF4"),
    b"$OP2": ("Nastran OP2", "UFF 55 or CSV"),
    b"LOGG": (
        "a log of a CAN bus (Vector BLF)",
        "MDF4 or ASC, as `python -m can.logconvert IN.blf OUT.asc` of python-can does, and give --dbc FILE with it",
    ),
    b"ULog\x01\x12\x35": ("PX4 ULog", "CSV, as `ulog2csv FILE` of pyulog does"),
}
"""First bytes of formats that are not read: name, and what to export instead."""

BUS_LOGS = ("mdf", "can")
"""Formats whose frames a database decodes."""

ENDINGS = {
    ".tdm": OTHERS[b"<usi:tdm"],
    ".dxd": OTHERS[b"DEWESOFT"],
    ".d7d": OTHERS[b"DEWESOFT"],
    ".op2": OTHERS[b"$OP2"],
    ".bin": ("Catman or raw numbers", "MAT, MDF4 or CSV"),
    ".tst": ("Catman", "MAT, MDF4 or CSV"),
    ".sie": ("SoMat SIE", "RPC III or CSV"),
    ".dac": ("nCode DAC", "RPC III or CSV"),
    ".xls": ("Excel before 2007", "XLSX or CSV"),
    ".lms": ("a Testlab project", "UFF 58 or MAT"),
    ".pti": ("PULSE time", "UFF 58"),
    ".atfx": ("ATFX", "UFF 58 or MAT"),
    ".mp3": ("compressed sound", "WAV"),
    ".flac": ("compressed sound", "WAV"),
}
"""The same by the end of the name, for a file of bytes that nothing else tells."""


_VBOX = re.compile(rb"^\[(header|column names)\]\s*$", re.IGNORECASE | re.MULTILINE)


def read_record(path: str | Path, databases: Sequence[Path] = ()) -> Measurement:
    """Read all channels of a measurement file as found.

    Args:
        path: the file, of any format of `READERS`.
        databases: files of the form DBC, which decode the log of a CAN bus.

    Returns:
        Channels with names, units and times, mode shapes and geometry, in the units of the file.

    Raises:
        ConfigurationError: there is no such file, or databases are given for another kind of file.
        DataError: no format that is read, or a damaged file.
        MissingPartError: the format needs a library that is not there; the message names the extra.
    """
    file = Path(path)
    name = recognise(file)
    if databases and name not in BUS_LOGS:
        raise ConfigurationError(f"{path}: --dbc decodes the log of a CAN bus (MDF, .asc, .trc, candump); it is {name}")
    read = cast(Callable[..., Measurement], import_module(f"vehicle.records.{READERS[name]}").read)
    return read(file, databases) if databases else read(file)


def recognise(path: Path) -> str:
    """Name of the format of a file, by its content.

    Args:
        path: the file.

    Raises:
        ConfigurationError: there is no such file.
        DataError: bytes of no format that is read.
    """
    if not path.is_file():
        raise ConfigurationError(f"{path}: no such file; give the path of a measurement file")
    try:
        with path.open("rb") as file:
            head = file.read(HEAD)
        size = path.stat().st_size
    except OSError as error:
        raise DataError(f"{path}: cannot be read ({error.strerror}); check the file and its permissions") from error
    name = _by_bytes(path, head, size)
    if name is not None:
        return name
    for begins, (other, instead) in OTHERS.items():
        if head.startswith(begins) or (begins == b"<usi:tdm" and begins in head):
            raise DataError(f"{path}: is {other}, which is not read; export {instead}")
    if path.suffix.lower() in (".csv", ".txt", ".asc"):
        return "csv"  # its reader names the byte that is no text
    if b"\0" in head and not head.startswith((b"\xff\xfe", b"\xfe\xff")):
        other, instead = ENDINGS.get(path.suffix.lower(), ("of no known format", "UFF 58, MAT, RPC III, MDF4 or CSV"))
        raise DataError(f"{path}: binary file, {other}, which is not read; export {instead}")
    if path.suffix.lower() in ENDINGS and not head.isascii():
        other, instead = ENDINGS[path.suffix.lower()]
        raise DataError(f"{path}: is {other}, which is not read; export {instead}")
    return "csv"


def _by_bytes(path: Path, head: bytes, size: int) -> str | None:
    """The format that the first bytes tell; None for text and all else."""
    if head.startswith(b"PK"):
        return _archive(path)
    plain = {
        b"TDSm": "tdms",
        b"MDF     ": "mdf",
        b"UnFinMF ": "mdf",
        b"\x89HDF\r\n\x1a\n": "hdf5",
        b"MATLAB 7.3": "hdf5",
        b"FORMAT\0": "rpc",
        b"PAR1": "parquet",
        b"ERDFILEV": "erd",
    }
    for begins, name in plain.items():
        if head.startswith(begins):
            return name
    if head[512:520] == b"\x89HDF\r\n\x1a\n":
        return "hdf5"
    if head[:4] in (b"RIFF", b"RIFX", b"RF64") and head[8:12] == b"WAVE":
        return "wav"
    if head[126:128] in (b"IM", b"MI") or head.startswith(b"MATLAB 5.0") or _matlab_4(head, size):
        return "mat"
    if head.startswith(b"LabVIEW Measurement"):
        return "lvm"
    if head.startswith(b"\x1aE\xdf\xa3"):
        if b"mide" in head[:64]:
            raise DataError(
                f"{path}: is an enDAQ IDE recording, which is not read; export CSV from enDAQ Lab, or with Python: "
                f"endaq.ide.to_pandas(endaq.ide.get_doc({path.name!r}).channels[8]).to_csv('{path.stem}.csv')"
            )
        raise DataError(f"{path}: is a film or another EBML file, which is not read; give a record of measurements")
    if bus_log(head.decode("latin-1")):
        return "can"
    if _VBOX.search(head):
        return "vbo"
    if head.lstrip()[:1] == b"$" and (b"$ROAD_CRG" in head.upper() or path.suffix.lower() == ".crg"):
        return "crg"
    first = [line.strip() for line in head[:600].splitlines() if line.strip()][:2]
    if len(first) == 2 and first[0] == b"-1" and first[1][:4].strip(b"b ").isdigit():
        return "uff"
    return None


def bus_log(head: str) -> str:
    """Return the name of the text format of a log of a CAN bus; empty for any other text.

    Args:
        head: first characters of the file.
    """
    if re.search(r"^base\s+(hex|dec)\s+timestamps\s+(absolute|relative)", head, re.MULTILINE):
        return "asc"
    if head.lstrip("\ufeff\xef\xbb\xbf").startswith(";$FILEVERSION=") or "Generated by PCAN-View" in head:
        return "trc"
    return "candump" if re.match(r"\s*\(\d+\.\d+\)\s+\S+\s+[0-9A-Fa-f]{3,8}#", head) else ""


def _archive(path: Path) -> str:
    try:
        with zipfile.ZipFile(path) as archive:
            names = archive.namelist()
    except (zipfile.BadZipFile, OSError, NotImplementedError, ValueError):
        return "npz"  # its reader says what is wrong
    return "xlsx" if any(name.startswith("xl/") for name in names) else "npz"


def _matlab_4(head: bytes, size: int) -> bool:
    """Whether a file begins with a matrix of MATLAB 4, of either byte order, that fits into it."""
    if len(head) < 24:
        return False
    for order in "<>":
        kind, rows, columns, imaginary, letters = struct.unpack(f"{order}5i", head[:20])
        machine, rest = divmod(kind, 1000)
        width = {0: 8, 1: 4, 2: 4, 3: 2, 4: 2, 5: 1}.get(rest // 10 % 10)
        fits = width is not None and rows > 0 and columns > 0 and 20 + letters + rows * columns * width <= size
        if (
            kind >= 0
            and machine in (0, 1)
            and rest // 100 == 0
            and rest % 10 in (0, 1)
            and fits
            and imaginary in (0, 1)
            and 1 < letters < 65
            and head[20 : 19 + letters].isascii()
            and head[19 + letters] == 0
        ):
            return True
    return False


def extra(package: str, name: str, what: str) -> Any:
    """Import a library of an extra.

    Args:
        package: to be imported.
        name: of the extra.
        what: the format, for the message.

    Raises:
        MissingPartError: it is not there.
    """
    try:
        return import_module(package)
    except ImportError:
        raise MissingPartError(
            f"{what} needs {package}, which is not installed; install it with: pip install 'vehicle-on-shaker[{name}]'"
        ) from None


def digest(path: Path) -> str:
    """SHA-256 of a file, hexadecimal."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
