"""Files of a finished sweep, written row by row: table, computing times, differences in comfort, and the plan."""

from contextlib import ExitStack
from pathlib import Path
from typing import TextIO

from vehicle.runs.output.folder import whole_file, write_json
from vehicle.studies.sweeps.case import parameter_cells
from vehicle.studies.sweeps.differences import DIFFERENCES, DifferencesWriter, has_differences
from vehicle.studies.sweeps.sweep_table import SweepTable, TableWriter


def write_table(table: SweepTable, folder: Path, computed: str) -> None:
    """Write `table.csv`, `timing.csv`, `sweep.json`, and with several cars `differences.csv`.

    Args:
        table: the table; its rows are read once.
        folder: folder of the files.
        computed: last line of `timing.csv`.

    Raises:
        ConfigurationError, OutputError: see `whole_file`.
    """
    failed = []
    with ExitStack() as files:

        def opened(name: str) -> TextIO:
            path = files.enter_context(whole_file(folder / name))
            return files.enter_context(path.open("w", encoding="utf-8", newline=""))

        paths, timing = table.paths(), opened("timing.csv")
        rows = TableWriter(opened("table.csv"), paths, table.units)
        differences = DifferencesWriter(opened(DIFFERENCES), paths, table.units) if has_differences(table) else None
        timing.write("case,seconds [s]\n")
        for number, (case, row) in enumerate(zip(table.cases, table.rows(), strict=True)):
            parameters = parameter_cells(case, paths)
            rows.add(case, parameters, row)
            timing.write(f"{number},{float(row['seconds']):.4f}\n")
            if differences is not None:
                differences.add(case, parameters, row)
            if row["reason"]:
                failed.append(case.label)
        if differences is not None:
            differences.finish()
        timing.write(f"# {computed}\n")
    write_json(folder / "sweep.json", {**table.made, "failed": failed})
