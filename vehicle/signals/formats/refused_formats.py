"""Reject recognised but unsupported formats: the error names the format and an alternative for the export."""

from pathlib import Path

from vehicle.errors import DataError
from vehicle.signals.formats.signatures import Head, zip_names

SIGNATURES = {
    b"|CF,": ("FAMOS", "UFF 58, MAT or CSV"),
    b"<usi:tdm": ("TDM of DIAdem", "TDMS or CSV"),
    b"DEWESOFT": ("Dewesoft", "UFF 58, MAT or MDF4"),
    b"$OP2": ("Nastran OP2", "UFF 55 or CSV"),
    b"CDF": ("netCDF of the classic form", "netCDF-4, with `nccopy -k nc4 IN.nc OUT.nc`"),
    b"ULog\x01\x12\x35": ("PX4 ULog", "CSV, for example with `ulog2csv FILE` of pyulog"),
}
"""First bytes of a file -> name of the format, and alternative for the export."""

ENDINGS = {
    ".tdm": SIGNATURES[b"<usi:tdm"],
    ".dxd": SIGNATURES[b"DEWESOFT"],
    ".d7d": SIGNATURES[b"DEWESOFT"],
    ".op2": SIGNATURES[b"$OP2"],
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
"""File extension -> name of the format, and alternative, for binary files without a known signature."""

CONTAINERS = {
    ".tdm": ("TDM of DIAdem", SIGNATURES[b"<usi:tdm"][1]),
    ".tdx": ("TDM of DIAdem", SIGNATURES[b"<usi:tdm"][1]),
    ".atfx": ("ATFX", "UFF 58 or MAT"),
    "content.xml": ("spreadsheet of OpenDocument", "XLSX or CSV"),
    "modelDescription.xml": ("FMU, which is a model and no measurement", "the results of its simulation"),
    "simulink/blockdiagram.xml": ("Simulink model, which is no measurement", "the logged signals as MAT or CSV"),
    "word/document.xml": ("text document", "CSV"),
}
"""Extension or name of a file in a ZIP archive -> name of the format, and alternative for the export."""

EBML_SIGNATURE = b"\x1aE\xdf\xa3"
TEXT_ENDINGS = (".csv", ".txt", ".asc")


def refuse(head: Head) -> None:
    """Raise the error for an unsupported format or binary data; return for a possible text file."""
    path, data, ending = head.path, head.data, head.path.suffix.lower()
    if (names := zip_names(head)) is not None:
        contents = (CONTAINERS.get(Path(name).suffix.lower()) or CONTAINERS.get(name) for name in names)
        name, instead = next(filter(None, contents), ENDINGS.get(ending, ("", "")))
        shown = ", ".join(names[:4])
        if name:
            raise DataError(f"{path}: {name}, in a ZIP archive ({shown}), not supported; export {instead}")
        raise DataError(f"{path}: ZIP archive of {shown}, not supported; unpack it, and use a file in it")
    if data.startswith(EBML_SIGNATURE):
        if b"mide" in data[:64]:
            raise DataError(
                f"{path}: enDAQ IDE recordings are not supported; export CSV from enDAQ Lab, or with Python: "
                f"endaq.ide.to_pandas(endaq.ide.get_doc({path.name!r}).channels[8]).to_csv('{path.stem}.csv')"
            )
        raise DataError(f"{path}: is a video or another EBML file, which is not supported; use a measurement file")
    for signature, (name, instead) in SIGNATURES.items():
        if data.startswith(signature) or (signature == b"<usi:tdm" and signature in data):
            raise DataError(f"{path}: {name}, not supported; export {instead}")
    if ending in TEXT_ENDINGS:
        return  # the text reader reports the position of the invalid byte
    name, instead = ENDINGS.get(ending, ("not in any known format", "UFF 58, MAT, RPC III, MDF4 or CSV"))
    binary = b"\0" in data and not data.startswith((b"\xff\xfe", b"\xfe\xff"))
    if binary or (ending in ENDINGS and not data.isascii()):
        raise DataError(f"{path}: {'binary file, ' if binary else ''}{name}, not supported; export {instead}")
