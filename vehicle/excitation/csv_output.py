"""Writing a signal as a CSV file that `read_signal` reads."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from vehicle.errors import OutputError
from vehicle.excitation.signal import Signal


def write_signal(path: str | Path, signal: Signal, comments: Sequence[str] = ()) -> None:
    """Write a signal as `read_signal` reads it: comments, header, time, displacements with 7 significant digits.

    Written under a temporary name and renamed when complete. A signal of the front right wheel alone gets the plain
    column `displacement [m]`.

    Raises:
        OutputError: the file cannot be written, or a comment holds a line break.
    """
    path = Path(path)
    if any("\n" in comment or "\r" in comment for comment in comments):
        raise OutputError(f"{path}: a comment holds a line break; give one line for each comment")
    names = ["displacement"] if signal.wheels == ("fr",) else [f"displacement_{wheel}" for wheel in signal.wheels]
    table = np.column_stack([signal.time, *(signal.displacement[wheel] for wheel in signal.wheels)])
    head = [*(f"# {comment}" for comment in comments), ",".join(["time [s]", *(f"{name} [m]" for name in names)])]
    row = ",".join([f"%.{_time_decimals(signal)}f", *(["%.6e"] * len(names))])
    text = "\n".join([*head, *(row % tuple(values) for values in table.tolist())]) + "\n"
    temporary = path.with_name(f".{path.name}.partial")
    try:
        temporary.write_bytes(text.encode("utf-8"))
        temporary.replace(path)
    except OSError as error:
        temporary.unlink(missing_ok=True)
        raise OutputError(
            f"{path}: cannot be written ({error.strerror}); check the folder, its permissions and the space"
        ) from error


def _time_decimals(signal: Signal) -> int:
    """Fewest decimals, from 3 on, that keep each time stamp within 1e-6 of a step; 12 at most."""
    for decimals in range(3, 12):
        if np.max(np.abs(np.round(signal.time, decimals) - signal.time)) < 1e-6 * signal.timestep:
            return decimals
    return 12
