"""Shipped records of drives, found by their names."""

from pathlib import Path

RECORD_FOLDER = Path(__file__).resolve().parents[1] / "inputs" / "records"
"""Folder of the records, part of the package; `python -m scenarios.inputs.make_third_car` writes them."""


def find_record(name: str | Path) -> Path:
    """Return the path of the shipped record with this name if no file has it, else the path itself."""
    path, shipped = Path(name), RECORD_FOLDER / Path(name).name
    return shipped if path.name == str(name) and not path.exists() and shipped.is_file() else path
