"""The registry of file formats is complete: every module of a format is an entry, and every entry has its module."""

from importlib import import_module
from pathlib import Path

import pytest

from vehicle.signals.formats import formats
from vehicle.signals.formats.formats import FORMATS, TABLES, WRITTEN

FOLDER = Path(formats.__file__).parent


def test_every_module_of_a_format_is_registered():
    modules = {path.stem for path in FOLDER.glob("*_format.py")} | {"csv_table", "table_file", "uff_writer"}
    registered = {module for entry in FORMATS for module in (entry.reader, entry.table, entry.writer) if module}
    assert modules == registered


@pytest.mark.parametrize("entry", FORMATS, ids=lambda entry: entry.name)
def test_a_format_reads_and_writes_what_its_entry_states(entry):
    for module, names in ((entry.reader, ("read",)), (entry.table, ("read", "write")), (entry.writer, ("write",))):
        if module:
            assert all(callable(getattr(import_module(f"{formats.__package__}.{module}"), name)) for name in names)
    assert (entry.name in TABLES) == bool(entry.table)
    assert (entry.name in WRITTEN) == bool(entry.table or entry.writer)


def test_text_is_tried_last():
    assert FORMATS[-1].name == "csv" and len({entry.name for entry in FORMATS}) == len(FORMATS)
