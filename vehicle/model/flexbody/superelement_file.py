"""Data file of a modal superelement, read strictly and written whole: TOML to be read and compared, or npz.

Both hold the same: TOML, with a unit in every key, for bodies of tens of nodes, which lie in a repository; npz, which
numpy alone reads, for those of thousands of nodes and hundreds of modes, which as text would take longer than the run.
"""

from __future__ import annotations

import tempfile
import tomllib
from pathlib import Path

from vehicle.errors import DataError, OutputError
from vehicle.model.flexbody.superelement import Superelement
from vehicle.model.flexbody.superelement_npz import arrays, of_arrays
from vehicle.model.flexbody.superelement_toml import lines, of_tables


def read_superelement(path: Path) -> Superelement:
    """Read a modal superelement.

    Args:
        path: TOML or npz file; top level `format`, `name`, `provenance`, `node_count`, `mode_count`, `edges` (pairs of
            node names), `hardpoint_tolerance_m` (0.001 where it is left out), `mass_kg`, `cog_m`, `inertia_kg_m2`
            (about the CoG, products negative; left out where every node has its `mass_kg`), a `[[node]]` table for each
            node and a `[[mode]]` table for each mode, `shape_per_sqrt_kg` with one row per node in the order of the
            nodes. Version 1, with `attachment_stiffness_n_per_m` along the axes, is read as well.

    Returns:
        The checked superelement.

    Raises:
        DataError: unreadable, truncated, incomplete, an unknown key, or refused by `check_superelement`.
    """
    try:
        raw = path.read_bytes()
    except FileNotFoundError as error:
        raise DataError(f"{path}: no such file. Give the path of a body model.") from error
    except OSError as error:
        raise DataError(f"{path}: cannot be read ({error}). Give a body model in TOML or npz.") from error
    try:
        return of_arrays(raw) if raw.startswith(b"PK") else of_tables(tomllib.loads(raw.decode("utf-8")))
    except UnicodeDecodeError as error:
        raise DataError(f"{path}: cannot be read as UTF-8 text ({error}). Give a body model in TOML or npz.") from error
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise DataError(f"{path}: no valid TOML, perhaps cut off: {error}. Write the file again.") from error
    except DataError as error:
        raise DataError(f"{path}: {error}") from error


def write_superelement(path: Path, superelement: Superelement) -> None:
    """Write a modal superelement: to a temporary file in the same folder, renamed when it is complete.

    Args:
        path: file to write, as npz where it ends so, else as TOML.
        superelement: what to write; every number is written with all its digits.

    Raises:
        OutputError: the file cannot be written.
    """
    binary = path.suffix == ".npz"
    data = arrays(superelement) if binary else ("\n".join(lines(superelement)) + "\n").encode()
    temporary = ""
    try:
        with tempfile.NamedTemporaryFile("wb", dir=path.parent, delete=False) as file:
            temporary = file.name
            file.write(data)
        Path(temporary).chmod(0o644)  # a temporary file is private, a data file is not
        Path(temporary).replace(path)
    except OSError as error:
        if temporary:
            Path(temporary).unlink(missing_ok=True)
        raise OutputError(
            f"{path}: cannot be written ({error}). Check the folder, its permissions and space."
        ) from error
