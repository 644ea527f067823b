"""Options of the studies of comfort on the roads."""

from __future__ import annotations

import argparse

from scenarios.comfort_sensitivity_runs import Records
from scenarios.study import car_parser
from vehicle.errors import ConfigurationError

RECORDS = 4
"""Records of 60 s: with them the comfort value is known within 1 % even as that of a road with Gaussian amplitudes."""

QUICK = Records(count=2, duration=8.0, lead=3.0)
"""Records with --quick."""


def comfort_parser(name: str) -> argparse.ArgumentParser:
    """Parser of a study; the reduced engine by default.

    Args:
        name: module name.
    """
    parser = car_parser(name)
    parser.set_defaults(engine="auto")
    parser.add_argument(
        "--records", type=int, metavar="N", help=f"records of road for every point, 60 s each; {RECORDS} by default"
    )
    return parser


def records_of(options: argparse.Namespace) -> Records:
    """The records that the options ask for.

    Raises:
        ConfigurationError: fewer than one.
    """
    if options.records is not None and options.records < 1:
        raise ConfigurationError(f"--records {options.records}: must be at least 1; a single one tells no error")
    base = QUICK if options.quick else Records(count=RECORDS)
    return base if options.records is None else Records(count=options.records, duration=base.duration, lead=base.lead)
