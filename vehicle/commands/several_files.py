"""Commands with several input files: names, folders, results and errors of each file."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from vehicle.errors import ConfigurationError, DataError, VehicleError

Row = tuple[str, ...]


def expanded(names: Sequence[str]) -> tuple[list[str], bool]:
    """Return the files of names and folders, and True for several; files of a folder in alphabetical order."""
    paths: list[str] = []
    for name in names:
        folder = Path(name)
        if not folder.is_dir():
            paths.append(name)
            continue
        files = sorted(str(file) for file in folder.iterdir() if file.is_file() and not file.name.startswith("."))
        if not files:
            raise ConfigurationError(
                f"{name}: is an empty folder; give measurement files, or a folder with measurement files"
            )
        paths += files
    return list(dict.fromkeys(paths)), len(paths) > 1 or any(Path(name).is_dir() for name in names)


def each_file(
    names: Sequence[str], work: Callable[[str], dict[str, Any]]
) -> tuple[list[dict[str, Any]], list[VehicleError]]:
    """Return the result of every file; a failed file has its error message as a result, and the others continue."""
    results, errors = [], []
    for name in names:
        try:
            results.append({"input": name, **work(name)})
        except VehicleError as error:
            errors.append(error)
            results.append({"input": name, "error": str(error).removeprefix(f"{name}: ")})
    return results, errors


def table_of(heads: Row, results: Sequence[dict[str, Any]], rows_of: Callable[[dict[str, Any]], Sequence[Row]]) -> str:
    """Return results of `each_file` as text: the rows of each, or its error; first column to the left, others right."""
    rows = [
        row
        for result in results
        for row in ([(result["input"], result["error"])] if "error" in result else rows_of(result))
    ]
    full = [heads, *(row for row in rows if len(row) == len(heads))]
    names = max(len(row[0]) for row in [heads, *rows])
    widths = [max(len(row[column]) for row in full) for column in range(len(heads))]
    lines = []
    for row in [heads, *rows]:
        if len(row) == len(heads):
            cells = [f"{cell:>{width}}" for cell, width in zip(row[1:], widths[1:], strict=True)]
            lines.append("  ".join([f"{row[0]:<{names}}", *cells]).rstrip())
        else:
            lines.append(f"{row[0]:<{names}}  {row[1]}")
    return "\n".join(lines)


def raise_worst(errors: Sequence[VehicleError], files: int) -> None:
    """Raise one error for all failed files; call it after printing the results."""
    if errors:
        count = len(errors)
        raise DataError(
            f"{count} of {files} files {'has' if count == 1 else 'have'} no result; the reason is in the table"
        )
