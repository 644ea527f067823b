"""Options of a measurement that is compared with a run: --measured, --map and --turn."""

import argparse
from pathlib import Path
from typing import Any

from vehicle.commands.parser import Parser


def measured_options(parser: Parser, *, required: bool = False, several: bool = False) -> None:
    """Add --measured, --map and --turn, which choose a measurement and its channels.

    Args:
        several: True if --measured accepts several files or a folder; its value is then a list.
    """
    several_files: dict[str, Any] = {"nargs": "+", "action": "extend"} if several else {}
    parser.add_argument(
        "--measured",
        type=Path,
        required=required,
        **several_files,
        metavar="FILE",
        help="measurement file in any format that `inspect` reads, with FRFs, time histories, or mode shapes (UFF 55)"
        + (
            "; several files, or a folder, give one table and a folder of results for each file"
            if several
            else ""
            if required
            else ". --unit CHANNEL=UNIT sets the unit of a channel. For a file that needs --rate, --from or --delay, "
            "run python -m vehicle compare afterwards"
        ),
    )
    mapping_options(
        parser.scoped_group(
            "a measurement", needs="--measured FILE", active=lambda options: options.measured is not None
        )
    )


def mapping_options(parser: argparse._ActionsContainer) -> None:
    """Add --map and --turn, the channels of a measurement and their directions."""
    parser.add_argument(
        "--map",
        dest="mapping",
        action="append",
        default=[],
        metavar="CHANNEL=NAME",
        help="channel of the model and its measured channel (number, exact name, pattern with *, or place and "
        'direction), for example knuckle_fr_acc_z="Dof 12 +Z"; for an FRF also its plate, '
        "knuckle_fr_acc_z/plate_fl=3; for mode shapes POINT=NODE. Default: equal names; for mode shapes the "
        "nodes at the points of the car. May be repeated",
    )
    parser.add_argument(
        "--turn",
        dest="turned",
        action="append",
        default=[],
        metavar="CHANNEL",
        help="channel measured in the opposite direction. May be repeated",
    )
