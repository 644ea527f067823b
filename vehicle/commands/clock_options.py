"""Options --delay and --drift: the clock of a measurement, and the delays of groups of its channels."""

import argparse

from vehicle.commands.options import setting_options
from vehicle.signals.records.measured_settings import MeasuredSettings

DELAY = (
    "S: start of the measurement after the start of the run [s]. GROUP=TIME, for example accelerations=12.3ms: "
    "remove this lag of a group of channels against the others. GROUP is plates, accelerations, velocities, "
    "displacements, forces, a channel or a pattern with *. May be repeated"
)


def delay_option(parser: argparse._ActionsContainer, more: str = "") -> None:
    """Add --delay, the start of a measurement after the run and the delays of groups of channels."""
    parser.add_argument("--delay", action="append", default=[], metavar="[GROUP=]TIME", help=DELAY + more)


def drift_option(parser: argparse._ActionsContainer) -> None:
    """Add --drift, the clock drift of a measurement against the run."""
    setting_options(parser, MeasuredSettings, "drift")
