"""Options --delay and --drift: the clock of a measurement, and the delays of groups of its channels."""

import argparse

DELAY = (
    "S: start of the measurement after the start of the run [s]. GROUP=TIME, for example accelerations=12.3ms: "
    "remove this lag of a group of channels against the others. GROUP is plates, accelerations, velocities, "
    "displacements, forces, a channel or a pattern with *. May be repeated"
)


def delay_option(parser: argparse._ActionsContainer, more: str = "") -> None:
    """Add --delay, the start of a measurement after the run and the delays of groups of channels."""
    parser.add_argument("--delay", action="append", default=[], metavar="[GROUP=]TIME", help=DELAY + more)


def drift_option(parser: argparse._ActionsContainer) -> None:
    """Add --drift, the drift of the clock of a measurement against that of the run."""
    parser.add_argument(
        "--drift",
        type=float,
        default=0.0,
        metavar="PPM",
        help="correct a slow clock of the measurement by these parts per million: times are multiplied by 1 + "
        "PPM / 1e6, then --delay is added; default: 0",
    )


def clock_of(options: argparse.Namespace) -> tuple[float, float]:
    """Return the number of --delay [s] and --drift [-].

    Raises:
        ConfigurationError: a value is not finite, or the drift exceeds 0.1.
    """
    from vehicle.runs.comparison.compared_run import require_drift
    from vehicle.signals.records.counterpart import PARTS
    from vehicle.signals.records.delays import parsed_delays, split_delay

    drift = options.drift / PARTS
    require_drift(drift)
    return split_delay(parsed_delays(options.delay))[0], drift
