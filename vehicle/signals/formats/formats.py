"""Registry of file formats: recognition by content, and the modules that read and write each format."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.formats import refused_formats, signatures
from vehicle.signals.formats.signatures import HEAD_BYTES, Head

if TYPE_CHECKING:
    from vehicle.signals.formats.table import Record


@dataclass(frozen=True, kw_only=True, slots=True)
class Format:
    """File format; its modules are in this package and imported on first use.

    Attributes:
        name: name in messages; extension of written files.
        recognise: predicate of the first bytes of a file.
        reader: module with `read(path) -> Measurement`; with `databases`, `read(path, databases)`.
        table: module with `read(path, wanted) -> Table` and `write(path, record, frame)`; empty for foreign
            formats.
        writer: module with `write(path, channels, description)`; empty if written as a table or never.
        databases: True if DBC files decode the CAN frames of the file.
    """

    name: str
    recognise: Callable[[Head], bool]
    reader: str
    table: str = ""
    writer: str = ""
    databases: bool = False

    def function(self, role: str, name: str) -> Callable[..., Any]:
        """Import a function of the format.

        Args:
            role: "reader", "table" or "writer".
            name: "read" or "write".
        """
        module = import_module(f"{__package__}.{getattr(self, role)}")
        function: Callable[..., Any] = getattr(module, name)
        return function


FORMATS = (
    Format(name="npz", recognise=signatures.is_npz, reader="table_file", table="npz_format"),
    Format(name="xlsx", recognise=signatures.is_xlsx, reader="sheet_format"),
    Format(name="tdms", recognise=signatures.starting(b"TDSm"), reader="tdms_format"),
    Format(
        name="mf4",
        recognise=signatures.starting(b"MDF     ", b"UnFinMF "),
        reader="mdf_format",
        writer="mdf_format",
        databases=True,
    ),
    Format(name="h5", recognise=signatures.is_hdf5, reader="hdf_format", writer="hdf_format"),
    Format(name="rpc", recognise=signatures.starting(b"FORMAT\0"), reader="rpc_format", writer="rpc_format"),
    Format(name="parquet", recognise=signatures.starting(b"PAR1"), reader="parquet_format"),
    Format(name="erd", recognise=signatures.starting(b"ERDFILEV"), reader="erd_format"),
    Format(name="wav", recognise=signatures.is_wave, reader="wave_format"),
    Format(name="mat", recognise=signatures.is_matlab, reader="matlab_format", writer="matlab_format"),
    Format(name="lvm", recognise=signatures.starting(b"LabVIEW Measurement"), reader="lvm_format"),
    Format(name="can", recognise=signatures.is_can_log, reader="can_format", databases=True),
    Format(name="blf", recognise=signatures.starting(b"LOGG"), reader="blf_format", databases=True),
    Format(name="vbo", recognise=signatures.is_vbo, reader="vbo_format"),
    Format(name="crg", recognise=signatures.is_crg, reader="crg_format"),
    Format(name="uff", recognise=signatures.is_uff, reader="uff_format", writer="uff_writer"),
    Format(name="csv", recognise=lambda head: True, reader="csv_format", table="csv_table"),
)
"""File formats in the order of recognition. Text is last and accepts every file that
`vehicle.signals.formats.refused_formats` does not reject."""

BY_NAME = {entry.name: entry for entry in FORMATS}


def recognised_format(path: Path) -> Format:
    """Recognise the format of a file by its content, regardless of its name.

    Raises:
        ConfigurationError: the file does not exist.
        DataError: an unsupported format, or binary data.
    """
    if not path.is_file():
        raise ConfigurationError(f"{path}: the file does not exist; give the path of a measurement file")
    try:
        with path.open("rb") as file:
            data = file.read(HEAD_BYTES)
        head = Head(path, data, path.stat().st_size)
    except OSError as error:
        raise DataError(f"{path}: cannot be read ({error.strerror}); check the file and its permissions") from error
    *binary_formats, text = FORMATS
    for entry in binary_formats:
        if entry.recognise(head):
            return entry
    refused_formats.refuse(head)
    return text


TABLES = tuple(entry.name for entry in FORMATS if entry.table)
"""Names of the table formats in which a run is always written."""

WRITTEN = tuple(entry.name for entry in FORMATS if entry.table or entry.writer)
"""Names of all formats in which a run can be written."""


def write_record(path: Path, name: str, record: Record, frame: str) -> None:
    """Write a record as a table.

    Args:
        name: name of the format, one of `TABLES`.
        frame: description of the vector axes.
    """
    BY_NAME[name].function("table", "write")(path, record, frame)
