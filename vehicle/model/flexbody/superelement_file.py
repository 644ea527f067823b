"""Data file of a modal superelement: TOML (readable and comparable as text) or npz, with the same content.

TOML, with a unit in every key, suits bodies of tens of nodes under version control. npz suits bodies of thousands of
nodes and hundreds of modes, for which reading text would take longer than the run.
"""

import tomllib
from pathlib import Path

from vehicle.errors import DataError, OutputError
from vehicle.model.flexbody.superelement import Superelement
from vehicle.model.flexbody.superelement_npz import arrays, of_arrays
from vehicle.model.flexbody.superelement_toml import lines, of_tables
from vehicle.replacement import replaced_file


def read_superelement(path: Path) -> Superelement:
    """Read and check a modal superelement.

    Args:
        path: TOML or npz file; top level `format`, `name`, `provenance`, `node_count`, `mode_count`, `edges` (pairs of
            node names), `hardpoint_tolerance_m` (default 0.001), `mass_kg`, `cog_m`, `inertia_kg_m2` (about the CoG,
            products negative; omitted if every node has `mass_kg`), a `[[node]]` table for each node and a `[[mode]]`
            table for each mode, `shape_per_sqrt_kg` with one row per node in the order of the nodes. Version 1, with
            `attachment_stiffness_n_per_m` along the axes, is read as well.

    Raises:
        DataError: the file is unreadable, truncated or incomplete, has an unknown key, or fails `check_superelement`.
    """
    try:
        raw = path.read_bytes()
    except FileNotFoundError as error:
        raise DataError(f"{path}: the file does not exist. Give the path of a body model.") from error
    except OSError as error:
        raise DataError(f"{path}: cannot be read ({error}). Give a body model in TOML or npz.") from error
    try:
        return of_arrays(raw) if raw.startswith(b"PK") else of_tables(tomllib.loads(raw.decode("utf-8")))
    except UnicodeDecodeError as error:
        raise DataError(f"{path}: cannot be read as UTF-8 text ({error}). Use a body model in TOML or npz.") from error
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise DataError(
            f"{path}: is not valid TOML, perhaps cut off: {error}. Save or export the file again."
        ) from error
    except DataError as error:
        raise DataError(f"{path}: {error}") from error


def write_superelement(path: Path, superelement: Superelement) -> None:
    """Write a modal superelement with all digits; an existing file is replaced when the new one is complete.

    Args:
        path: file to write, npz if its suffix is `.npz`, else TOML.
        superelement: the body.

    Raises:
        OutputError: the file cannot be written.
    """
    binary = path.suffix == ".npz"
    data = arrays(superelement) if binary else ("\n".join(lines(superelement)) + "\n").encode()
    try:
        with replaced_file(path) as temporary:
            temporary.write_bytes(data)
    except OSError as error:
        raise OutputError(
            f"{path}: cannot be written ({error}). Check the folder, its permissions and space."
        ) from error
